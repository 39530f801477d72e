// Runs in which bodies hit each other without time to move: wedges that come free, since friction
// rests, and jams that end the run.
#include <gtest/gtest.h>

#include "spex_case.hpp"

namespace edmill::engine {
namespace {

std::string still_box(const std::string& size, const std::string& more) {
  return "[run]\nend_time = \"1 s\"\n[mill]\ntype = \"vibratory\"\namplitude = [0, 0, 0]\nspeed = "
         "\"900 "
         "rpm\"\n"
         "[vessel]\ntype = \"box\"\nsize = " +
      size + "\n" + more;
}
std::string closing_piston(const std::string& balls) {
  return "[[vessel.piston]]\nwall = \"wall_2\"\ndistance = \"0 mm\"\nspeed = \"30 mm/s\"\n"
         "[contact]\nrestitution = 0.5\nfriction = 0.3\n" +
      balls;
}
std::string ball(
    const std::string& diameter, const std::string& position, const std::string& more = "") {
  return "[[ball]]\ndiameter = \"" + diameter + "\"\nposition = " + position + "\n" + more;
}

struct Jam {
  std::string name, text;
  double time;  ///< when nothing can move any more [s]
  std::vector<int> balls, walls;
};

std::vector<Jam> jams() {
  return {
      {"a piston on one ball",
          still_box(
              "[\"40 mm\", \"40 mm\", \"40 mm\"]", closing_piston(ball("10 mm", "[0, 0.01, 0]"))),
          1, {0}, {2, 3}},
      {"a piston on a column of two",
          still_box("[\"12 mm\", \"40 mm\", \"12 mm\"]",
              closing_piston(ball("10 mm", "[0, 0.01, 0]") + ball("10 mm", "[0, -0.005, 0]"))),
          2.0 / 3, {0, 1}, {2, 3}},
  };
}

TEST(Stalls, JamsEndTheRunWithTheBodies) {
  for (const auto& jam : jams()) {
    const auto built = casefile::build_case<double>(casefile::parse_case(jam.text, "jam.toml"));
    Simulation<double> simulation(built.the_case, built.states, built.start);
    ASSERT_EQ(simulation.run_until(simulation.clock().at(2.0)), EndReason::stalled) << jam.name;
    EXPECT_NEAR(simulation.stall()->time, jam.time, 1e-6) << jam.name;
    EXPECT_EQ(simulation.stall()->balls, jam.balls) << jam.name;
    EXPECT_EQ(simulation.stall()->walls, jam.walls) << jam.name;
    EXPECT_GE(simulation.stall()->impacts, 100000u);
  }
}

/// Two seeds whose balls stood still for ever while friction acted, and some that did not.
TEST(Stalls, WedgesOfTenLargeBallsComeFree) {
  for (const int seed : {1, 3, 5, 8}) {
    const auto spec =
        casefile::parse_case("[run]\nend_time = \"5 s\"\nseed = " + std::to_string(seed) +
                "\n[mill]\ntype = \"spex8000\"\nspeed = \"1060 "
                "rpm\"\n[vessel]\ndiameter = \"38 mm\"\nheight = \"57 mm\"\n"
                "[contact]\nrestitution = 0.5\nfriction = 0.4\n" +
                testing::batch(10, "12.7 mm", "density = \"7.8 g/cm3\"\n"),
            "ten.toml");
    const auto built = casefile::build_case<double>(spec);
    Simulation<double> simulation(built.the_case, built.states, built.start);
    EXPECT_EQ(simulation.run_until(simulation.clock().at(5.0)), EndReason::end_time) << seed;
  }
}

/// Counts the impacts without friction, and checks when there may be some.
template <class Real> struct Rested : Observer<Real> {
  model::StallRule rule;
  Real least_separation;
  std::vector<int> unmoved;
  std::uint64_t count = 0;

  void on_impact(const Impact<Real>& impact, Simulation<Real>& simulation) override {
    unmoved.resize(static_cast<std::size_t>(simulation.ball_count()));
    bool rests = false;
    for (int body = 0; body < (impact.with_wall ? 1 : 2); ++body) {
      int& own = unmoved[static_cast<std::size_t>(body == 0 ? impact.ball : impact.partner)];
      const bool moved = impact.flight_time[body] >= least_separation / rule.acceleration;
      rests = rests || (!moved && own >= rule.impacts);
      own = moved ? 0 : own + 1;
    }
    ASSERT_EQ(impact.outcome.in_stall, rests) << impact.index;
    if (!rests) return;
    ++count;
    ASSERT_EQ(impact.outcome.tangential_impulse, 0) << impact.index;
    ASSERT_EQ(impact.outcome.restitution_tangential, 1) << impact.index;
    if (count >= 50) simulation.request_stop(EndReason::stopped);
  }
};

template <class Real> class StallRules : public ::testing::Test {};
using Scalars = ::testing::Types<double, float128, mpfr>;
TYPED_TEST_SUITE(StallRules, Scalars);

/// A ball between a piston and a wall: its flights become shorter and shorter. The rule is the same
/// in every scalar.
TYPED_TEST(StallRules, FrictionRestsAfterSoManyImpactsWithoutTimeToMove) {
  const auto spec = casefile::parse_case(jams().front().text, "jam.toml");
  const auto built = casefile::build_case<TypeParam>(spec);
  Simulation<TypeParam> simulation(built.the_case, built.states, built.start);
  Rested<TypeParam> seen;
  seen.least_separation = built.the_case.mill.ball_wall.least_separation;
  simulation.attach(seen);
  EXPECT_EQ(simulation.run_until(simulation.clock().at(TypeParam(2))), EndReason::stopped);
  EXPECT_EQ(seen.count, 50u);
}

/// Without a least separation speed, a row of balls that touch has finitely many impacts at one
/// instant, as many as it takes, where the balls are elastic enough; three balls below e = 7 - 4
/// sqrt(3) have infinitely many.
EndReason end_of_row(int balls, const std::string& restitution, std::uint64_t& impacts) {
  std::string text =
      "[run]\nend_time = \"1 ms\"\n[mill]\ntype = \"still\"\n[vessel]\ntype = \"sphere\"\n"
      "diameter = \"10 m\"\n[contact]\nrestitution = " +
      restitution + "\nfriction = 0\nleast_separation = \"0 m/s\"\n";
  for (int k = 0; k < balls; ++k)
    text += ball("62.5 mm", "[\"" + std::to_string(62.5 * k) + " mm\", \"0\", \"0\"]",
        k == 0               ? "velocity = [\"1\", \"0\", \"0\"]\n"
            : k + 1 == balls ? "velocity = [\"-1\", \"0\", \"0\"]\n"
                             : "");
  const auto built = casefile::build_case<double>(casefile::parse_case(text, "row.toml"));
  Simulation<double> simulation(built.the_case, built.states, built.start);
  const auto reason = simulation.run_until(simulation.clock().at(1e-3));
  impacts = simulation.counts().impacts;
  return reason;
}

TEST(InelasticCollapse, RowsOfTouchingBallsEndWhereTheirSequenceIsFinite) {
  std::uint64_t impacts = 0;
  for (const int balls : {3, 5, 12, 30})
    for (const char* restitution : {"1", "0.99", "0.95"}) {
      EXPECT_EQ(end_of_row(balls, restitution, impacts), EndReason::end_time)
          << balls << " balls, e " << restitution;
      EXPECT_GE(impacts, static_cast<std::uint64_t>(balls) - 1);
    }
  // 7 - 4 sqrt(3) = 0.07180; each impact leaves about the root of e of the speeds.
  EXPECT_EQ(end_of_row(3, "0.075", impacts), EndReason::end_time);
  EXPECT_GT(impacts, 10u);
  EXPECT_EQ(end_of_row(3, "0.070", impacts), EndReason::inelastic_collapse);
}

}  // namespace
}  // namespace edmill::engine
