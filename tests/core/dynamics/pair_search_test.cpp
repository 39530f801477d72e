// Two balls in flight: the time of their contact and the bound on its error, against 200 digits,
// from millimetres down to radii near the rounding of a position.
#include "dynamics/pair_search.hpp"

#include <gtest/gtest.h>

#include <iostream>

#include "casefile/random.hpp"
#include "dynamics/decision_ladder.hpp"
#include "spex_case.hpp"

namespace edmill::dynamics {
namespace {

/// First contact by (3.1) in 200 digits from `now` on, which may be in the past by rounding [s].
std::optional<mpfr_of<200>> exact_delay(const Flight<double>& i, const Flight<double>& j,
    const Instant<double>& now, double radius_sum, const model::Mill<double>& mill) {
  const auto wide = [](const Vec3<double>& v) { return vector_cast<mpfr_of<200>>(v); };
  const auto age = [&](const Flight<double>& f) {
    return mpfr_of<200>(now.period - f.start.period) * mpfr_of<200>(mill.motion.period()) +
        (mpfr_of<200>(now.offset) - mpfr_of<200>(f.start.offset));
  };
  const Vec3<mpfr_of<200>> g = wide(mill.gravity);
  const auto at = [&](const Flight<double>& f) {
    return Vec3<mpfr_of<200>>(
        wide(f.position) + wide(f.velocity) * age(f) + g * (age(f) * age(f) / 2));
  };
  const auto speed = [&](const Flight<double>& f) {
    return Vec3<mpfr_of<200>>(wide(f.velocity) + g * age(f));
  };
  const Vec3<mpfr_of<200>> r = at(i) - at(j), v = speed(i) - speed(j);
  const mpfr_of<200> b = r.dot(v),
                     c = r.dot(r) - mpfr_of<200>(radius_sum) * mpfr_of<200>(radius_sum),
                     v2 = v.dot(v);
  const mpfr_of<200> discriminant = b * b - v2 * c;
  if (discriminant < 0 || b >= 0) return std::nullopt;
  return mpfr_of<200>(c / (sqrt(discriminant) - b));
}

TEST(PairSearch, TheErrorOfATimeStaysBelowItsBound) {
  const auto mill = testing::spex_mill<double>();
  const double reach = 0.14, top_speed = 20;
  casefile::Random random(20110101);
  const auto somewhere = [&](double size) {
    return Vec3<double>(size * random.symmetric<double>(), size * random.symmetric<double>(),
        size * random.symmetric<double>());
  };
  for (const double radius : {2e-3, 1e-5, 5e-8}) {
    const PairSearch<double> search(mill, 2 * radius, reach, top_speed);
    const DriveClock<double> clock(mill.motion.period());
    double worst = 0;
    int contacts = 0;
    for (int k = 0; k < 20000; ++k) {
      const Instant<double> now{3, 0.03};
      // Two flights that began at different times and meet off centre after a while.
      const Vec3<double> meeting = Vec3<double>(0, 0.1, 0) + somewhere(0.02);
      Vec3<double> apart = somewhere(1);
      apart *= 2 * radius / norm<double>(apart);
      const double until = 0.01 * random.uniform<double>();
      Flight<double> i{{}, somewhere(3), clock.after(now, -0.05 * random.uniform<double>())},
          j{{}, somewhere(3), clock.after(now, -0.05 * random.uniform<double>())};
      for (auto [f, sign] : {std::pair{&i, 0.5}, std::pair{&j, -0.5}}) {
        const double t = clock.elapsed(f->start, now) + until;
        f->position = meeting + sign * apart - t * (f->velocity + t / 2 * mill.gravity);
      }
      const auto answer = search(search.state(i, now), j, now, 2 * radius);
      if (answer.verdict != Verdict::contact || answer.delay == 0) continue;
      const auto exact = exact_delay(i, j, now, 2 * radius, mill);
      ASSERT_TRUE(exact.has_value());
      ++contacts;
      worst = std::max(
          worst, static_cast<double>(abs(mpfr_of<200>(answer.delay) - *exact)) / answer.time_error);
    }
    std::cout << "radius " << radius << " m: " << contacts
              << " contacts, largest error over its bound " << worst << "\n";
    EXPECT_GT(contacts, 1000);
    EXPECT_LT(worst, 1);
    EXPECT_GT(worst, 1e-4);  // a bound far above the errors would escalate what double can decide
  }
}

/// Contacts whose times are poorly determined in the scalar are timed in the next one.
TEST(PairSearch, AGrazingContactIsTimedByAWiderScalar) {
  auto mill = testing::spex_mill<double>();
  mill.gravity = Vec3<double>::Zero();
  DecisionLadder<double> ladder(mill, 0.004, 10.0);
  const Instant<double> now{0, 0.0};
  const double offset = 0.004 * (1 - 1e-13);  // passes by 4e-16 m less than the sum of the radii
  const Flight<double> i{{-0.01, offset, 0}, {1e-3, 0, 0}, now}, j{{0, 0, 0}, {0, 0, 0}, now};
  const auto answer = ladder.pair(i, j, now, 0.004);
  ASSERT_EQ(answer.verdict, Verdict::contact);
  EXPECT_EQ(ladder.escalations()[0].pair, 1u);
  const auto exact = exact_delay(i, j, now, 0.004, mill);
  EXPECT_LE(static_cast<double>(abs(mpfr_of<200>(answer.delay) - *exact)), answer.time_error);
  EXPECT_LE(4 * answer.time_error, ladder.tie_window());
}

}  // namespace
}  // namespace edmill::dynamics
