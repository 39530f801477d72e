// The scalar whose digits are chosen at run time, against Boost's number of as many digits.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "base/scalar_list.hpp"
#include "base/scalar_text.hpp"
#include "base/wide_trigonometry.hpp"

namespace edmill {
namespace {

using Boosts = mpfr_of<100>;

double number() {
  return (*rc::gen::arbitrary<int>()) * 1.0 / (1 + std::abs(*rc::gen::arbitrary<int>() % 1000));
}

RC_GTEST_PROP(ChosenDigits, RoundAsTheScalarOfAsManyDigits, ()) {
  const mpfr::Digits digits(100);
  const double x = number(), y = number();
  const mpfr a = sqrt(abs(mpfr(x)) + 1) / 3, b = mpfr(y) / 7;
  const Boosts c = sqrt(abs(Boosts(x)) + 1) / 3, d = Boosts(y) / 7;
  const auto same = [](const mpfr& one, const Boosts& other) { return one == mpfr(other); };
  RC_ASSERT(same(a, c) && same(b, d));
  RC_ASSERT(same(a + b, c + d) && same(a - b, c - d) && same(a * b, c * d));
  if (b != 0) RC_ASSERT(same(a / b, c / d));
  RC_ASSERT(same(exp(-a), Boosts(exp(Boosts(-c)))) && same(log1p(a), Boosts(log1p(c))));
  RC_ASSERT(same(atan2(b, a), Boosts(atan2(d, c))) && same(floor(b), Boosts(floor(d))));
  const auto one = numerics::sin_cos<mpfr>(b);
  const auto other = numerics::sin_cos<Boosts>(d);
  RC_ASSERT(same(one.sin, other.sin) && same(one.cos, other.cos));
  RC_ASSERT((a < b) == (c < d) && (a == b) == (c == d) && (a >= b) == (c >= d));
  mpfr sum = a;
  sum += b, sum *= a, sum -= b, sum /= 3;
  Boosts sum_of_boost = c;
  sum_of_boost += d, sum_of_boost *= c, sum_of_boost -= d, sum_of_boost /= 3;
  RC_ASSERT(same(sum, sum_of_boost));
}

RC_GTEST_PROP(ChosenDigits, KeepEveryBitOfNarrowerNumbers, ()) {
  const double x = number();
  const float128 wide = float128(x) / 3;
  RC_ASSERT(static_cast<double>(mpfr(x)) == x);
  const mpfr::Digits digits(40);
  RC_ASSERT(mpfr(wide) - mpfr(Boosts(wide)) == 0);
  RC_ASSERT(from_text<mpfr>(to_text<mpfr>(mpfr(x) / 3)) == mpfr(x) / 3);
}

TEST(ChosenDigits, HoldWithinTheirScope) {
  const unsigned before = mpfr::digits();
  mpfr third;
  {
    const mpfr::Digits digits(500);
    third = mpfr(1) / 3;
    EXPECT_EQ(mpfr::digits(), 500u);
    EXPECT_EQ(to_text<mpfr>(third).size(), 504u);  // "0." and 502 digits
    const mpfr::Digits fewer(30, 8);
    EXPECT_EQ(to_text<mpfr>(mpfr(1) / 3), "0.33333333");
  }
  EXPECT_EQ(mpfr::digits(), before);
  const mpfr copy = third;
  EXPECT_EQ(copy, third);  // with all its bits
  EXPECT_LT(abs(copy * 3 - 1), mpfr(1e-40));
  EXPECT_LT(
      mpfr_get_prec((copy * 3).data()), mpfr_get_prec(copy.data()));  // a result has the thread's
}

TEST(ChosenDigits, ComparesNoNumberWithNothing) {
  const mpfr none = std::numeric_limits<mpfr>::quiet_NaN();
  EXPECT_FALSE(none < 0 || none > 0 || none == 0 || none <= 0 || none >= 0);
  EXPECT_TRUE(none != 0);
  EXPECT_TRUE(isnan(none) && !isfinite(std::numeric_limits<mpfr>::infinity()));
}

TEST(ChosenDigits, AreSavedWithAllBits) {
  const mpfr::Digits digits(777);
  mpfr value = sqrt(mpfr(2)), loaded;
  Archive saved;
  saved(value);
  const std::string bytes = saved.bytes();
  {
    const mpfr::Digits fewer(30);
    Archive again(bytes);
    again(loaded);
  }
  EXPECT_EQ(loaded, value);
  EXPECT_EQ(mpfr_get_prec(loaded.data()), mpfr_get_prec(value.data()));
}

TEST(ChosenDigits, AreTakenFromNames) {
  EXPECT_EQ(chosen_digits_of("mpfr:3000"), 3000u);
  EXPECT_EQ(chosen_digits_of("mpfr50"), 50u);
  for (const char* name :
      {"mpfr", "mpfr:", "mpfr:19", "mpfr:1000001", "mpfr:5e3", "mpfr:-30", "mpfr51", ":30"})
    EXPECT_EQ(chosen_digits_of(name), 0u) << name;
}

}  // namespace
}  // namespace edmill
