// Bounds and states of a ball in the vessel frame, shared by motions, vessels and searches.
#pragma once

#include <array>
#include <cmath>

#include "base/vector.hpp"

namespace edmill::model {

/// Bounds on a function and its first four derivatives.
template <class Real> using Majorant = std::array<Real, 5>;

inline constexpr int binomial[5][5] = {
    {1, 0, 0, 0, 0}, {1, 1, 0, 0, 0}, {1, 2, 1, 0, 0}, {1, 3, 3, 1, 0}, {1, 4, 6, 4, 1}};

/// Bound on the k-th derivative of the product a^(shift) * b^(shift_b), from bounds on a and b.
/// (Leibniz)
template <class A, class B>
typename A::value_type product_bound(const A& a, int shift, const B& b, int k, int shift_b = 0) {
  typename A::value_type sum{0};
  for (int j = 0; j <= k; ++j) sum += binomial[k][j] * a[j + shift] * b[k - j + shift_b];
  return sum;
}

/// Bounds for sin or cos of an angle of amplitude `m` and angular speed `w`, whose derivatives are
/// at most m w^k: the derivative of one is the other times the angle's rate.
template <class Real>
void fill_sin_cos(const Majorant<Real>& angle, Majorant<Real>& sine, Majorant<Real>& cosine) {
  sine[0] = angle[0] < 1 ? angle[0] : Real(1);
  cosine[0] = Real(1);
  for (int k = 0; k < 4; ++k) {
    sine[k + 1] = product_bound(angle, 1, cosine, k);
    cosine[k + 1] = product_bound(angle, 1, sine, k);
  }
}

/// Position and velocity of a body as seen in the vessel frame.
template <class Real> struct VesselFrameState {
  Vec3<Real> position;  ///< [m]
  Vec3<Real> velocity;  ///< time derivative of `position` [m/s]
};

/// Bounds on the coordinates in the vessel frame of a ball in flight, and on their first four
/// derivatives.
template <class Real> struct CoordinateBounds { Majorant<Real> x, y, z; };

/// Bounds on the rounding errors of a function of time and of its first two derivatives.
template <class Real> struct ErrorBounds { Real value, rate, second; };

/// Bounds on a flight, from which bounds on the rounding of its coordinates follow.
template <class Real> struct FlightBounds {
  Real reach;    ///< of the flight from the origin at most [m]
  Real gravity;  ///< [m/s^2]
  Real speed;    ///< inertial, at most [m/s]
  Real elapsed;  ///< since the start of the flight at most [s]
  Real lag;      ///< from the flight's drive period to the window's [s]
  Real vessel_speed{0},
      vessel_acceleration{0};  ///< of the ball in the vessel frame at most [m/s], [m/s^2]
};

/// Longest window [s] for which coordinate bounds are valid: an eighth of a period, or the time of
/// a quarter of a radian at the largest angular speed.
template <class Real> Real window_of(const Real& period, const Real& turning) {
  const Real quarter = turning > 0 ? Real(1 / (4 * turning)) : period;
  return period / 8 < quarter ? Real(period / 8) : quarter;
}

/// The box that a vessel sweeps, in inertial coordinates [m].
template <class Real> struct SweptBox { Vec3<Real> low, high; };

/// The square of the distance r from the y axis, and r.
template <class Real> Real squared_across(const Vec3<Real>& p) { return p[0] * p[0] + p[2] * p[2]; }
template <class Real> Real across(const Vec3<Real>& p) {
  using std::sqrt;
  return sqrt(squared_across(p));
}

/// Bounds on the first k derivatives of the distance r, from those of its square.
/// @param first  bound on the value that goes with them: of r, or of r less a constant
/// @pre r is not below `least`
template <class Real>
Majorant<Real> distance_bound(
    const CoordinateBounds<Real>& c, const Real& first, const Real& least, int k) {
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

/// Rounding errors of the distance, which is at most R.
/// @param e  of a coordinate  @param v, a  bounds on speed and acceleration
/// @param inverse  of the least distance
template <class Real>
ErrorBounds<Real> distance_errors(const ErrorBounds<Real>& e, const Real& u, const Real& v,
    const Real& a, const Real& R, const Real& inverse) {
  const Real bend = a + v * v * inverse;
  const Real r0 = 2 * e.value + 4 * u * R;
  const Real r1 = 2 * e.rate + 2 * v * inverse * r0 + 6 * u * v;
  const Real r2 = 2 * e.second + (2 * a * inverse + 2 * v * v * inverse * inverse) * r0 +
      4 * v * inverse * (e.rate + r1) + 16 * u * bend;
  return {r0, r1, r2};
}

/// Rounding errors of the squared distance less the square of a length, with the same parameters.
template <class Real>
ErrorBounds<Real> squared_distance_errors(
    const ErrorBounds<Real>& e, const Real& u, const Real& v, const Real& a, const Real& R) {
  return {3 * R * e.value + 4 * u * R * R, 3 * R * e.rate + 3 * v * e.value + 6 * u * R * v,
      6 * v * e.rate + 4 * R * e.second + 4 * a * e.value + 12 * u * (v * v + R * a)};
}

}  // namespace edmill::model
