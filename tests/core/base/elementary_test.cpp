// Functions of our own in double and float128, against MPFR.
#include "base/elementary.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "casefile/random.hpp"
#include "core.hpp"

namespace edmill {
namespace {

/// Distance in units of the last place of `found`.
template <class Real> double ulps(const Real& found, const mpfr_of<100>& exact) {
  const mpfr_of<100> unit =
      ldexp(abs(exact), -std::numeric_limits<Real>::digits);  // half to a whole unit
  return std::abs(static_cast<double>((mpfr_of<100>(found) - exact) / unit));
}

template <class Real> void angles_are_right(std::uint64_t seed) {
  casefile::Random random(seed);
  double worst = 0;
  for (int k = 0; k < 20000; ++k) {
    const double scale = std::pow(10, 20 * random.symmetric<double>());
    const Real across = scale * random.uniform<Real>(), along = random.symmetric<Real>();
    worst = std::max(worst,
        ulps<Real>(numerics::angle_between<Real>(across, along),
            atan2(mpfr_of<100>(across), mpfr_of<100>(along))));
  }
  EXPECT_LT(worst, 4) << "seed " << seed;
  EXPECT_EQ(numerics::angle_between<Real>(0, 1), 0);
  EXPECT_EQ(numerics::angle_between<Real>(0, -1), numerics::pi<Real>());
  EXPECT_EQ(numerics::angle_between<Real>(1, 0), numerics::pi<Real>() / 2);
}

TEST(Elementary, AnglesAreWithinFourUnitsOfTheLastPlace) {
  angles_are_right<double>(1);
  angles_are_right<float128>(2);
}

template <class Real> void logarithms_are_right(std::uint64_t seed) {
  casefile::Random random(seed);
  double worst = 0;
  for (int k = 0; k < 20000; ++k) {
    const Real x = std::pow(10, 20 * random.symmetric<double>()) * random.uniform<Real>();
    if (x == 0) continue;
    worst = std::max(worst, ulps<Real>(numerics::log_of_one_plus<Real>(x), log1p(mpfr_of<100>(x))));
  }
  EXPECT_LT(worst, 4) << "seed " << seed;
  EXPECT_EQ(numerics::log_of_one_plus<Real>(0), 0);
}

TEST(Elementary, LogarithmsAreWithinFourUnitsOfTheLastPlace) {
  logarithms_are_right<double>(3);
  logarithms_are_right<float128>(4);
}

/// Of numbers of all sizes, among them neighbours of squares, whose roots are nearly halfway
/// between two numbers.
TEST(Elementary, RootsInFloat128AreTheNearestNumbers) {
  casefile::Random random(5);
  using Exact = mpfr_of<80>;
  for (int k = 0; k < 100000; ++k) {
    const int exponent = static_cast<int>(4000 * random.symmetric<double>());
    float128 x = 1 + random.uniform<float128>();
    if (k % 3 == 1) {
      const float128 root =
          k % 2 ? 1 + float128(random.uniform<double>()) : 2 - ldexp(float128(k % 1000), -112);
      x = root * root;
      if (k % 5 == 0) x -= ldexp(float128(1), k % 2 ? -112 : -111);
      if (k % 5 == 1) x += ldexp(float128(1), -111);
    }
    x = ldexp(x, exponent);
    const Exact root = sqrt(Exact(x));
    const float128 found = sqrt(x);
    const Exact half = ldexp(Exact(1), ilogb(found) - 113);
    ASSERT_LE(abs(Exact(found) - root), half) << k;
  }
  EXPECT_EQ(sqrt(float128(0)), 0);
  EXPECT_TRUE(isnan(sqrt(float128(-1))));
  EXPECT_EQ(
      sqrt(std::numeric_limits<float128>::infinity()), std::numeric_limits<float128>::infinity());
}

}  // namespace
}  // namespace edmill
