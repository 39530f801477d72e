// The second arithmetic of the checker of certificates against Arb: each of its enclosures holds
// what Arb encloses with many more bits, and is about as narrow.
#include "../../../verification/checker/integer_balls.hpp"

#include <arb.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <random>
#include <string>

namespace checker {
namespace {

constexpr slong wide = 2000;

class Arb {
 public:
  Arb() { arb_init(value); }
  explicit Arb(const Real& a) {
    arb_init(value);
    std::ostringstream words;
    words << std::hex;
    for (const Dyadic* d : {&a.midpoint, &a.radius}) {
      const Exponent e = d->m == 0 ? 0 : d->e;
      words << (d->m < 0 ? "-" : "") << size_of(*d).m << (e < 0 ? " -" : " ") << std::abs(e) << " ";
    }
    EXPECT_EQ(arb_load_str(value, words.str().c_str()), 0) << words.str();
  }
  Arb(const Arb&) = delete;
  Arb& operator=(const Arb&) = delete;
  ~Arb() { arb_clear(value); }
  arb_t value;
};

/// An enclosure of some 100 bits, of all sizes; exact ones, narrow and wide ones, and zero.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}
  Real operator()() {
    if (below(20) == 0) return Real(static_cast<long>(below(7)) - 3);
    Integer m = (Integer(random_()) << 64) + random_();
    if (below(2) == 0) m = -m;
    const Exponent e = -128 + static_cast<Exponent>(below(20)) - 10;
    const Dyadic spread{below(1u << 30), e + static_cast<Exponent>(below(110)) - 20};
    return Real::exact({m, e}, below(3) == 0 ? Dyadic{} : spread);
  }
  std::uint64_t below(std::uint64_t n) { return random_() % n; }
 private:
  std::mt19937_64 random_;
};

/// Whether a result holds what Arb finds, with many bits, for the ends and the midpoints of the
/// operands; and is not much wider than Arb's for all of them.
template <class Function>
void expect_holds(
    const Real& result, const Real& a, const Real& b, const char* what, const Function& of_arb) {
  if (result.unbounded) return;
  const Arb ours(result);
  for (const Dyadic& x : {a.lower(), a.midpoint, a.upper()})
    for (const Dyadic& y : {b.lower(), b.midpoint, b.upper()}) {
      const Arb one(Real::exact(x)), other(Real::exact(y));
      Arb truth;
      of_arb(truth.value, one.value, other.value, wide);
      ASSERT_TRUE(!arb_is_finite(truth.value) || arb_overlaps(ours.value, truth.value)) << what;
    }
  const Arb all(a), of_all(b);
  Arb peer;
  of_arb(peer.value, all.value, of_all.value, precision);
  if (!arb_is_finite(peer.value)) return;
  // 2^10 times the radius of Arb's, and a few units of the last place of the midpoint or of one.
  const double ratio = std::exp2(10), last = std::exp2(10 - static_cast<double>(precision));
  const auto radius_of = [](const Arb& x) { return mag_get_d(arb_radref(x.value)); };
  EXPECT_LE(radius_of(ours),
      ratio * radius_of(peer) +
          last * (1 + std::abs(arf_get_d(arb_midref(peer.value), ARF_RND_NEAR))))
      << what;
}

TEST(IntegerBalls, HoldWhatArbEncloses) {
  std::cout << "seed 20261127\n";
  Draw draw(20261127);
  for (const long bits : {64L, 128L, 320L}) {
    const WithPrecision scope(bits);
    for (int k = 0; k < 1000; ++k) {
      const Real a = draw(), b = draw();
      expect_holds(a + b, a, b, "+", arb_add);
      expect_holds(a - b, a, b, "-", arb_sub);
      expect_holds(a * b, a, b, "*", arb_mul);
      expect_holds(a / b, a, b, "/", arb_div);
      const auto of_one = [](auto function) {
        return [=](arb_t r, const arb_t x, const arb_t, slong p) { function(r, x, p); };
      };
      expect_holds(square_root(a), a, b, "square root", of_one(arb_sqrtpos));
      const auto [sine, cosine] = sine_and_cosine_of_pi(a);
      expect_holds(sine, a, b, "sine", of_one(arb_sin_pi));
      expect_holds(cosine, a, b, "cosine", of_one(arb_cos_pi));
      expect_holds(
          pi(), a, b, "pi", [](arb_t r, const arb_t, const arb_t, slong p) { arb_const_pi(r, p); });
      const Real both = interval(a, b);
      EXPECT_TRUE(contains(both, a) && contains(both, b));
      const Real less = Real::exact(both.midpoint, both.radius * Dyadic{4095, -12});
      EXPECT_TRUE(both.radius.m == 0 || !contains(less, a) || !contains(less, b));
      const Arb x(a), y(b);
      EXPECT_EQ(a < b, arb_lt(x.value, y.value) != 0);
      EXPECT_EQ(a >= b, arb_ge(x.value, y.value) != 0);
      EXPECT_EQ(contains(a, b), arb_contains(x.value, y.value) != 0);
      EXPECT_EQ(a.positive(), arb_is_positive(x.value) != 0);
      EXPECT_EQ(a.negative(), arb_is_negative(x.value) != 0);
      EXPECT_EQ(a.zero(), arb_is_zero(x.value) != 0);
      if (HasFailure()) return;
    }
  }
}

TEST(IntegerBalls, FractionsAreReadAsTheyAreWritten) {
  const WithPrecision scope(100);
  const auto third = fraction("1/3");
  ASSERT_TRUE(third);
  EXPECT_TRUE(contains(*third * 3, 1));
  EXPECT_FALSE(third->radius.m == 0);
  EXPECT_TRUE((*fraction("-0012") + 12).zero());
  EXPECT_TRUE((*fraction("10/5") - 2).zero() || contains(*fraction("10/5"), 2));
  for (const char* text : {"", "-", "1/0", "1/", "/2", "1.5", "0x10", "--1", "1/2/3"})
    EXPECT_FALSE(fraction(text)) << text;
}

TEST(IntegerBalls, WhatIsNotDefinedIsUnbounded) {
  EXPECT_TRUE((Real(1) / 0).unbounded);
  EXPECT_TRUE(square_root(-1).unbounded);
  const Real any = Real::any();
  EXPECT_FALSE(any < 1 || any >= 1 || any.positive() || any.negative() || any.zero());
  EXPECT_TRUE((any * 0 + 1).unbounded);
  EXPECT_TRUE(contains(sine_and_cosine_of_pi(any).first, Real(1)));
}

}  // namespace
}  // namespace checker
