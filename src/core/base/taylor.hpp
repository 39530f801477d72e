// Certified statements about a smooth function ahead of one point, from its value and two derivatives there.
#pragma once

#include <cmath>

#include "base/hermite.hpp"

namespace edmill::numerics {

/// Bernstein coefficients b_1..b_3 of a cubic lower bound of f on [start, start + length]; b_0 is the value
/// itself: the second Taylor polynomial less sup|f'''| tau^3 / 6. (theory.md, section 3)
template <class Real>
struct CubicLowerBound {
  Real b1, b2, b3;
  Real slack;  ///< bound on the rounding error of any coefficient

  CubicLowerBound(const Point<Real>& start, const Real& curvature, const Real& length,
                  const CurveBounds<Real>& bounds) {
    const Real rise = start.slope * length;
    const Real bend = curvature * (length * length) / 2;
    b1 = start.value + rise / 3;
    b2 = start.value + (2 * rise + bend) / 3;
    b3 = start.value + rise + bend - bounds.third * (length * length * length) / 6;
    slack = bounds.value_error + length * bounds.slope_error +
            (length * length) / 2 * bounds.curvature_error +
            8 * epsilon<Real>() *
                ((start.value < 0 ? Real(-start.value) : start.value) + (rise < 0 ? Real(-rise) : rise) +
                 bounds.second * (length * length));
  }

  Real least() const {
    const Real least = b1 < b2 ? b1 : b2;
    return b3 < least ? b3 : least;
  }
};

/// Proven: no contact on (start, start + length], from outside or from a start that is zero within rounding
/// and rises. See proven_positive and proven_departure.
template <class Real>
bool proven_clear(const Point<Real>& start, const Real& curvature, const Real& length,
                  const CurveBounds<Real>& bounds) {
  const CubicLowerBound<Real> cubic(start, curvature, length, bounds);
  if (start.value > bounds.value_error) return cubic.least() > cubic.slack;
  if (start.value < -bounds.value_error || !can_depart(start, bounds)) return false;
  const Real least = cubic.least() - cubic.slack - 2 * bounds.value_error;
  return least > 0 && least * start.slope > 8 * (bounds.value_error * bounds.second) * length;
}

/// Estimate of the first positive root of the second Taylor polynomial, counted from the start; `length` or
/// more when there is none before. A hint, never a decision, and so in double for every scalar.
template <class Real>
double first_root_hint(const Point<Real>& start, const Real& second_derivative, const Real& length) {
  const double value = start.value > 0 ? static_cast<double>(start.value) : 0.0;
  const double slope = static_cast<double>(start.slope), curvature = static_cast<double>(second_derivative);
  const double discriminant = slope * slope - 2 * curvature * value;
  if (discriminant < 0) return static_cast<double>(length);
  const double root = std::sqrt(discriminant);
  if (slope < 0) return 2 * value / (root - slope);
  if (curvature < 0) return (slope + root) / -curvature;
  return static_cast<double>(length);
}

}  // namespace edmill::numerics
