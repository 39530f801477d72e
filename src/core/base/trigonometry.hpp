// Sine and cosine without the C library in double, so that every machine gives the same bits.
#pragma once

#include <cmath>
#include <type_traits>

#include "base/scalar.hpp"

namespace edmill::numerics {

template <class Real> struct SinCos {
  Real sin;
  Real cos;
};

/// Customisation point of a scalar: `pi()` and `sin_cos(angle)`. base/wide_trigonometry.hpp
template <class Real> struct Trigonometry;

template <class Real> Real pi() { return Trigonometry<Real>::pi(); }

template <> inline double pi<double>() { return 3.141592653589793; }

/// sin and cos of an angle [rad]. Error at most 2 ulp of 1.
template <class Real> SinCos<Real> sin_cos(const Real& angle) {
  return Trigonometry<Real>::sin_cos(angle);
}

namespace detail {

// Always inlined: the wall search of the SPEX evaluates these functions for every pose.

typedef double TwoDoubles __attribute__((vector_size(16)));

/// Taylor polynomials of sin and cos on [-pi/4, pi/4], side by side, in Estrin order: short chains.
[[gnu::always_inline]] inline SinCos<double> sin_cos_kernel(double x) {
  const double square = x * x;
  const TwoDoubles z = {square, square}, z2 = z * z, z4 = z2 * z2;
  const TwoDoubles sum = (TwoDoubles{-1.0 / 6, 1.0 / 24} + z * TwoDoubles{1.0 / 120, -1.0 / 720}) +
      z2 * (TwoDoubles{-1.0 / 5040, 1.0 / 40320} + z * TwoDoubles{1.0 / 362880, -1.0 / 3628800}) +
      z4 *
          ((TwoDoubles{-1.0 / 39916800, 1.0 / 479001600} +
               z * TwoDoubles{1.0 / 6227020800, -1.0 / 87178291200}) +
              z2 * TwoDoubles{-1.0 / 1307674368000, 1.0 / 20922789888000});
  return {x + x * (square * sum[0]), 1.0 - (0.5 * square - z2[1] * sum[1])};
}

/// Adds quarter turns to the angle, without branches: the phase of a drive can be in any quadrant.
[[gnu::always_inline]] inline SinCos<double> quarter_turned(const SinCos<double>& v, int quarters) {
  const double s = (quarters & 1) ? v.cos : v.sin;
  const double c = (quarters & 1) ? v.sin : v.cos;
  return {(quarters & 2) ? -s : s, ((quarters + 1) & 2) ? -c : c};
}

/// Nearest integer for |x| < 2^31 without the C library.
inline int nearest(double x) { return static_cast<int>(x < 0 ? x - 0.5 : x + 0.5); }

}  // namespace detail

/// Angles of a mill are below pi/4 or a few turns; larger ones lose accuracy in proportion.
template <> inline SinCos<double> sin_cos<double>(const double& angle) {
  constexpr double eighth_turn = 0.785398163397448;
  if (angle <= eighth_turn && angle >= -eighth_turn) return detail::sin_cos_kernel(angle);
  constexpr double half_pi_high = 1.5707963267948966, half_pi_low = 6.123233995736766e-17;
  const int quarters = detail::nearest(angle / half_pi_high);
  const double rest = (angle - quarters * half_pi_high) - quarters * half_pi_low;
  return detail::quarter_turned(detail::sin_cos_kernel(rest), quarters);
}

/// sin and cos of 2 pi `turns`, for |turns| below 2^20. Error at most 4 ulp of 1.
template <class Real> SinCos<Real> sin_cos_turns(const Real& turns) {
  const Real reduced = turns - Real(std::floor(static_cast<double>(turns) + 0.5));
  return sin_cos<Real>(2 * pi<Real>() * reduced);
}

template <> [[gnu::always_inline]] inline SinCos<double> sin_cos_turns(const double& turns) {
  const int quarters = detail::nearest(4 * turns);
  const double rest = turns - 0.25 * quarters;  // exact: multiples of the same power of two
  return detail::quarter_turned(detail::sin_cos_kernel(6.283185307179586 * rest), quarters);
}

// Updates of sine and cosine for a small increment, for sines of wide scalars are expensive.

/// Largest increment [rad] for which the rounding of the cubic term in double, d^3 2^-53 / 6, and
/// the quintic term, d^5 / 120, are below the rounding of 1 in a scalar of so many binary digits.
constexpr double longest_turn(int digits) {
  if (digits <= 113) return 0x1p-24;
  double turn = 1;
  for (int k = 0; k < (digits - 53) / 3; ++k) turn /= 2;
  return turn;
}
/// True if speed times dt, which is x in double, is such a small increment.
template <class Real> bool is_short_turn(const Real& speed, const Real& dt, double x) {
  if constexpr (std::is_same_v<Hint<Real>, double>) {
    constexpr double longest = longest_turn(binary_digits<Real>());
    return x <= longest && x >= -longest;
  } else {
    if (double_hints<Real>()) return std::abs(x) <= longest_turn(binary_digits<Real>());
    // The increment may underflow in double: even the cubic term must be below the rounding.
    const Real turn = speed * dt;
    return dt == 0 || exponent_of(turn) < -binary_digits<Real>() / 3 - 1;
  }
}

/// Updates sin and cos of an angle that increases by `more`, with the last Taylor terms in double.
template <class Real> void turn(Real& sine, Real& cosine, const Real& more) {
  const double d = static_cast<double>(more);
  const Real rise = more - Real(d * d * d / 6);                  // sin
  const Real rest = more * more / 2 - Real(d * d * d * d / 24);  // 1 - cos
  const Real turned = sine + (cosine * rise - sine * rest);
  cosine -= sine * rise + cosine * rest;
  sine = turned;
}

}  // namespace edmill::numerics
