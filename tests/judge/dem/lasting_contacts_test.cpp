// `edmill import` and `edmill audit` on the dumps of a small DEM code: right decks, frames that are
// far apart, and a table of mistakes by what names them.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "base/errors.hpp"
#include "casefile/case_spec.hpp"
#include "dem/contact_rates.hpp"
#include "dem/import_dump.hpp"
#include "small_dem.hpp"

using namespace edmill;

namespace {

constexpr const char* box = R"(
[run]
end_time = "1 s"
gravity = "9.8 m/s2"
[mill]
type = "vibratory"
amplitude = ["3 mm", "11 mm", "-2 mm"]
speed = "3600 rpm"
[vessel]
type = "box"
size = ["33 mm", "57 mm", "36 mm"]
[contact]
restitution = 0.6
friction = 0.4
[[balls]]
count = 5
diameter = "8 mm"
density = "8 g/cm3"
)";

/// The files of a run of the small code, removed with it.
class Files {
 public:
  explicit Files(const small_dem::Deck& deck)
      : time_step_(deck.time_step), folder_(std::filesystem::temp_directory_path() /
                                        ("edmill_contacts_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
    small_dem::Run(deck).write(folder_ / "frames.dump");
  }
  ~Files() { std::filesystem::remove_all(folder_); }

  dem::ContactAudit audited(const std::vector<std::string>& settings = {}) const {
    const auto spec = casefile::parse_case(box, "box.toml", settings);
    dem::ImportOptions options;
    options.dump = folder_ / "frames.dump";
    options.time_step = time_step_;
    options.log = folder_ / "contacts.csv";
    dem::import_dump(spec, options);
    return dem::audit_contacts(spec, options.log, nullptr);
  }
 private:
  double time_step_;
  std::filesystem::path folder_;
};

dem::ContactAudit audited(
    const small_dem::Deck& deck, const std::vector<std::string>& settings = {}) {
  return Files(deck).audited(settings);
}

const dem::Judged* named(const dem::ContactAudit& audit, const std::string& name) {
  for (const auto& judged : audit.judged)
    if (judged.name == name) return &judged;
  return nullptr;
}

void right_decks_agree(std::initializer_list<unsigned> seeds) {
  for (const unsigned seed : seeds) {
    small_dem::Deck deck;
    deck.seed = seed, deck.duration = 0.6;
    const auto audit = audited(deck);
    EXPECT_EQ(audit.verdict, compare::Verdict::agree) << "seed " << seed << "\n"
                                                      << dem::table(audit);
    ASSERT_TRUE(named(audit, "restitution at walls"));
    EXPECT_NEAR(named(audit, "restitution at walls")->found.value, 0.6, 0.002);
    EXPECT_NEAR(named(audit, "friction at walls")->found.value, 0.4, 0.01);
    double shares = 0;
    for (const double dose : audit.facts.doses) shares += dose / audit.facts.dose();
    EXPECT_NEAR(shares, 1, 1e-12);
  }
}
TEST(LastingContacts, ARightDeckAgrees) { right_decks_agree({1}); }
TEST(LastingContacts, LongRightDecksAgree) { right_decks_agree({2, 3, 4, 5, 6, 7, 8}); }

TEST(LastingContacts, FramesFarApartGiveTheSameValues) {
  double fine = 0;
  for (const double interval : {1e-5, 1e-4, 1e-3}) {
    small_dem::Deck deck;
    deck.frames = interval, deck.duration = 1.5;
    const auto audit = audited(deck);
    const auto* e = named(audit, "restitution at walls");
    ASSERT_TRUE(e) << dem::table(audit);
    EXPECT_NEAR(e->found.value, 0.6, 0.002) << dem::table(audit);
    if (interval == 1e-5) fine = audit.dose_rate;
    EXPECT_NEAR(audit.dose_rate, fine, 0.02 * fine) << dem::table(audit);
  }
}

/// Long contacts that a strong gravity presses on the floor: it would change approaches by some per
/// cent meanwhile.
TEST(LastingContacts, WhatPressesIsNoPartOfTheLaws) {
  small_dem::Deck deck;
  deck.gravity = {0, -100, 0}, deck.contact_time = 4e-4, deck.time_step = 8e-6, deck.frames = 8e-5,
  deck.duration = 6;
  const auto audit = audited(deck, {"run.gravity=\"100 m/s2\""});
  const auto* e = named(audit, "restitution at walls");
  ASSERT_TRUE(e) << dem::table(audit);
  EXPECT_NEAR(e->found.value, 0.6, 0.002) << dem::table(audit);
  EXPECT_NEAR(named(audit, "friction at walls")->found.value, 0.4, 0.01) << dem::table(audit);
}

/// Numbers as "%g" writes them.
TEST(LastingContacts, RoundedDumpsAgree) {
  small_dem::Deck deck;
  deck.digits = 6;
  const auto audit = audited(deck);
  EXPECT_EQ(audit.verdict, compare::Verdict::agree) << dem::table(audit);
}

struct Mistake {
  const char* name;
  void (*make)(small_dem::Deck&);
  const char* value;  ///< that names it
  double truth;
};

constexpr double some = std::numeric_limits<double>::quiet_NaN();  ///< any wrong value

/// @param every  one of so many mistakes is tried
void mistakes_are_named(std::size_t every) {
  const Mistake mistakes[] = {
      {"restitution 0.7", [](auto& d) { d.damping = 0.27575; }, "restitution at walls", 0.7},
      {"attraction", [](auto& d) { d.attracts = true; }, "restitution at walls", 0.561},
      {"friction 0.3", [](auto& d) { d.friction = 0.3; }, "friction at walls", 0.3},
      {"no gravity",
          [](auto& d) {
            d.gravity = {0, 0, 0};
          },
          "gravity along Y", 0},
      {"gravity upwards",
          [](auto& d) {
            d.gravity = {0, 9.8, 0};
          },
          "gravity along Y", 9.8},
      {"density 7800", [](auto& d) { d.density = 7800; }, "density over the case's", 0.975},
      {"diameter 7.9 mm", [](auto& d) { d.radius = 0.00395; }, "diameter over the case's", 0.9875},
      {"amplitude -5 %", [](auto& d) { d.amplitude[1] = 0.01045; }, "mill.amplitude.y", 0.01045},
      {"one axis out of phase", [](auto& d) { d.quarter[1] = 0.011, d.amplitude[1] = 0; },
          "phase of mill.amplitude along y", 1.5708},
      {"all axes out of phase",
          [](auto& d) {
            d.quarter = d.amplitude, d.amplitude = {0, 0, 0};
          },
          "phase of the drive", 1.5708},
      {"speed +1 %", [](auto& d) { d.frequency = 60.6; }, "mill.speed", 380.76},
      {"box 0.3 mm too wide", [](auto& d) { d.half[0] += 0.00015; }, "vessel.size.x", 0.0333},
      {"amplitudes doubled",
          [](auto& d) {
            for (double& a : d.amplitude) a *= 2;
          },
          "factor of mill.amplitude", 2},
      {"a wall is missing", [](auto& d) { d.missing_wall = 1; }, "contacts missed at walls", some},
      {"the box is periodic", [](auto& d) { d.periodic_axis = 0; }, "jumps of balls", some},
      {"balls fly through each other", [](auto& d) { d.has_pairs = false; },
          "contacts missed between balls", some},
      {"restitution 0.7 at one wall", [](auto& d) { d.other_wall = 5, d.other_damping = 0.27575; },
          "restitution at wall +z", 0.7},
      {"torque halved", [](auto& d) { d.torque = 0.5; }, "spin change over the torque's at walls",
          0.5},
      {"no torque", [](auto& d) { d.torque = 0; }, "spin change over the torque's at walls", 0},
      {"walls damp as if at rest", [](auto& d) { d.wall_velocity = 0; },
          "velocity of the walls over the case's", some},
  };
  for (std::size_t k = 0; k < std::size(mistakes); k += every) {
    const auto& mistake = mistakes[k];
    small_dem::Deck deck;
    deck.duration = 0.6;
    mistake.make(deck);
    const auto audit = audited(deck);
    SCOPED_TRACE(mistake.name + std::string("\n") + dem::table(audit));
    EXPECT_EQ(audit.verdict, compare::Verdict::differ);
    if (const auto* judged = named(audit, mistake.value)) {
      EXPECT_FALSE(judged->agrees());
      if (!std::isnan(mistake.truth)) {
        EXPECT_NEAR(judged->found.value, mistake.truth, 0.01 * std::max(1.0, mistake.truth));
      }
      const bool changes_friction_too = deck.attracts;
      for (const auto& other : audit.judged)
        EXPECT_TRUE(changes_friction_too || other.agrees() || other.equation == judged->equation)
            << other.name;
      continue;
    }
    ASSERT_FALSE(audit.causes.empty());
    EXPECT_EQ(audit.causes[0].key, mistake.value);
    EXPECT_NEAR(audit.causes[0].value, mistake.truth,
        std::max(3 * audit.causes[0].half_width, 0.003 * mistake.truth));
  }
}
TEST(LastingContacts, MistakesAreNamedWithTheirValues) { mistakes_are_named(5); }
TEST(LastingContacts, LongAllMistakesAreNamedWithTheirValues) { mistakes_are_named(1); }

}  // namespace
