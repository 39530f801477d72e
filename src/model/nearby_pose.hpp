// The vessel's pose a moment before or after a known one, without sines, which are expensive in wide scalars.
#pragma once

#include <limits>

#include "model/mill_motion.hpp"

namespace edmill::model {

namespace detail {

/// Turns [rad] up to which what double rounds off the cubic term, d^3 2^-53 / 6, and the quintic term,
/// d^5 / 120, are below the scalar's rounding of 1.
template <class Real>
constexpr double longest_turn_of() {
  constexpr int digits = std::numeric_limits<Real>::digits;
  if (digits <= 113) return 0x1p-24;
  double turn = 1;
  for (int k = 0; k < (digits - 53) / 3; ++k) turn /= 2;
  return turn;
}
template <class Real>
inline constexpr double longest_turn = longest_turn_of<Real>();

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

}  // namespace detail

/// Pose at `offset` [s], given the one at `known`. Both angles swing harmonically, alpha'' = -w^2 alpha, so
/// with x = w dt they grow by alpha' sin(x) / w + alpha'' (1 - cos(x)) / w^2. Error: two roundings more than
/// pose_at.
/// @param with_rates  whether the rates and accelerations are asked for, and not the angles alone
template <class Real, bool with_rates = true>
inline VesselPose<Real> pose_nearby(const MillMotion<Real>& motion, const Real& angular_speed,
                                    const Real& frequency, const Real& offset, const VesselPose<Real>& pose,
                                    const Real& known) {
  const Real dt = offset - known;
  const double short_dt = static_cast<double>(dt), x = static_cast<double>(angular_speed) * short_dt;
  if (!(x <= detail::longest_turn<Real> && x >= -detail::longest_turn<Real>)) [[unlikely]]
    return pose_at<Real>(motion, angular_speed, frequency, offset);
  const Real first = dt - Real(short_dt * (x * x) / 6);                        // sin(x) / w
  const Real second = dt * dt / 2 - Real(short_dt * short_dt * (x * x) / 24);  // (1 - cos(x)) / w^2
  VesselPose<Real> next = pose;
  const auto swing = [&](Real& sine, Real& cosine, Real& rate, Real& acceleration) {
    const Real grown = rate * first + acceleration * second;
    detail::turn<Real>(sine, cosine, grown);
    if constexpr (with_rates) {
      const Real speed_squared = angular_speed * angular_speed;
      rate += acceleration * first - speed_squared * (rate * second);
      acceleration -= speed_squared * grown;
    }
  };
  swing(next.sin_alpha, next.cos_alpha, next.theta_rate, next.theta_acceleration);
  swing(next.sin_gamma, next.cos_gamma, next.gamma_rate, next.gamma_acceleration);
  return next;
}

}  // namespace edmill::model
