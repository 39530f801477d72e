// Certified statements about a smooth function: on an interval, from values and slopes at both
// ends, or after a point, from its value and first two derivatives there.
#pragma once

#include <cmath>

#include "base/scalar.hpp"

namespace edmill::numerics {

template <class Real> struct Point {
  Real t;  ///< abscissa
  Real value;
  Real slope;
};

/// Bounds on a function's derivatives over the interval, and on the rounding of its samples.
template <class Real> struct CurveBounds {
  Real second, third, fourth;  ///< sup |f''|, sup |f'''|, sup |f''''|
  Real value_error, slope_error, curvature_error;
};

/// Bernstein coefficients b_1..b_4 of a quartic lower bound of f on [left, right]; b_0 is the left
/// value. The cubic Hermite interpolant errs by f''''(xi)/24 tau^2 (s-tau)^2: in degree four this
/// lowers the middle coefficient alone, by sup|f''''| s^4 / 144. No value is below all of them
/// (theory.md, 3).
template <class Real> struct QuarticLowerBound {
  Real b1, b2, b3, b4;
  Real slack;  ///< bound on the rounding error of any coefficient

  QuarticLowerBound(
      const Point<Real>& left, const Point<Real>& right, const CurveBounds<Real>& bounds) {
    const Real s = right.t - left.t, s2 = s * s;
    const Real left_slope = left.slope * s, right_slope = right.slope * s;
    b1 = left.value + left_slope / 4;
    b2 = (left.value + right.value) / 2 + (left_slope - right_slope) / 6 -
        bounds.fourth * (s2 * s2) / 144;
    b3 = right.value - right_slope / 4;
    b4 = right.value;
    const Real size = magnitude(left.value) + magnitude(right.value) + magnitude(left_slope) +
        magnitude(right_slope);
    slack = bounds.value_error + s * bounds.slope_error + 8 * epsilon<Real>() * size;
  }

  Real least() const {
    Real least = b1 < b2 ? b1 : b2;
    if (b3 < least) least = b3;
    return b4 < least ? b4 : least;
  }
};

/// Proven: f > 0 on [left, right]. @pre left.value is proven positive
template <class Real>
[[gnu::always_inline]] inline bool proven_positive(
    const Point<Real>& left, const Point<Real>& right, const CurveBounds<Real>& bounds) {
  const QuarticLowerBound<Real> quartic(left, right, bounds);
  return quartic.least() > quartic.slack;
}

/// True if f, zero within rounding at the start, rises fast enough to prove its departure.
template <class Real> bool can_depart(const Point<Real>& left, const CurveBounds<Real>& bounds) {
  return left.slope > bounds.slope_error * 2 &&
      left.slope * left.slope > 16 * (bounds.second * bounds.value_error);
}

/// Proven: f, zero within rounding and rising at the left end, falls not below zero: it rises at
/// first and is positive then. @pre |left.value| <= value_error and can_depart(left, bounds)
template <class Real>
bool proven_departure(
    const Point<Real>& left, const Point<Real>& right, const CurveBounds<Real>& bounds) {
  const QuarticLowerBound<Real> quartic(left, right, bounds);
  const Real least = quartic.least() - quartic.slack - 2 * bounds.value_error;
  const Real s = right.t - left.t;
  // f' > 0 up to the fraction x = f0' / (2 sup|f''| s); then the quartic >= least x - value_error.
  return least > 0 && least * left.slope > 8 * (bounds.value_error * bounds.second) * s;
}

/// Proven: f' < 0 on [left, right]. Linear interpolation of f' errs by at most sup|f'''| s^2 / 8.
template <class Real>
bool proven_decreasing(
    const Point<Real>& left, const Point<Real>& right, const CurveBounds<Real>& bounds) {
  const Real s = right.t - left.t;
  const Real largest = left.slope > right.slope ? left.slope : right.slope;
  return largest + bounds.third * (s * s) / 8 + bounds.slope_error * 2 < 0;
}

/// Proven: f' > 0 on [left, right].
template <class Real>
bool proven_increasing(
    const Point<Real>& left, const Point<Real>& right, const CurveBounds<Real>& bounds) {
  const Real s = right.t - left.t;
  const Real least = left.slope < right.slope ? left.slope : right.slope;
  return least - bounds.third * (s * s) / 8 - bounds.slope_error * 2 > 0;
}

/// Estimates the last root of the cubic Hermite interpolant, as a fraction of [left, right];
/// outside (0, 1) if there is none. A hint, which decides nothing: double suffices for every
/// scalar.
/// @param least  Newton's iteration ends after a step below this fraction of the root
/// @pre right.value < 0
template <class Real>
double last_root_hint(const Point<Real>& left, const Point<Real>& right, double least = 1.0 / 64) {
  const Real s = right.t - left.t;
  const auto c0 = static_cast<double>(left.value), c1 = static_cast<double>(left.slope * s);
  const auto rise = static_cast<double>(right.value - left.value);
  const auto right_slope = static_cast<double>(right.slope * s);
  const double c2 = 3 * rise - 2 * c1 - right_slope, c3 = c1 + right_slope - 2 * rise;
  double x = 1;
  for (int step = 0; step < 12; ++step) {
    const double value = c0 + x * (c1 + x * (c2 + x * c3));
    const double slope = c1 + x * (2 * c2 + x * (3 * c3));
    if (!(slope < 0)) return 2;
    const double next = x - value / slope;
    if (!(next > 0 && next < 1)) return 2;
    const double change = next - x;
    x = next;
    if (change * change < least * least * (x * x)) break;
  }
  return x;
}

/// Estimates the root between two points by inverse cubic interpolation; a hint as above.
/// @pre left.value > 0 > right.value, both slopes negative
template <class Real> Real inverse_cubic_hint(const Point<Real>& left, const Point<Real>& right) {
  const Real s = right.t - left.t;
  const auto rise = static_cast<double>(right.value - left.value);
  const double w = -static_cast<double>(left.value) / rise, v = 1 - w;
  const auto a = static_cast<double>(left.slope * s), b = static_cast<double>(right.slope * s);
  const double fraction = w * w * (1 + 2 * v) + rise * (w * v * v / a - v * w * w / b);
  return left.t + s * static_cast<Real>(fraction);
}

/// Bernstein coefficients b_1..b_3 of a cubic lower bound of f on [start, start + length]; b_0 is
/// the value itself: the second Taylor polynomial less sup|f'''| tau^3 / 6. (theory.md, section 3)
template <class Real> struct CubicLowerBound {
  Real b1, b2, b3;
  Real slack;  ///< bound on the rounding error of any coefficient

  CubicLowerBound(const Point<Real>& start, const Real& curvature, const Real& length,
      const CurveBounds<Real>& bounds) {
    const Real rise = start.slope * length, bend = curvature * (length * length) / 2;
    b1 = start.value + rise / 3;
    b2 = start.value + (2 * rise + bend) / 3;
    b3 = start.value + rise + bend - bounds.third * (length * length * length) / 6;
    const Real size = magnitude(start.value) + magnitude(rise) + bounds.second * (length * length);
    slack = bounds.value_error + length * bounds.slope_error +
        (length * length) / 2 * bounds.curvature_error + 8 * epsilon<Real>() * size;
  }

  Real least() const {
    const Real least = b1 < b2 ? b1 : b2;
    return b3 < least ? b3 : least;
  }
};

/// Proven: no contact on (start, start + length], from outside or from a start that is zero within
/// rounding and rises. See proven_positive and proven_departure.
template <class Real>
bool proven_clear(const Point<Real>& start, const Real& curvature, const Real& length,
    const CurveBounds<Real>& bounds) {
  const CubicLowerBound<Real> cubic(start, curvature, length, bounds);
  if (start.value > bounds.value_error) return cubic.least() > cubic.slack;
  if (start.value < -bounds.value_error || !can_depart(start, bounds)) return false;
  const Real least = cubic.least() - cubic.slack - 2 * bounds.value_error;
  return least > 0 && least * start.slope > 8 * (bounds.value_error * bounds.second) * length;
}

/// Estimates the first positive root of the second Taylor polynomial, measured from the start; at
/// least `length` if there is no root before. A hint as above.
template <class Real>
double first_root_hint(const Point<Real>& start, const Real& second, const Real& length) {
  const double value = start.value > 0 ? static_cast<double>(start.value) : 0.0;
  const auto slope = static_cast<double>(start.slope), curvature = static_cast<double>(second);
  const double discriminant = slope * slope - 2 * curvature * value;
  if (discriminant < 0) return static_cast<double>(length);
  const double root = std::sqrt(discriminant);
  if (slope < 0) return 2 * value / (root - slope);
  if (curvature < 0) return (slope + root) / -curvature;
  return static_cast<double>(length);
}

}  // namespace edmill::numerics
