// With a least separation speed v_s every run continues: a ball that a bounded acceleration a
// presses on a wall returns to it after 2 v_s / a at the earliest.
#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <numbers>

#include "event_recorder.hpp"
#include "random_physics.hpp"
#include "spex_case.hpp"

namespace edmill::engine {
namespace {

using testing::draw;

/// A ball near a wall of a vessel at rest, pressed on it by gravity.
struct PressedBall {
  static constexpr double arm = 1000, half_size = 100, radius = 0.5;  // [m]
  int wall;
  double acceleration, gap, speed;  ///< towards the wall
  model::ContactLaw<double> law;

  /// Impacts with that wall up to `end` [s]; none with another.
  std::size_t impacts(double end) const {
    // The vessel's axis points along -X, and the arm along Y.
    const Vec3<double> towards = wall == 0 ? Vec3<double>{1, 0, 0}
        : wall == 1                        ? Vec3<double>{-1, 0, 0}
                                           : Vec3<double>{0, -1, 0};
    model::Case<double> the_case{};
    the_case.mill = {model::SpexMotion<double>(arm, 0, 0, 0.125),
        model::CylinderVessel<double>{half_size, half_size}, towards * acceleration, law, law};
    the_case.balls = {{radius, 1, 0.4}};
    const Vec3<double> place = Vec3<double>{0, arm, 0} + towards * (half_size - radius - gap);
    Simulation<double> simulation(the_case, {{place, towards * speed, {3, -2, 1}}}, {});
    testing::EventRecorder<double> log;
    simulation.attach(log);
    EXPECT_EQ(simulation.run_until(simulation.clock().at(end)), EndReason::end_time);
    for (const auto& impact : log.impacts) EXPECT_TRUE(impact.with_wall && impact.partner == wall);
    return log.impacts.size();
  }
};

PressedBall draw_pressed_ball() {
  PressedBall ball;
  ball.wall = *rc::gen::inRange(0, 3);
  ball.acceleration = draw<double>(0.1, 100);
  auto& law = ball.law;
  model::WaltonBraun<double> coulomb;
  coulomb.normal = *rc::gen::inRange(0, 4) == 0 ? 0.0 : draw<double>(0, 1);
  coulomb.friction =
      ball.wall == 2 ? 0 : draw<double>(0, 2);  // along the cylinder it would leave the place
  law.law = coulomb;
  law.least_separation = std::pow(10, draw<double>(-4, 0));
  const double v = law.least_separation;
  ball.gap = draw<double>(0.01, 3) * v * v / ball.acceleration;
  ball.speed = draw<double>(0, 3) * v;
  return ball;
}

TEST(LeastSeparation, APressedBallHitsItsWallNoMoreOftenThanItsHopsAllow) {
  EXPECT_TRUE(rc::check([] {
    const PressedBall ball = draw_pressed_ball();
    const double hop = 2 * ball.law.least_separation / ball.acceleration;
    const double time = hop * draw<double>(1, 200);
    RC_ASSERT(static_cast<double>(ball.impacts(time)) <= time / hop + 2);
  }));
}

TEST(LeastSeparation, ABallWithoutRestitutionHopsForEver) {
  // From the first impact on it hops with v_s: impact k = 0, 1, ... is at t_0 + k 2 v_s / a.
  PressedBall ball{1, 10, 0.05, 0, {}};
  ball.law = {model::WaltonBraun<double>{.normal = 0}, 0.01};
  const double first = std::sqrt(2 * 0.05 / 10), hop = 2 * 0.01 / 10;
  EXPECT_EQ(ball.impacts(first + 999.5 * hop), 1000u);
}

TEST(LeastSeparation, ABouncingBallSettlesAtItsWall) {
  const auto spec = casefile::parse_case(
      "[run]\nend_time = \"20 s\"\ngravity = [\"-1\", \"0\", \"0\"]\n[mill]\ntype = \"still\"\n"
      "[vessel]\ndiameter = \"8 m\"\nheight = \"8 m\"\n"
      "[contact]\nrestitution = 0.6\nfriction = 0\nleast_separation = \"1 mm/s\"\n"
      "[[ball]]\ndiameter = \"1 m\"\nposition = [\"-0.5 m\", \"0.1 m\", \"0\"]\n",
      "drop.toml");
  const auto built = casefile::build_case<double>(spec);
  Simulation<double> simulation(built.the_case, built.states, built.start);
  EXPECT_EQ(simulation.run_until(simulation.clock().at(20.0)), EndReason::end_time);
  // The exact model collapses at 9.798 s; here hops of v_s^2 / (2 g) = 5e-7 m are left.
  const double height = simulation.state_at(0, simulation.now()).position[0] + 3.5;
  EXPECT_GT(height, -1e-15);
  EXPECT_LT(height, 5e-7 * (1 + 1e-6));
}

TEST(LeastSeparation, ABallInACornerGoesOn) {
  // Friction at one wall takes the motion along the normal of the other.
  const auto spec = casefile::parse_case(
      "[run]\nend_time = \"5 s\"\ngravity = [\"-10\", \"-10\", \"0\"]\n[mill]\ntype = \"still\"\n"
      "[vessel]\ndiameter = \"8 m\"\nheight = \"8 m\"\n[contact]\nrestitution = 0.5\nfriction = "
      "0.4\n"
      "[[ball]]\ndiameter = \"1 m\"\nposition = [\"-3 m\", \"-3 m\", \"0\"]\n",
      "corner.toml");
  const auto built = casefile::build_case<double>(spec);
  Simulation<double> simulation(built.the_case, built.states, built.start);
  EXPECT_EQ(simulation.run_until(simulation.clock().at(5.0)), EndReason::end_time);
  EXPECT_LT(simulation.counts().deepest_overlap, 1e-13);
  EXPECT_LE(
      simulation.counts().impacts, 2 * (5 * 10 / 0.02 + 2));  // hops of 2 v_s / a at either wall
}

/// Impacts of each ball with each wall: the most in any stretch of time of a given length.
class BurstCheck : public Observer<double> {
 public:
  explicit BurstCheck(double stretch) : stretch_(stretch) {}

