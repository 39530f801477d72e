// The speed at which bodies separate, max(e_n |g_n|, v_s): logs of codes with another v_s, with
// none, and with a friction or a dose that ignores it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "faulty_log.hpp"

namespace edmill::audit {
namespace {

using testing::Faults;

class Separation : public testing::FaultyLog {
 protected:
  static constexpr double restitution = 0.53;

  static std::string contact(double least_separation) {
    return fmt::format(
        "restitution = {}\nleast_separation = \"{} m/s\"", restitution, least_separation);
  }
  std::vector<double> approach_speeds() const {
    std::vector<double> speeds;
    const auto all = lines();
    for (std::size_t k = 1; k < all.size(); ++k) speeds.push_back(std::stod(fields(all[k])[5]));
    return speeds;
  }
  /// Impacts in which e_n |g_n| is below this speed.
  std::uint64_t slower_than(double speed) const {
    std::uint64_t slower = 0;
    for (const double approach : approach_speeds())
      if (restitution * approach < speed) ++slower;
    return slower;
  }
  /// All of this number of impacts separate at another speed, and nothing else is wrong.
  void expect_another_speed(const Audit& result, std::uint64_t wanted) const {
    expect_kinds(result, {Kind::normal_restitution});
    EXPECT_GT(wanted, 10u);
    EXPECT_EQ(count(result, Kind::normal_restitution), wanted);
  }
};

TEST_F(Separation, NoLeastSpeedInTheLog) {
  prepare(contact(0.01));
  simulate({.least_separation = 0}, 150);
  const auto audit = judged();
  expect_another_speed(audit, slower_than(0.01));
  expect_cause("contact.least_separation = 0 ");
  // What is supplied in the case and not in the log is missing from the balance.
  EXPECT_GT(audit.energies.supplied.value(), 0);
  EXPECT_NEAR(audit.energies.closure(), audit.energies.supplied.value(),
      1e-12 * audit.energies.milling_dose.value());
  prepare(contact(0));
  expect_kinds(judged(), {});
}

TEST_F(Separation, NoLeastSpeedInTheCase) {
  prepare(contact(0.01));
  simulate({});
  const auto touched = slower_than(0.01);
  prepare(contact(0));
  const auto audit = judged();
  expect_another_speed(audit, touched);
  expect_cause("contact.least_separation = 0.01 ");
  EXPECT_EQ(audit.energies.supplying, 0u);
  EXPECT_GT(audit.energies.creating, 0u);
}

TEST_F(Separation, AnotherLeastSpeedInTheLog) {
  prepare(contact(0.01));
  simulate({.least_separation = 0.03}, 600);
  expect_another_speed(judged(), slower_than(0.03));
  expect_cause("contact.least_separation = 0.03 ");
  simulate({.least_separation = 0.005}, 600);
  expect_another_speed(judged(), slower_than(0.01));
  expect_cause("contact.least_separation = 0.005 ");
}

TEST_F(Separation, TheLeastSpeedAfterEveryImpact) {
  prepare(contact(0.01));
  simulate({.restitution = 0});
  expect_another_speed(judged(), 400 - slower_than(0.01));
  expect_cause("contact.restitution = 0");
}

TEST_F(Separation, ALogWithoutSpins) {
  prepare(contact(0.01));
  simulate({.least_separation = 0}, 150);
  const auto touched = slower_than(0.01);
  auto all = lines();
  for (const char axis : {'x', 'y', 'z'})
    for (const std::string& name :
        {std::string("w") + axis + "_before", std::string("w") + axis + "_after"})
      for (std::size_t at; (at = all[0].find(name)) != std::string::npos;) all[0][at] = 'u';
  write_lines(all);
  const auto audit = judged();
  expect_another_speed(audit, touched);
  EXPECT_EQ(audit.energies.impacts, 0u);
}

TEST_F(Separation, AWrongRestitutionIsNoLeastSpeed) {
  // With a loose tolerance many impacts separate at the same speed within it.
  prepare(contact(0.01));
  simulate({.restitution = 0.6});
  Options options;
  options.log = scratch / "log.csv";
  options.tolerance = 1e-3;
  const auto audit = edmill::audit::audit(built.the_case, built.states, options);
  expect_kinds(audit, {Kind::normal_restitution});
  EXPECT_GT(count(audit, Kind::normal_restitution), 20u);
}

TEST_F(Separation, AtTheBoundaryBothOutcomesAreOne) {
  prepare(contact(0));
  simulate({}, 12);
  const auto speeds = approach_speeds();
  const double boundary = restitution * *std::min_element(speeds.begin(), speeds.end());
  ASSERT_GT(boundary, 1e-5);
  for (const double factor : {1 - 1e-12, 1 + 1e-12}) {
    prepare(contact(boundary * factor));
    expect_kinds(judged(), {});
  }
  prepare(contact(boundary * 1.01));
  const auto audit = judged();
  expect_kinds(audit, {Kind::normal_restitution});
  EXPECT_EQ(count(audit, Kind::normal_restitution), 1u);
}

TEST_F(Separation, FrictionOfTheRestitutionAlone) {
  prepare(contact(0.1));
  simulate({.restitution_friction = true});
  const auto audit = judged();
  expect_kinds(audit, {Kind::tangential_restitution});
  const auto& tally = audit.findings.of(Kind::tangential_restitution);
  EXPECT_GT(tally.count, 10u);
  EXPECT_LE(tally.count, slower_than(0.1));  // not where the contact sticks by either limit
  expect_cause("limit of the friction (2.24'): mu (1 + e_n) |g_n|");
}

TEST_F(Separation, ADoseWithoutTheSuppliedEnergy) {
  prepare(contact(0.1));
  simulate({.net_dose = true});
  const auto audit = judged();
  expect_kinds(audit, {Kind::milling_dose});
  EXPECT_GT(audit.energies.supplying, 10u);
  // Those below the tolerance, 4e-9 M v^2, are not found.
  EXPECT_GT(count(audit, Kind::milling_dose), audit.energies.supplying * 9 / 10);
  EXPECT_LE(count(audit, Kind::milling_dose), audit.energies.supplying);
  expect_cause("supplied energy in the dose (2.36'): factor = 0 ");
}

TEST_F(Separation, AnImpactAtTheLeastSpeedThatIsNotLogged) {
  for (const std::string kind : {"wall", "ball"}) {
    prepare(contact(0.3));
    simulate({});
    auto all = lines();
    const auto line = std::find_if(all.begin() + 100, all.end(), [&](const std::string& text) {
      const auto parts = fields(text);
      const double approach = std::stod(parts[5]);
      return parts[3] == kind && approach > 0.05 && restitution * approach < 0.25;
    });
    ASSERT_NE(line, all.end());
    const double time = std::stod(fields(*line)[1]);
    all.erase(line);
    write_lines(all);
    const auto audit = judged();
    expect_kinds(audit, {Kind::missed_event});
    ASSERT_EQ(count(audit, Kind::missed_event), 1u);
    const auto& found = audit.findings.of(Kind::missed_event).examples.at(0);
    EXPECT_NEAR(found.time, time, 1e-7);
    EXPECT_STREQ(found.note, "the state changes as in this impact, which is not logged");
  }
}

TEST_F(Separation, OtherMistakesAreFoundBesideAHighLeastSpeed) {
  const auto kinds_of = [&](const Faults& faults, int events = 400) {
    prepare(contact(0.1));
    simulate(faults, events);
    const auto ranked = judged().findings.ranked();
    return std::set<Kind>(ranked.begin(), ranked.end());
  };
  using Kinds = std::set<Kind>;
  EXPECT_EQ(kinds_of({}), Kinds{});
  EXPECT_TRUE(kinds_of({.wall_at_rest = true}).contains(Kind::normal_restitution));
  EXPECT_EQ(kinds_of({.restitution = 0.6}), Kinds{Kind::normal_restitution});
  EXPECT_EQ(kinds_of({.tangential_sign = true}, 80), Kinds{Kind::spin_change});
  EXPECT_EQ(kinds_of({.printed_compliance = true}, 500), Kinds{Kind::tangential_restitution});
  EXPECT_EQ(kinds_of({.spin_lost = true}), Kinds{Kind::lost_spin});
  EXPECT_EQ(kinds_of({.dose_factor = 1.001}), Kinds{Kind::milling_dose});
}

TEST_F(Separation, DosesOfALogWithoutStates) {
  prepare(contact(0.1));
  const auto without_states = [&] {
    auto all = lines();
    for (auto& line : all) {
      std::size_t end = 0;
      for (int k = 0; k < 9; ++k) end = line.find(',', end) + 1;
      line.resize(end - 1);
    }
    write_lines(all);
  };
  simulate({});
  without_states();
  expect_kinds(judged(), {});
  simulate({.least_separation = 0}, 150);
  without_states();
  expect_kinds(judged(), {Kind::milling_dose});
  expect_cause("contact.least_separation = 0 ");
}

}  // namespace
}  // namespace edmill::audit
