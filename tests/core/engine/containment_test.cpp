// No ball overlaps a wall, or a ball of an impact another one, beyond rounding after any impact,
// and late starts are as sharp as early ones. Gaps are computed from the stored flights in
// float128; a filter in double selects those that are small.
#include <gtest/gtest.h>

#include "mill_parts.hpp"
#include "spex_case.hpp"

namespace edmill::engine {
namespace {

/// After every impact, the deepest overlap of any ball with any wall, and of the impact's balls
/// with any ball [m]; of any two balls after every impact whose number is a multiple of `every`.
class OverlapCheck : public Observer<double> {
 public:
  explicit OverlapCheck(std::uint64_t every) : every_(every) {}
  void on_impact(const Impact<double>& impact, Simulation<double>& simulation) override {
    const int n = simulation.ball_count();
    positions_.resize(n);
    for (int i = 0; i < n; ++i) positions_[i] = simulation.state_at(i, impact.time).position;
    const auto& mill = simulation.mill();
    const auto pose = mill.motion.pose({0, impact.time.offset});
    for (int i = 0; i < n; ++i) {
      const auto p = mill.motion.to_vessel_frame(pose, positions_[i], positions_[i]).position;
      const double r = simulation.properties(i).radius;
      const double side = testing::cylinder(mill).radius - r - std::hypot(p[0], p[2]);
      const double cap = testing::cylinder(mill).half_height - r - std::abs(p[1]);
      if (side < near || cap < near) exact_wall(simulation, impact.time, i);
      if (events % every_ == 0) pairs_below(i, i, simulation, impact.time);
    }
    pairs_below(n, impact.ball, simulation, impact.time);
    if (!impact.with_wall) pairs_below(n, impact.partner, simulation, impact.time);
    ++events;
  }

  float128 deepest_wall{0}, deepest_pair{0};
  std::uint64_t events = 0;
 private:
  static constexpr double near = 1e-12;  // double gaps err by far less

  /// The ball and all with a number below `end`.
  void pairs_below(
      int end, int ball, const Simulation<double>& simulation, const Instant<double>& time) {
    const double radius = simulation.properties(ball).radius;
    for (int j = 0; j < end; ++j) {
      if (j == ball) continue;
      const Vec3<double> d = positions_[ball] - positions_[j];
      const double sum = radius + simulation.properties(j).radius + near;
      if (dot<double>(d, d) < sum * sum) exact_pair(simulation, time, ball, j);
    }
  }

