// Sine and cosine of an angle that has grown a little, without sines, which are expensive in wide scalars.
#pragma once

#include <cmath>
#include <type_traits>

#include "base/scalar.hpp"

namespace edmill::numerics {

/// Turns [rad] up to which what double rounds off the cubic term, d^3 2^-53 / 6, and the quintic term,
/// d^5 / 120, are below the rounding of 1 in a scalar of so many binary digits.
constexpr double longest_turn(int digits) {
  if (digits <= 113) return 0x1p-24;
  double turn = 1;
  for (int k = 0; k < (digits - 53) / 3; ++k) turn /= 2;
  return turn;
}
/// Whether speed times dt, which is x in double, is such a turn.
template <class Real>
bool is_short_turn(const Real& speed, const Real& dt, double x) {
  if constexpr (std::is_same_v<Hint<Real>, double>) {
    constexpr double longest = longest_turn(binary_digits<Real>());
    return x <= longest && x >= -longest;
  } else {
    if (double_hints<Real>()) return std::abs(x) <= longest_turn(binary_digits<Real>());
    // Double may have no number so small: the cubic term itself is below the rounding.
    const Real turn = speed * dt;
    return dt == 0 || exponent_of(turn) < -binary_digits<Real>() / 3 - 1;
  }
}

/// sin and cos of an angle that has grown by `more`. In the Taylor polynomials the last terms are far below
/// the first ones and so left to double.
template <class Real>
void turn(Real& sine, Real& cosine, const Real& more) {
  const double d = static_cast<double>(more);
  const Real rise = more - Real(d * d * d / 6);                  // sin
  const Real rest = more * more / 2 - Real(d * d * d * d / 24);  // 1 - cos
  const Real turned = sine + (cosine * rise - sine * rest);
  cosine -= sine * rise + cosine * rest;
  sine = turned;
}

}  // namespace edmill::numerics
