// sin and cos in double against 50 digits.
#include "base/trigonometry.hpp"

#include <gtest/gtest.h>

#include "casefile/random.hpp"
#include "instances/instances.hpp"

namespace edmill::numerics {
namespace {

TEST(Trigonometry, DoubleIsWithinTwoUlpOfOneForAnglesOfAMill) {
  casefile::Random random(7);
  double worst = 0;
  for (int k = 0; k < 200000; ++k) {
    const double x = 1.6 * random.symmetric<double>();
    const auto found = sin_cos<double>(x);
    const auto exact = sin_cos<mpfr50>(mpfr50(x));
    worst = std::max({worst, std::abs(static_cast<double>(mpfr50(found.sin) - exact.sin)),
                      std::abs(static_cast<double>(mpfr50(found.cos) - exact.cos))});
  }
  EXPECT_LT(worst, 2 * 1.1102230246251565e-16);
}

TEST(Trigonometry, TurnsInDoubleAreWithinFourUlpOfOne) {
  casefile::Random random(8);
  double worst = 0;
  for (int k = 0; k < 200000; ++k) {
    const double turns = 1.25 * random.uniform<double>();
    const auto found = sin_cos_turns<double>(turns);
    const auto exact = sin_cos<mpfr50>(2 * pi<mpfr50>() * mpfr50(turns));
    worst = std::max({worst, std::abs(static_cast<double>(mpfr50(found.sin) - exact.sin)),
                      std::abs(static_cast<double>(mpfr50(found.cos) - exact.cos))});
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

TEST(Trigonometry, Float128IsWithinTwoUlpOfOne) {
  casefile::Random random(10);
  double worst = 0;
  for (int k = 0; k < 20000; ++k) {
    const float128 x = (k % 2 ? 0.8 : 20) * random.symmetric<float128>();
    const auto found = sin_cos<float128>(x);
    const auto exact = sin_cos<mpfr50>(mpfr50(x));
    worst = std::max({worst, std::abs(static_cast<double>(mpfr50(found.sin) - exact.sin)),
                      std::abs(static_cast<double>(mpfr50(found.cos) - exact.cos))});
  }
  EXPECT_LT(worst, 2 * 0x1p-112);
  EXPECT_EQ(pi<float128>(), static_cast<float128>(pi<mpfr50>()));
}

TEST(Trigonometry, WideScalarsAgreeWithEachOther) {
  casefile::Random random(9);
  for (int k = 0; k < 1000; ++k) {
    const float128 x = random.symmetric<float128>();
    const auto narrow = sin_cos_turns<float128>(x);
    const auto wide = sin_cos_turns<mpfr50>(mpfr50(x));
    EXPECT_LT(abs(mpfr50(narrow.sin) - wide.sin), mpfr50("2e-33"));
    EXPECT_LT(abs(mpfr50(narrow.cos) - wide.cos), mpfr50("2e-33"));
  }
}

}  // namespace
}  // namespace edmill::numerics
