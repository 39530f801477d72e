// Arctangent, logarithm and roots with the same bits on every machine, unlike those of C libraries.
#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "base/trigonometry.hpp"

namespace edmill::numerics {

namespace detail {

/// Scalars whose library functions round correctly, so that all libraries agree.
template <class Real>
inline constexpr bool rounds_correctly = (std::numeric_limits<Real>::digits == 0 ||
    std::numeric_limits<Real>::digits > 113);

/// x -+ x^3/3 + x^5/5 -+ ...: the arctangent, or with `sign` -1 artanh. @pre |x| <= 0.18
template <class Real> Real odd_series(const Real& x, int sign) {
  // Each term has 5 bits more than the one before.
  constexpr int terms = std::numeric_limits<Real>::digits / 5 + 2;
  static const auto inverse = [] {
    std::array<Real, terms> odd;
    for (int k = 0; k < terms; ++k) odd[static_cast<std::size_t>(k)] = Real(1) / (2 * k + 1);
    return odd;
  }();
  const Real square = sign > 0 ? Real(-x * x) : Real(x * x);
  Real sum = inverse[terms - 1];
  for (std::size_t k = terms - 2; k > 0; --k) sum = inverse[k] + square * sum;
  return x + x * (square * sum);
}

/// @pre 0 <= t <= 1
template <class Real> Real arctangent(const Real& t) {
  // atan(t) = atan(c) + atan((t - c) / (1 + t c)) with c = 1/4, 1/2, 3/4 or 1; atan(c) likewise.
  const int quarters = static_cast<int>(4 * static_cast<double>(t) + 0.5);
  if (quarters == 0) return odd_series<Real>(t, 1);
  static const auto angles = [] {
    const auto of = [](int above, int below) { return odd_series<Real>(Real(above) / below, 1); };
    std::array<Real, 5> a{};
    a[1] = of(1, 8) + of(4, 33);
    a[2] = a[1] + of(1, 9) + of(9, 83);
    a[3] = a[2] + of(1, 11) + of(11, 123);
    a[4] = pi<Real>() / 4;
    return a;
  }();
  const Real c = Real(quarters) / 4;
  return angles[static_cast<std::size_t>(quarters)] + odd_series<Real>((t - c) / (1 + t * c), 1);
}

}  // namespace detail

/// atan2(across, along), from 0 to pi for across >= 0. Error: a few units of the last place.
/// @pre across >= 0, not both 0
template <class Real> Real angle_between(const Real& across, const Real& along) {
  if constexpr (detail::rounds_correctly<Real>) {
    return Real(atan2(across, along));
  } else {
    const Real size = magnitude(along);
    const Real first = across <= size
        ? detail::arctangent<Real>(across / size)
        : Real(pi<Real>() / 2 - detail::arctangent<Real>(size / across));
    return along < 0 ? Real(pi<Real>() - first) : first;
  }
}

/// ln(1 + x). Error: a few units of the last place. @pre x >= 0
template <class Real> Real log_of_one_plus(const Real& x) {
  if constexpr (detail::rounds_correctly<Real>) {
    return Real(log1p(x));
  } else {
    if (x < 0.25) return 2 * detail::odd_series<Real>(x / (2 + x), -1);
    // ln(1 + x) = e ln 2 + 2 artanh((m - 1)/(m + 1)), 1 + x = m 2^e; m from 1/sqrt(2) on
    using std::frexp;
    int exponent;
    Real m = frexp(Real(1 + x), &exponent);
    if (m < 0.70710678) {
      m *= 2;
      --exponent;
    }
    using detail::odd_series;
    static const Real ln2 =
        2 * (2 * odd_series<Real>(Real(1) / 7, -1) + odd_series<Real>(Real(1) / 17, -1));
    return exponent * ln2 + 2 * odd_series<Real>((m - 1) / (m + 1), -1);
  }
}

/// x^(1/5) to a few roundings, by arithmetic alone. @pre x >= 0
template <class Real> Real fifth_root(const Real& x) {
  using std::frexp;
  using std::ldexp;
  if (!(x > 0)) return Real(0);
  int exponent;
  Real m = frexp(x, &exponent);
  const int whole = (exponent - (exponent % 5 + 5) % 5) / 5;
  m = ldexp(m, exponent - 5 * whole);  // in [1/2, 16)
  // From the tangent of the root at 1, which is above it, Newton's iterates fall until rounding.
  for (Real y = (m + 4) / 5;;) {
    const Real square = y * y, next = (4 * y + m / (square * square)) / 5;
    if (!(next < y)) return ldexp(y, whole);
    y = next;
  }
}

}  // namespace edmill::numerics