  static Vec3<float128> position(const Simulation<double>& s, const Instant<double>& t, int i) {
    const auto flight = dynamics::flight_cast<float128>(s.flight(i));
    const DriveClock<float128> clock{float128(s.clock().period())};
    return dynamics::position_after<float128>(flight, vector_cast<float128>(s.mill().gravity),
        clock.elapsed(flight.start, dynamics::instant_cast<float128>(t)));
  }
  void exact_wall(const Simulation<double>& s, const Instant<double>& t, int i) {
    const auto& m = s.mill();
    const model::SpexMotion<float128> motion{testing::spex(m).arm(), testing::spex(m).theta_max(),
        testing::spex(m).gamma_max(), m.motion.period()};
    const auto pose = motion.pose({0, float128(t.offset)});
    const auto r = position(s, t, i);
    const auto p = motion.to_vessel_frame(pose, r, r).position;
    const float128 radius = s.properties(i).radius;
    const float128 side =
        sqrt(p[0] * p[0] + p[2] * p[2]) - (float128(testing::cylinder(m).radius) - radius);
    const float128 cap = abs(p[1]) - (float128(testing::cylinder(m).half_height) - radius);
    deepest_wall = std::max({deepest_wall, side, cap});
  }
  void exact_pair(const Simulation<double>& s, const Instant<double>& t, int i, int j) {
    const float128 sum = float128(s.properties(i).radius) + float128(s.properties(j).radius);
    const float128 distance = norm<float128>(Vec3<float128>(position(s, t, i) - position(s, t, j)));
    deepest_pair = std::max(deepest_pair, float128(sum - distance));
  }
  std::uint64_t every_;
  std::vector<Vec3<double>> positions_;
};

OverlapCheck deepest_overlap(const std::string& contact, const std::string& balls, double start,
    double seconds, std::uint64_t every = 50) {
  const auto spec =
      casefile::parse_case(testing::spex_text("initial_time = \"" + std::to_string(start) +
                                   " s\"\nend_time = \"" + std::to_string(start + seconds) + " s\"",
                               contact, balls),
          "containment.toml");
  const auto built = casefile::build_case<double>(spec);
  Simulation<double> simulation(built.the_case, built.states, built.start);
  OverlapCheck check(every);
  simulation.attach(check);
  EXPECT_EQ(simulation.run_until(simulation.clock().at(start + seconds)), EndReason::end_time);
  std::cout << check.events << " events from " << start << " s: deepest overlap with a wall "
            << static_cast<double>(check.deepest_wall) << " m, of two balls "
            << static_cast<double>(check.deepest_pair) << " m\n";
  return check;
}

constexpr const char* demo_contact = "restitution = 0.53";

TEST(Containment, DemoCaseNeverOverlapsBeyondRounding) {
  const auto check = deepest_overlap(demo_contact, testing::batch(28, "4.76 mm"), 0, 10);
  EXPECT_GT(check.events, 100000u);
  EXPECT_LT(check.deepest_wall, 1e-14);
  EXPECT_LT(check.deepest_pair, 1e-14);
}

TEST(Containment, LongDemoCaseNeverOverlapsBeyondRoundingInAnyPair) {
  const auto check = deepest_overlap(demo_contact, testing::batch(28, "4.76 mm"), 0, 10, 1);
  EXPECT_LT(check.deepest_wall, 1e-14);
  EXPECT_LT(check.deepest_pair, 1e-14);
}

TEST(Containment, TwoHundredSmallBallsNeverOverlapBeyondRounding) {
  const auto check = deepest_overlap("restitution = 0.56", testing::batch(200, "2.36 mm"), 0, 1);
  EXPECT_GT(check.events, 20000u);
  EXPECT_LT(check.deepest_wall, 1e-14);
  EXPECT_LT(check.deepest_pair, 1e-14);
}

TEST(Containment, DenseBallsNeverOverlapBeyondRounding) {
  // Many near neighbours, so that agendas overflow: dropped contacts must be found again in time.
  const auto check = deepest_overlap(
      "restitution = 0.8", testing::batch(500, "2.36 mm", "gap_ball = \"0.5 mm\"\n"), 0, 0.15);
  EXPECT_GT(check.events, 20000u);
  EXPECT_LT(check.deepest_wall, 1e-14);
  EXPECT_LT(check.deepest_pair, 1e-14);
}

TEST(Containment, NineHundredBallsNeverOverlapAtAnImpact) {
  const auto spec =
      casefile::parse_case(testing::spex_text("end_time = \"0.5 s\"", "restitution = 0.8",
                               testing::batch(908, "2.36 mm", "gap_ball = \"0.3 mm\"\n")),
          "dense.toml");
  const auto built = casefile::build_case<double>(spec);
  Simulation<double> simulation(built.the_case, built.states, built.start);
  EXPECT_EQ(simulation.run_until(simulation.clock().at(0.5)), EndReason::end_time);
  EXPECT_GT(simulation.counts().impacts, 500000u);
  EXPECT_LT(simulation.counts().deepest_overlap, 1e-14);
}

TEST(Containment, AStartAtThousandSecondsIsAsPreciseAsOneAtZero) {
  const auto early = deepest_overlap(demo_contact, testing::batch(28, "4.76 mm"), 0, 1);
  const auto late = deepest_overlap(demo_contact, testing::batch(28, "4.76 mm"), 1000, 1);
  // Both are a few ulps of the positions; a clock in plain seconds would make the late one 1e4
  // times deeper.
  EXPECT_LT(late.deepest_wall, 4 * early.deepest_wall);
  EXPECT_LT(late.deepest_pair, 4 * early.deepest_pair);
  EXPECT_LT(late.deepest_wall, 1e-14);
}

}  // namespace
}  // namespace edmill::engine
