// Exact numbers n 2^e, which contain all sums and products of floating-point numbers.
#pragma once

#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>

#include "base/errors.hpp"
#include "base/scalar.hpp"

namespace edmill {

/// An integer times a power of two. Sums, differences, products and signs are exact.
class Dyadic {
 public:
  Dyadic() = default;
  Dyadic(int whole) : n_(whole) {}  // NOLINT(google-explicit-constructor): exact
  Dyadic(boost::multiprecision::cpp_int n, int e) : n_(std::move(n)), e_(n_ == 0 ? 0 : e) {}
  /// @throws ContractError when x is not finite
  template <class Real> static Dyadic of(const Real& x) {
    using std::floor;
    using std::frexp;
    using std::isfinite;
    using std::ldexp;
    EDMILL_REQUIRE(isfinite(x), "a finite number");
    constexpr int bits = 30;
    [[maybe_unused]] const auto scope = with_all_digits_of(x);
    Dyadic exact;
    int exponent = 0;
    Real rest = frexp(x, &exponent);
    for (; rest != 0; exponent -= bits) {
      rest = ldexp(rest, bits);
      const Real whole = floor(rest);
      rest -= whole;
      exact.n_ = (exact.n_ << bits) + static_cast<int>(static_cast<double>(whole));
    }
    exact.e_ = exact.n_ == 0 ? 0 : exponent;
    return exact;
  }
  /// Exact where n has no more bits than the scalar, otherwise to a few units of the last place.
  template <class Real> Real to() const {
    using std::ldexp;
    constexpr unsigned bits = 30;
    Integer size = abs(n_);
    int exponent = e_;
    if (size == 0) return Real(0);
    const int spare = static_cast<int>(msb(size)) - (binary_digits<Real>() + 2);
    if (spare > 0) {
      size >>= spare;
      exponent += spare;
    }
    Real sum(0);
    for (int piece = static_cast<int>(msb(size)) / static_cast<int>(bits); piece >= 0; --piece) {
      const Integer part = (size >> (static_cast<unsigned>(piece) * bits)) & ((1 << bits) - 1);
      sum = sum * Real(1 << bits) + Real(static_cast<int>(part));
    }
    return ldexp(n_ < 0 ? Real(-sum) : sum, exponent);
  }

  int sign() const { return n_.sign(); }
  friend Dyadic operator+(const Dyadic& a, const Dyadic& b) {
    if (a.e_ > b.e_) return b + a;
    return Dyadic(a.n_ + (b.n_ << static_cast<unsigned>(b.e_ - a.e_)), a.e_);
  }
  friend Dyadic operator-(const Dyadic& a) { return Dyadic(-a.n_, a.e_); }
  friend Dyadic operator-(const Dyadic& a, const Dyadic& b) { return a + -b; }
  friend Dyadic operator*(const Dyadic& a, const Dyadic& b) {
    return Dyadic(a.n_ * b.n_, a.e_ + b.e_);
  }
  Dyadic half() const { return Dyadic(n_, e_ - 1); }
 private:
  using Integer = boost::multiprecision::cpp_int;
  Integer n_ = 0;
  int e_ = 0;
};

/// Sign of x + s sqrt(square), s = -1, 0 or 1.
inline int sign_of_sum(const Dyadic& x, int s, const Dyadic& square) {
  const int root = square.sign() == 0 ? 0 : s, own = x.sign();
  if (own * root >= 0) return own + root > 0 ? 1 : own + root < 0 ? -1 : 0;
  return own * (x * x - square).sign();
}

/// Sign of x + s sqrt(one) + t sqrt(two).
inline int sign_of_sum(const Dyadic& x, int s, const Dyadic& one, int t, const Dyadic& two) {
  const int first = sign_of_sum(x, s, one), second = two.sign() == 0 ? 0 : t;
  if (first * second >= 0) return first + second > 0 ? 1 : first + second < 0 ? -1 : 0;
  // The signs are opposite: compare the squares.
  const Dyadic rational = x * x + one - two, four_squares = Dyadic(4) * x * x * one;
  return first * sign_of_sum(rational, s * x.sign(), four_squares);
}

}  // namespace edmill
