// sin and cos against MPFR's in 80 digits.
#include "base/trigonometry.hpp"

#include <gtest/gtest.h>

#include "casefile/random.hpp"
#include "core.hpp"

namespace edmill::numerics {
namespace {

using Exact = mpfr_of<80>;

TEST(Trigonometry, DoubleIsWithinTwoUlpOfOneForAnglesOfAMill) {
  casefile::Random random(7);
  double worst = 0;
  for (int k = 0; k < 200000; ++k) {
    const double x = 1.6 * random.symmetric<double>();
    const auto found = sin_cos<double>(x);
    const auto exact = sin_cos<Exact>(Exact(x));
    worst = std::max({worst, std::abs(static_cast<double>(Exact(found.sin) - exact.sin)),
        std::abs(static_cast<double>(Exact(found.cos) - exact.cos))});
  }
  EXPECT_LT(worst, 2 * 1.1102230246251565e-16);
}

TEST(Trigonometry, TurnsInDoubleAreWithinFourUlpOfOne) {
  casefile::Random random(8);
  double worst = 0;
  for (int k = 0; k < 200000; ++k) {
    const double turns = 1.25 * random.uniform<double>();
    const auto found = sin_cos_turns<double>(turns);
    const auto exact = sin_cos<Exact>(2 * pi<Exact>() * Exact(turns));
    worst = std::max({worst, std::abs(static_cast<double>(Exact(found.sin) - exact.sin)),
        std::abs(static_cast<double>(Exact(found.cos) - exact.cos))});
  }
  EXPECT_LT(worst, 4 * 1.1102230246251565e-16);
}

TEST(Trigonometry, TurnsAreExactAtQuarters) {
  for (int quarter = 0; quarter < 8; ++quarter) {
    const auto v = sin_cos_turns<double>(quarter / 4.0);
    const double sines[] = {0, 1, 0, -1}, cosines[] = {1, 0, -1, 0};
    EXPECT_EQ(v.sin, sines[quarter % 4]);
    EXPECT_EQ(v.cos, cosines[quarter % 4]);
  }
}

template <class Real> void expect_two_ulp_of_one() {
  casefile::Random random(10);
  Exact worst = 0;
  for (int k = 0; k < 20000; ++k) {
    const Real x = (k % 2 ? 0.8 : 20) * random.symmetric<Real>();
    const auto found = sin_cos<Real>(x);
    const auto exact = sin_cos<Exact>(Exact(x));
    worst = std::max({worst, Exact(abs(Exact(found.sin) - exact.sin)),
        Exact(abs(Exact(found.cos) - exact.cos))});
  }
  EXPECT_LT(worst, 2 * Exact(std::numeric_limits<Real>::epsilon()));
  EXPECT_EQ(pi<Real>(), static_cast<Real>(pi<Exact>()));
}

TEST(Trigonometry, Float128IsWithinTwoUlpOfOne) { expect_two_ulp_of_one<float128>(); }
TEST(Trigonometry, TheLaddersTopIsWithinTwoUlpOfOne) { expect_two_ulp_of_one<mpfr50>(); }

}  // namespace
}  // namespace edmill::numerics
