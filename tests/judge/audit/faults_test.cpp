// Logs of a mill with one mistake: the audit finds the equations that it violates and no others,
// and the search among single causes names it.
#include <gtest/gtest.h>

#include "faulty_log.hpp"

namespace edmill::audit {
namespace {

using testing::Faults;

class Faulty : public testing::FaultyLog {};

TEST_F(Faulty, NothingIsFoundWithoutAMistake) {
  prepare();
  simulate({});
  const auto audit = judged();
  expect_kinds(audit, {});
  EXPECT_EQ(audit.events, 400u);
  EXPECT_TRUE(audit.not_made.empty());
  EXPECT_GT(audit.findings.judged_number(Check::momentum), 20u);
  EXPECT_GT(audit.findings.judged_number(Check::missed), 400u);
}

TEST_F(Faulty, LateEvents) {
  prepare();
  Faults faults;
  faults.late_every = 5;
  const int late = simulate(faults);
  const auto audit = judged();
  expect_kinds(audit, {Kind::late_event});
  // Not where the bodies turn back in time; a ball that still overlaps may meet the wall again
  // before it is out.
  EXPECT_GE(count(audit, Kind::late_event), static_cast<std::uint64_t>(late) * 3 / 4);
  EXPECT_EQ(cause(), "");
}

TEST_F(Faulty, FiniteSteps) {
  prepare();
  Faults faults;
  faults.step = 2e-6;
  simulate(faults, 1000);
  expect_kinds(judged(), {Kind::late_event});
  EXPECT_EQ(cause(), "");
}

TEST_F(Faulty, MissedImpactsOfBallsThatFlyOnThroughEachOther) {
  prepare();
  Faults faults;
  faults.missed_pairs_every = 6;
  const int missed = simulate(faults, 1000);
  ASSERT_GE(missed, 8);
  const auto audit = judged();
  expect_kinds(audit, {Kind::missed_event});
  EXPECT_EQ(count(audit, Kind::missed_event), static_cast<std::uint64_t>(missed));
}

TEST_F(Faulty, AnImpactThatIsNotLogged) {
  for (const std::string kind : {"wall", "ball"}) {
    prepare();
    simulate({});
    auto all = lines();
    const auto line = line_with(kind);
    const auto parts = fields(all[line]);
    all.erase(all.begin() + static_cast<std::ptrdiff_t>(line));
    write_lines(all);
    const auto audit = judged();
    expect_kinds(audit, {Kind::missed_event});
    ASSERT_EQ(count(audit, Kind::missed_event), 1u);
    const auto& found = audit.findings.of(Kind::missed_event).examples.at(0);
    EXPECT_NEAR(found.time, std::stod(parts[1]), 1e-7);
    EXPECT_EQ(found.with_wall, kind == "wall");
  }
}

TEST_F(Faulty, WrongRestitution) {
  prepare();
  Faults faults;
  faults.restitution = 0.6;
  simulate(faults);
  const auto audit = judged();
  expect_kinds(audit, {Kind::normal_restitution});
  EXPECT_NEAR(audit.findings.of(Kind::normal_restitution).examples[0].found, 0.6, 1e-9);
  expect_cause("contact.restitution = 0.6 ");
}

TEST_F(Faulty, WrongTangentialSign) {
  prepare();
  Faults faults;
  faults.tangential_sign = true;
  simulate(faults, 80);  // energy grows without bounds
  expect_kinds(judged(), {Kind::spin_change});
  expect_cause("change of the velocity by the friction (2.34'): factor = -1 ");
}

TEST_F(Faulty, UnequalMasses) {
  prepare();
  Faults faults;
  faults.printed_compliance = true;
  simulate(faults, 500);
  expect_kinds(judged(), {Kind::tangential_restitution});
  expect_cause("impacts of balls that are not alike (2.24'): 1 + 1/J, as (2.24) is printed");
  faults = {};
  faults.equal_masses = true;
  simulate(faults, 500);
  expect_kinds(judged(), {Kind::tangential_restitution, Kind::momentum});
  expect_cause("impacts of balls that are not alike (2.24'): each takes half");
  faults = {};
  faults.exchanged_masses = true;
  simulate(faults, 200);
  expect_kinds(judged(), {Kind::tangential_restitution, Kind::momentum});
  expect_cause("impacts of balls that are not alike (2.24'): the masses are exchanged");
}

TEST_F(Faulty, WrongWallVelocity) {
  prepare();
  Faults faults;
  faults.wall_at_rest = true;
  simulate(faults);
  EXPECT_EQ(count(judged(), Kind::normal_restitution), 400u);
  expect_cause("velocity of the wall (2.27): a wall at rest");
  // One that no formula in the list gives.
  faults = {};
  faults.wall_velocity_factor = 1.01;
  simulate(faults);
  expect_cause("velocity of the wall (2.27): factor = 1.01 ");
}

TEST_F(Faulty, OrderOfTheRotations) {
  prepare();
  Faults faults;
  faults.printed_rotations = true;
  simulate(faults);
  EXPECT_GT(count(judged(), Kind::late_event), 20u);
  expect_cause("mill, order of rotations: R_x(gamma) R_z(theta), as (2.14) is printed");
}

TEST_F(Faulty, LostSpin) {
  prepare();
  Faults faults;
  faults.spin_lost = true;
  simulate(faults);
  expect_kinds(judged(), {Kind::lost_spin});
}

TEST_F(Faulty, NonBallisticFlight) {
  prepare();
  Faults faults;
  faults.no_gravity = true;
  simulate(faults);
  expect_kinds(judged(), {Kind::non_ballistic});
  expect_cause("gravity in flights (2.1): factor = 0 ");
}

TEST_F(Faulty, WrongDoseAndWork) {
  prepare();
  Faults faults;
  faults.dose_factor = 1.001;
  simulate(faults);
  expect_kinds(judged(), {Kind::milling_dose});
  simulate({});
  const auto line = line_with("wall");
  change(line, 8, [](const std::string& work) { return fmt::format("{}", -std::stod(work)); });
  const auto audit = judged();
  expect_kinds(audit, {Kind::wall_work});
  EXPECT_EQ(audit.findings.of(Kind::wall_work).examples.at(0).line, line + 1);
}

TEST_F(Faulty, DuplicatesAndDisorder) {
  prepare();
  simulate({});
  auto all = lines();
  all.insert(all.begin() + 200, all[199]);
  write_lines(all);
  auto audit = judged();
  expect_kinds(audit, {Kind::duplicate});
  EXPECT_EQ(audit.findings.of(Kind::duplicate).examples.at(0).line, 201u);
  simulate({});
  all = lines();
  std::swap(all[150], all[170]);
  write_lines(all);
  audit = judged();
  expect_kinds(audit, {Kind::out_of_order});
}

TEST_F(Faulty, BodiesThatAreNotThere) {
  prepare();
  simulate({});
  change(line_with("wall"), 2, [](const std::string&) { return "5"; });
  EXPECT_GE(count(judged(), Kind::unknown_body), 1u);
  simulate({});
  change(line_with("wall"), 9, [](const std::string&) { return "nan"; });
  EXPECT_EQ(count(judged(), Kind::not_finite), 1u);
}

TEST_F(Faulty, WrongPartners) {
  prepare();
  simulate({});
  change(line_with("wall"), 4, [](const std::string& wall) { return wall == "2" ? "0" : "2"; });
  expect_kinds(judged(), {Kind::wrong_partner});
  simulate({});
  const auto line = line_with("ball");
  const auto parts = fields(lines()[line]);
  change(line, 4, [&](const std::string& ball) {
    for (int k = 0;; ++k)
      if (std::to_string(k) != ball && std::to_string(k) != parts[2]) return std::to_string(k);
  });
  expect_kinds(judged(), {Kind::wrong_partner});
}

TEST_F(Faulty, TheGapOfTheLowerCapWithThePrintedSign) {
  // y - R - h/2 is negative everywhere: a code that searches for its change of sign never finds the
  // cap, and balls leave the vessel there.
  prepare();
  Faults faults;
  faults.lower_cap_unseen = true;
  simulate(faults);
  const auto audit = judged();
  expect_kinds(audit, {Kind::missed_event});
  EXPECT_EQ(count(audit, Kind::missed_event), built.the_case.balls.size());
  EXPECT_TRUE(looks_like(audit, "unseen_wall"));
}

/// Balls and walls numbered from 1, and pairs logged by both balls, are named, each alone.
TEST_F(Faulty, OtherNumbersAndLinesOfBothBalls) {
  prepare();
  simulate({});
  const auto all = lines();
  const auto names = fields(all[0]);
  const auto column = [&](const std::string& name) {
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  const auto ball = column("ball"), kind = column("partner_kind"), partner = column("partner");
  const auto next = [](std::string& number) { number = std::to_string(std::stoi(number) + 1); };
  const auto row = [](const std::vector<std::string>& values) {
    std::string text;
    for (const auto& value : values) text += (text.empty() ? "" : ",") + value;
    return text;
  };
  const auto named = [&](const std::string& name, const auto& change) {
    std::vector<std::string> written{all[0]};
    for (std::size_t k = 1; k < all.size(); ++k) {
      auto values = fields(all[k]);
      for (const auto& line : change(values)) written.push_back(row(line));
    }
    write_lines(written);
    const auto audit = judged();
    for (const auto* other : {"numbers", "walls", "pairs"})
      EXPECT_EQ(looks_like(audit, other), name == other) << name << " " << other;
  };
  using Lines = std::vector<std::vector<std::string>>;
  named("none", [&](auto values) { return Lines{values}; });
  named("numbers", [&](auto values) {
    next(values[ball]);
    if (values[kind] == "ball") next(values[partner]);
    return Lines{values};
  });
  named("walls", [&](auto values) {
    if (values[kind] == "wall") next(values[partner]);
    return Lines{values};
  });
  named("pairs", [&](auto values) {
    auto other = values;
    for (std::size_t k = 0; k < names.size(); ++k)
      if (const auto twin = column("partner_" + names[k]); twin < names.size())
        std::swap(other[k], other[twin]);
    if (values[kind] != "ball") return Lines{values};
    other[kind] = "ball";
    std::swap(other[ball], other[partner]);
    return Lines{values, other};
  });
}

}  // namespace
}  // namespace edmill::audit
