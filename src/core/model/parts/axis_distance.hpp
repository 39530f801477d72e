// Bounds on the distance of a ball from the y axis of its frame, and on the square of this distance.
#pragma once

#include <cmath>

#include "model/parts/vessel_frame.hpp"

namespace edmill::model {

/// Bounds on the first k derivatives of the distance r, from those of its square.
/// @param first  bound on the value that goes with them: of r, or of r less a constant
/// @pre r is not below `least`
template <class Real>
Majorant<Real> distance_bound(const CoordinateBounds<Real>& c, const Real& first, const Real& least, int k) {
  using std::sqrt;
  Majorant<Real> r{first};
  for (int n = 1; n <= k; ++n) {
    Real rest(0);
    for (int j = 1; j < n; ++j)
      rest += binomial[n][j] * (c.x[j] * c.x[n - j] + c.z[j] * c.z[n - j] + r[j] * r[n - j]);
    r[n] = sqrt(c.x[n] * c.x[n] + c.z[n] * c.z[n]) + rest / (2 * least);
  }
  return r;
}

/// Rounding errors of the distance.
/// @param e        of a coordinate
/// @param v, a     bounds on speed and acceleration
/// @param R        the distance at most
/// @param inverse  of the least distance
template <class Real>
ErrorBounds<Real> distance_errors(const ErrorBounds<Real>& e, const Real& u, const Real& v, const Real& a,
                                  const Real& R, const Real& inverse) {
  const Real bend = a + v * v * inverse;
  const Real r0 = 2 * e.value + 4 * u * R;
  const Real r1 = 2 * e.rate + 2 * v * inverse * r0 + 6 * u * v;
  const Real r2 = 2 * e.second + (2 * a * inverse + 2 * v * v * inverse * inverse) * r0 +
                  4 * v * inverse * (e.rate + r1) + 16 * u * bend;
  return {r0, r1, r2};
}

/// Rounding errors of the squared distance less the square of a length, with the same parameters.
template <class Real>
ErrorBounds<Real> squared_distance_errors(const ErrorBounds<Real>& e, const Real& u, const Real& v,
                                          const Real& a, const Real& R) {
  return {3 * R * e.value + 4 * u * R * R, 3 * R * e.rate + 3 * v * e.value + 6 * u * R * v,
          6 * v * e.rate + 4 * R * e.second + 4 * a * e.value + 12 * u * (v * v + R * a)};
}

}  // namespace edmill::model
