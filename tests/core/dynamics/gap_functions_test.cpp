// The bounds that certify decisions: rounding errors of the gaps and derivatives of the gap
// functions.
#include "dynamics/gap_functions.hpp"

#include <gtest/gtest.h>

#include <iostream>

#include "casefile/random.hpp"
#include "mill_parts.hpp"
#include "spex_case.hpp"

namespace edmill::dynamics {
namespace {

/// A ball of random size somewhere in the vessel at the instant, flying at random.
struct GapFlight {
  Flight<double> flight;
  double radius;
  std::int64_t period;
  double offset;

  GapFlight(casefile::Random& random, const model::Mill<double>& mill, double top_speed) {
    const auto uniform = [&] { return random.uniform<double>(); };
    const auto symmetric = [&] { return random.symmetric<double>(); };
    radius = 0.001 + 0.005 * uniform();
    const Vec3<double> local{0.7 * testing::cylinder(mill).radius * symmetric(),
        testing::cylinder(mill).half_height * symmetric(),
        0.7 * testing::cylinder(mill).radius * symmetric()};
    flight.start = {0, uniform() * mill.motion.period()};
    flight.position = mill.motion.to_inertial(mill.motion.pose({0, flight.start.offset}), local);
    flight.velocity = Vec3<double>(symmetric(), symmetric(), symmetric()) * (top_speed * uniform());
    // Up to half a period later, often in the next one.
    const double later = flight.start.offset + 0.1 * mill.motion.period() * uniform();
    period = later < mill.motion.period() ? 0 : 1;
    offset = period ? later - mill.motion.period() : later;
  }
};

/// The mill of the SPEX with an arm of this length.
template <class Real> model::Mill<Real> mill_with_arm(const char* metres) {
  auto mill = testing::spex_mill<Real>();
  const auto& spex = testing::spex(mill);
  mill.motion = model::SpexMotion<Real>(
      from_text<Real>(metres), spex.theta_max(), spex.gamma_max(), spex.period());
  return mill;
}

class GapErrorsAtArm : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(GapFunctions, GapErrorsAtArm, ::testing::Values("0.1", "0", "5", "200"));

TEST_P(GapErrorsAtArm, RoundingErrorsStayBelowTheirBounds) {
  const auto mill = mill_with_arm<double>(GetParam());
  const auto constants = testing::moving(mill);
  const auto wide_mill = model::mill_cast<mpfr>(mill);
  const auto wide_constants = testing::moving(wide_mill);
  casefile::Random random(21);
  double worst_gap = 0, worst_rate = 0, worst_curvature = 0;
  for (int k = 0; k < 20000; ++k) {
    const GapFlight r(random, mill, 10);
    const testing::GeneralFunctions<double> narrow(constants, r.flight, r.radius, r.period);
    const testing::GeneralFunctions<mpfr> exact(
        wide_constants, flight_cast<mpfr>(r.flight), mpfr(r.radius), r.period);
    const auto found = narrow.start(r.offset);
    const auto truth = exact.start(mpfr(r.offset));
    const double elapsed = narrow.elapsed(r.offset);
    const double speed = norm<double>(r.flight.velocity) + constants.gravity_size * elapsed;
    const auto bound = narrow.errors(elapsed, speed);
    for (int w = 0; w < mill.vessel.wall_count(); ++w) {
      worst_gap = std::max(
          worst_gap, static_cast<double>(abs(mpfr(found.gap[w]) - truth.gap[w])) / bound.gap[w]);
      worst_rate = std::max(worst_rate,
          static_cast<double>(abs(mpfr(found.rate[w]) - truth.rate[w])) / bound.rate[w]);
      worst_curvature = std::max(worst_curvature,
          static_cast<double>(abs(mpfr(found.curvature[w]) - truth.curvature[w])) /
              bound.curvature[w]);
    }
  }
  std::cout << "largest error over its bound: gap " << worst_gap << ", rate " << worst_rate
            << ", curvature " << worst_curvature << "\n";
  EXPECT_LT(worst_gap, 1);
  EXPECT_LT(worst_rate, 1);
  EXPECT_LT(worst_curvature, 1);
  EXPECT_GT(worst_curvature, 0.001);
  // Bounds far above the errors would escalate decisions that double could make.
  EXPECT_GT(worst_gap, 0.02);
}

TEST(GapFunctions, ErrorsOfRoundedStatesStayBelowTheirBounds) {
  const auto wide_mill = testing::spex_mill<mpfr>();
  const auto mill = model::mill_cast<double>(wide_mill);
  const auto constants = testing::moving(mill);
  const auto wide_constants = testing::moving(wide_mill);
  casefile::Random random(23);
  double worst_gap = 0, worst_rate = 0, worst_curvature = 0;
  for (int k = 0; k < 50000; ++k) {
    const GapFlight r(random, mill, 10);
    // Digits below those of double, anywhere up to half a unit in the last place.
    const auto more = [&](double x) {
      return mpfr(x) * (1 + mpfr(random.symmetric<double>()) * 0x1p-54);
    };
    auto wide = flight_cast<mpfr>(r.flight);
    for (int n = 0; n < 3; ++n) {
      wide.position[n] = more(r.flight.position[n]);
      wide.velocity[n] = more(r.flight.velocity[n]);
    }
    wide.start.offset = more(r.flight.start.offset);
    const mpfr radius = more(r.radius);
    const testing::GeneralFunctions<double> narrow(
        constants, flight_cast<double>(wide), static_cast<double>(radius), r.period);
    const testing::GeneralFunctions<mpfr> exact(wide_constants, wide, radius, r.period);
    const auto found = narrow.start(r.offset);
    const auto truth = exact.start(mpfr(r.offset));
    const double elapsed = narrow.elapsed(r.offset);
    const double speed = norm<double>(r.flight.velocity) + constants.gravity_size * elapsed;
    const auto own = narrow.errors(elapsed, speed), state = narrow.state_errors(elapsed, speed);
    const auto bound = own + state;
    // The effect of the state alone, in 50 digits.
    const auto rounded_constants = testing::moving(model::mill_cast<mpfr>(mill));
    const auto moved = testing::GeneralFunctions<mpfr>(rounded_constants,
        flight_cast<mpfr>(flight_cast<double>(wide)), mpfr(static_cast<double>(radius)), r.period)
                           .start(mpfr(r.offset));
    const auto part = [](const mpfr& a, const mpfr& b, double limit) {
      return static_cast<double>(abs(a - b)) / limit;
    };
    for (int w = 0; w < mill.vessel.wall_count(); ++w) {
      EXPECT_LT(part(mpfr(found.gap[w]), truth.gap[w], bound.gap[w]), 1);
      EXPECT_LT(part(mpfr(found.rate[w]), truth.rate[w], bound.rate[w]), 1);
      worst_gap = std::max(worst_gap, part(moved.gap[w], truth.gap[w], state.gap[w]));
      worst_rate = std::max(worst_rate, part(moved.rate[w], truth.rate[w], state.rate[w]));
      EXPECT_LT(part(mpfr(found.curvature[w]), truth.curvature[w], bound.curvature[w]), 1);
      worst_curvature = std::max(
          worst_curvature, part(moved.curvature[w], truth.curvature[w], state.curvature[w]));
    }
  }
  std::cout << "largest error of a rounded state over its bound: gap " << worst_gap << ", rate "
            << worst_rate << ", curvature " << worst_curvature << "\n";
  EXPECT_LT(worst_curvature, 1);
  EXPECT_LT(worst_gap, 1);
  EXPECT_LT(worst_rate, 1);
  EXPECT_GT(worst_gap, 0.02);
}

/// Central differences of the gap in 50 digits.
std::array<mpfr, 3> derivatives(const testing::GeneralFunctions<mpfr>& f, const mpfr& t, int wall) {
  const mpfr h("1e-8");
  const auto g = [&](int k) { return f(t + k * h).gap[wall]; };
  const mpfr h2 = h * h;
  return {(g(1) - 2 * g(0) + g(-1)) / h2, (g(2) - 2 * g(1) + 2 * g(-1) - g(-2)) / (2 * h2 * h),
      (g(2) - 4 * g(1) + 6 * g(0) - 4 * g(-1) + g(-2)) / (h2 * h2)};
}

TEST(MotionBounds, DerivativesOfTheGapsStayBelowTheirBounds) {
  const auto mill = testing::spex_mill<mpfr>();
  const auto narrow_mill = testing::spex_mill<double>();
  const auto constants = testing::moving(mill);
  const BoundsTable table(testing::moving(narrow_mill));
  casefile::Random random(22);
  std::array<double, 3> worst_y{}, worst_q{};
  for (int k = 0; k < 5000; ++k) {
    const GapFlight r(random, narrow_mill, 10);
    const double length = table.longest_window() * (0.01 + 0.99 * random.uniform<double>());
    const testing::GeneralFunctions<mpfr> f(
        constants, flight_cast<mpfr>(r.flight), mpfr(r.radius), r.flight.start.period);
    const double speed = norm<double>(r.flight.velocity) + 9.8 * length;
    const auto bound = table.at(speed, length);
    for (int step = 0; step <= 4; ++step) {
      const mpfr t = mpfr(r.flight.start.offset) + mpfr(length) * step / 4;
      const auto y = derivatives(f, t, 0), q = derivatives(f, t, 2);
      for (int n = 0; n < 3; ++n) {
        worst_y[n] = std::max(worst_y[n], static_cast<double>(abs(y[n])) / bound[0][n]);
        worst_q[n] = std::max(worst_q[n], static_cast<double>(abs(q[n])) / bound[1][n]);
      }
    }
  }
  for (int n = 0; n < 3; ++n) {
    std::cout << "derivative " << n + 2 << ": largest over its bound " << worst_y[n] << " (y), "
              << worst_q[n] << " (q)\n";
    EXPECT_LT(worst_y[n], 1);
    EXPECT_LT(worst_q[n], 1);
    EXPECT_GT(
        worst_y[n], 0.05);  // a bound that is far off would only cost time, but would be a mistake
  }
}

}  // namespace
}  // namespace edmill::dynamics