  void on_impact(const Impact<double>& impact, Simulation<double>& simulation) override {
    if (!impact.with_wall) return;
    auto& times = times_[{impact.ball, impact.partner}];
    const double now = simulation.clock().seconds(impact.time);
    times.push_back(now);
    while (times.front() < now - stretch_) times.pop_front();
    most = std::max(most, times.size());
  }
  std::size_t most = 0;
 private:
  double stretch_;
  std::map<std::pair<int, int>, std::deque<double>> times_;
};

TEST(LeastSeparation, TheDemoWithOtherFrictionMakesNoBurst) {
  // A rule by the time since the last impact let one ball of this case hit a wall 30 000 times in
  // 50 ms.
  auto text = testing::spex_text(
      "end_time = \"10 s\"", "restitution = 0.53", testing::batch(28, "4.76 mm"));
  const auto spec = casefile::parse_case(text, "demo.toml", {"contact.friction=0.38"});
  const auto built = casefile::build_case<double>(spec);
  Simulation<double> simulation(built.the_case, built.states, built.start);
  const double stretch = 0.05;
  BurstCheck bursts(stretch);
  simulation.attach(bursts);
  EXPECT_EQ(simulation.run_until(simulation.clock().at(10.0)), EndReason::end_time);
  // The largest acceleration of a point of the vessel, with D and r the largest distances from the
  // fulcrum and the vessel's centre: A w^2 (D + r) by the angular accelerations, (A w)^2 (D + 2 r)
  // by the velocities, and g.
  const double amplitude = std::numbers::pi / 12, omega = 2 * std::numbers::pi * 1054 / 60;
  const double r = std::hypot(0.019, 0.0285), reach = 0.1 + r;
  const double acceleration =
      amplitude * omega * omega * (reach + r + amplitude * (reach + 2 * r)) + 9.8;
  const double bound = acceleration * stretch / (2 * 0.01);
  std::cout << "most impacts of a ball with a wall in 50 ms: " << bursts.most << ", bound " << bound
            << '\n';
  EXPECT_LT(static_cast<double>(bursts.most), bound);
}

}  // namespace
}  // namespace edmill::engine
