// The certificates of base/hermite.hpp against functions whose sign is known in closed form.
#include "base/hermite.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "casefile/random.hpp"

namespace edmill::numerics {
namespace {

/// f(t) = c0 + c1 t + c2 t^2 / 2 + a sin(w t): derivatives known and bounded.
struct Wave {
  double c0, c1, c2, a, w;
  double value(double t) const { return c0 + t * (c1 + t * c2 / 2) + a * std::sin(w * t); }
  double slope(double t) const { return c1 + t * c2 + a * w * std::cos(w * t); }
  Point<double> at(double t) const { return {t, value(t), slope(t)}; }
  CurveBounds<double> bounds() const {
    const double s = std::abs(a);
    return {std::abs(c2) + s * w * w, s * w * w * w, s * w * w * w * w, 1e-14, 1e-13, 1e-12};
  }
  /// Least value on a fine grid of [l, r], a lower estimate by the second derivative's bound.
  double least(double l, double r) const {
    double least = value(l);
    for (int k = 0; k <= 400; ++k) least = std::min(least, value(l + (r - l) * k / 400));
    return least;
  }
};

Wave draw(casefile::Random& random) {
  const auto s = [&] { return random.symmetric<double>(); };
  return {s(), 3 * s(), 6 * s(), s(), 6 * random.uniform<double>()};
}

TEST(Hermite, PositiveIsProvenOnlyWherePositive) {
  casefile::Random random(31);
  int proven = 0, positive = 0;
  for (int k = 0; k < 20000; ++k) {
    const Wave f = draw(random);
    const double r = 0.02 + 0.6 * random.uniform<double>();
    if (f.value(0) < 1e-6) continue;
    const bool is_positive = f.least(0, r) > 0;
    positive += is_positive;
    if (!proven_positive(f.at(0), f.at(r), f.bounds())) continue;
    ++proven;
    ASSERT_TRUE(is_positive);
  }
  EXPECT_GT(proven, positive * 3 / 4);  // and it is rarely much too small
}

TEST(Hermite, MonotonyIsProvenOnlyWhereMonotone) {
  casefile::Random random(32);
  int falling = 0, rising = 0;
  for (int k = 0; k < 20000; ++k) {
    const Wave f = draw(random);
    const double r = 0.02 + 0.6 * random.uniform<double>();
    const bool falls = proven_decreasing(f.at(0), f.at(r), f.bounds());
    const bool rises = proven_increasing(f.at(0), f.at(r), f.bounds());
    falling += falls;
    rising += rises;
    for (int n = 0; n <= 100 && (falls || rises); ++n)
      ASSERT_TRUE((f.slope(r * n / 100) < 0) == falls);
  }
  EXPECT_GT(falling, 2000);
  EXPECT_GT(rising, 2000);
}

TEST(Hermite, DepartureIsProvenOnlyWithoutReturn) {
  casefile::Random random(33);
  int proven = 0;
  for (int k = 0; k < 20000; ++k) {
    Wave f = draw(random);
    f.c0 = 0;
    const double r = 0.02 + 0.6 * random.uniform<double>();
    if (!can_depart(f.at(0), f.bounds()) || !proven_departure(f.at(0), f.at(r), f.bounds()))
      continue;
    ++proven;
    for (int n = 1; n <= 400; ++n) ASSERT_GT(f.value(r * n / 400), 0);
  }
  EXPECT_GT(proven, 2000);
}

TEST(Hermite, RootHintsAreNearTheRoot) {
  const Wave f{1, -1, -4, 0.05, 6};
  const auto left = f.at(0.1), right = f.at(1.0);
  ASSERT_GT(left.value, 0);
  ASSERT_LT(right.value, 0);
  double low = 0.1, high = 1;
  while (high - low > 1e-15) (f.value((low + high) / 2) > 0 ? low : high) = (low + high) / 2;
  EXPECT_NEAR(0.1 + 0.9 * last_root_hint(left, right), low, 0.02);
  // The inverse function must be smooth between the points: a short bracket, error of order h^4 =
  // 1e-4.
  EXPECT_NEAR(inverse_cubic_hint(f.at(low - 0.04), f.at(low + 0.06)), low, 1e-4);
}

}  // namespace
}  // namespace edmill::numerics
