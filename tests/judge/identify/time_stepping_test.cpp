// Logs of known time steps, contact times and integrators, written here and not by a run.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core.hpp"
#include "identify/identify.hpp"

namespace edmill::identify {
namespace {

/// A ball of 10 mm that bounces on the floor of a box that stands still: each line is a contact
/// that lasts.
class Bounces : public testing::Test {
 protected:
  Bounces()
      : built(casefile::build_case<double>(casefile::parse_case(
            "[run]\nend_time = \"1 s\"\ngravity = \"9.8 m/s2\"\n[mill]\ntype = "
            "\"still\"\n[vessel]\ntype = \"box\"\n"
            "size = [\"1 m\", \"1 m\", \"1 m\"]\n[contact]\nrestitution = 0.9\nfriction "
            "= 0.3\n[[ball]]\ndiameter = \"10 mm\"\n"
            "position = [\"0 m\", \"0 m\", \"0 m\"]\n",
            "bounces.toml"))) {
    log.file = "log.csv";
    for (auto& body : log.available.body) body = {true, true, true, true, true};
  }

  /// @param duration  of a contact, by its approach speed; a line has the begin of its contact,
  /// rounded up to a step
  /// @param step      [s]; 0 for exact times
  /// @param slip      [s]; step of an integrator of first order, with which flights fall g slip t/2
  /// too far
  template <class Duration>
  void write(int count, const Duration& duration, double step, double slip) {
    constexpr double g = 9.8, floor = -0.5 + 0.005;
    double speed = 2, time = 0.01;
    for (int k = 0; k < count; ++k) {
      audit::LoggedEvent e;
      e.ball = 0, e.with_wall = true, e.partner = 0;
      e.time = step > 0 ? std::ceil(time / step) * step : time;
      const double late = e.time - time,
                   up = speed > 0.8 ? 0.9 * speed : 2.0;  // a kick now and then
      auto& b = e.body[0];
      b.position = {0, floor - speed * late - g / 2 * late * late, 0};
      b.velocity_before = {0, -speed - g * late, 0};
      b.velocity_after = {0, up, 0};
      log.events.push_back(e);
      const double flight = 2 * up / g - slip;  // 0 = up t - g t (t + slip)/2
      time += duration(speed) + flight;
      speed = g * flight - up;
    }
  }
  /// The ball drifts across the floor.
  void drift() {
    for (auto& e : log.events) {
      auto& b = e.body[0];
      b.position[0] = 0.3 * e.time, b.velocity_before[0] = b.velocity_after[0] = 0.3;
    }
  }
  TimeStepping found() const { return time_stepping(log, built.the_case, audit::Options{}); }

  casefile::InitialCase<double> built;
  audit::EventsAtHand log;
};

constexpr auto at_once = [](double) { return 0.0; };

TEST_F(Bounces, AHardContactWithoutStepsShowsNothing) {
  write(100, at_once, 0, 0);
  const auto result = found();
  EXPECT_FALSE(result.found()) << table(result);
}

TEST_F(Bounces, ALinearSpringHasOneDuration) {
  write(
      100, [](double) { return 50e-6; }, 0, 0);
  const auto result = found();
  ASSERT_TRUE(result.soft) << table(result);
  EXPECT_NEAR(result.soft->duration, 50e-6, 1e-6);
  EXPECT_NEAR(result.soft->exponent, 0, 0.02);
  EXPECT_EQ(result.soft->at, LoggedAt::begin);
  // M (pi/t)^2 for a ball of 8 g/cm3
  const double mass = 8000 * 4.0 / 3 * M_PI * std::pow(0.005, 3);
  EXPECT_NEAR(result.soft->spring, mass * std::pow(M_PI / 50e-6, 2), 0.05 * result.soft->spring);
  EXPECT_FALSE(result.step);
}

TEST_F(Bounces, HertzContactsLastLongerWhereTheyAreGentle) {
  write(
      100, [](double speed) { return 50e-6 * std::pow(speed, -0.2); }, 0, 0);
  const auto result = found();
  ASSERT_TRUE(result.soft) << table(result);
  EXPECT_NEAR(result.soft->exponent, -0.2, 0.03);
}

TEST_F(Bounces, StepsShowInTimesAndDepths) {
  write(200, at_once, 3e-6, 0);
  const auto result = found();
  ASSERT_TRUE(result.step);
  EXPECT_NEAR(*result.step, 3e-6, 1e-12);
  ASSERT_TRUE(result.step_by_depth);
  EXPECT_NEAR(*result.step_by_depth, 3e-6, 0.3e-6);
  EXPECT_FALSE(result.first_order_step);
}

TEST_F(Bounces, TimesThatAreOffMoveBallsAlongTheirPathsAlone) {
  write(200, at_once, 0, 0);
  drift();
  constexpr unsigned seed = 20261127;
  std::mt19937 random(seed);
  std::normal_distribution<double> off(0, 2e-6);
  for (auto& e : log.events) e.time += off(random);
  const auto result = found();
  ASSERT_TRUE(result.jitter) << "seed " << seed << table(result);
  EXPECT_NEAR(*result.jitter, 2e-6, 0.4e-6) << "seed " << seed;
  EXPECT_FALSE(result.step || result.soft || result.first_order_step) << table(result);
}

TEST_F(Bounces, NothingElseIsCalledJitter) {
  for (const double late : {3e-6, 0.0})
    for (const double slip : {2e-5, 0.0}) {
      log.events.clear();
      write(200, at_once, late, slip);
      drift();
      EXPECT_FALSE(found().jitter) << late << " " << slip << table(found());
    }
  log.events.clear();
  write(
      200, [](double) { return 50e-6; }, 0, 0);
  drift();
  EXPECT_FALSE(found().jitter) << table(found());
  for (auto& e : log.events) e.time *= 1.001;  // a clock that runs fast
  EXPECT_FALSE(found().jitter) << table(found());
}

TEST_F(Bounces, AnIntegratorOfFirstOrderLeavesTheParabola) {
  write(200, at_once, 0, 2e-5);
  const auto result = found();
  ASSERT_TRUE(result.first_order_step) << table(result);
  EXPECT_NEAR(*result.first_order_step, 2e-5, 1e-7);
}

}  // namespace
}  // namespace edmill::identify
