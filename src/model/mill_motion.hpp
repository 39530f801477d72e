// Motion of the vessel: the nested roto-translational model of the SPEX 8000.
// Source: Barahona 2011, section 2.2.2 and (2.2)-(2.16), as corrected in docs/theory.md, section 1.
#pragma once

#include <cstddef>

#include "base/archive.hpp"
#include "base/majorant.hpp"
#include "base/trigonometry.hpp"
#include "base/vector.hpp"

namespace edmill::model {

/// theta = theta_max cos(phase) + pi/2 about Z, then arm along x', then gamma = gamma_max sin(phase) about
/// x'. A still vessel has zero amplitudes; its period is a unit of the clock only.
template <class Real>
struct MillMotion {
  Real arm;        ///< l [m], fulcrum to vessel centre
  Real theta_max;  ///< [rad]
  Real gamma_max;  ///< [rad]
  Real period;     ///< of the drive [s]; angular speed w = 2 pi / period

  Real angular_speed() const { return 2 * numerics::pi<Real>() / period; }

  /// Bound on the sum of both angles [rad].
  Real angles() const { return theta_max + gamma_max; }
  /// Bound on the vessel's angular speed [rad/s].
  Real turning() const { return angles() * angular_speed(); }
  /// No point of a vessel whose points are within `vessel_reach` of its centre is faster [m/s].
  Real wall_speed(const Real& vessel_reach) const {
    const Real reach = arm + vessel_reach;
    return angular_speed() * (theta_max * reach + gamma_max * (reach - arm));
  }

  /// The box that a vessel sweeps, in inertial coordinates.
  struct Swept {
    Vec3<Real> low, high;  ///< corners [m]
    Real sideways;         ///< half of its extent along X [m]
  };
  /// @param sizes  of the vessel from its centre, along its axes [m]
  Swept swept(const Vec3<Real>& sizes, const Real& vessel_reach) const {
    const Real &R = sizes[0], &h = sizes[1];
    const Real swing = theta_max < 1 ? theta_max : Real(1);
    const Real tilt = gamma_max < 1 ? gamma_max : Real(1);
    const Real sideways = arm * swing + vessel_reach;
    const Real upright = R + h * tilt;
    const Real nearest = arm * (1 - swing * swing) - (R + (h + R * tilt) * swing);
    return {{-sideways, nearest, Real(-upright)},
            {sideways, Real(arm + R + (h + R * tilt) * swing), upright},
            sideways};
  }

  /// Bounds on the coordinates in the vessel frame of a ball in flight, and on their first four derivatives.
  struct CoordinateBounds {
    numerics::Majorant<Real> x, y, z;
  };
  /// For a ball whose speed stays below `speed` [m/s] over a window of `length` [s] that it enters inside a
  /// vessel of these sizes. Derivation: docs/theory.md, section 3.
  CoordinateBounds coordinate_bounds(const Vec3<Real>& sizes, const Real& vessel_reach, const Real& gravity,
                                     const Real& speed, const Real& length) const;
};

template <class Real>
auto MillMotion<Real>::coordinate_bounds(const Vec3<Real>& sizes, const Real& vessel_reach,
                                         const Real& gravity, const Real& speed, const Real& length) const
    -> CoordinateBounds {
  using numerics::Majorant;
  using numerics::product_bound;
  const Real w = angular_speed();
  Majorant<Real> alpha, gamma, sine, cosine;
  Real power{1};
  for (int k = 0; k < 5; ++k, power *= w) {
    alpha[k] = theta_max * power;
    gamma[k] = gamma_max * power;
  }
  numerics::fill_sin_cos(gamma, sine, cosine);

  // How far outside the vessel the path may get within the window: |p'| <= U.
  const Real shrink = 1 - (alpha[1] + gamma[1]) * length;
  const Real frame_speed = (speed + alpha[1] * (arm + vessel_reach) + gamma[1] * vessel_reach) / shrink;
  const Real excursion = frame_speed * length;

  // Gravity and velocity in the frame that turns with theta: G' = alpha' G, V' = G + alpha' V.
  Majorant<Real> g, v, v_z, a, b, x, y, z;
  g[0] = gravity;
  v[0] = speed;
  v_z = {speed, g[0], Real(0), Real(0), Real(0)};
  x[0] = sizes[0] + excursion;
  y[0] = sizes[1] + excursion;
  z[0] = sizes[2] + excursion;
  a[0] = arm + x[0];
  b[0] = y[0] + sine[0] * z[0];
  for (int k = 0; k < 4; ++k) {
    g[k + 1] = product_bound(alpha, 1, g, k);
    v[k + 1] = g[k] + product_bound(alpha, 1, v, k);
    a[k + 1] = v[k] + product_bound(alpha, 1, b, k);
    b[k + 1] = v[k] + product_bound(alpha, 1, a, k);
    x[k + 1] = a[k + 1];
    // The bounds on b' enter through b shifted by one derivative.
    Real y_next = product_bound(v_z, 0, sine, k) + product_bound(gamma, 1, z, k);
    Real z_next = product_bound(v_z, 0, cosine, k) + product_bound(gamma, 1, y, k);
    for (int j = 0; j <= k; ++j) {
      y_next += numerics::binomial[k][j] * b[j + 1] * cosine[k - j];
      z_next += numerics::binomial[k][j] * b[j + 1] * sine[k - j];
    }
    y[k + 1] = y_next;
    z[k + 1] = z_next;
  }
  return {x, y, z};
}

/// Where the vessel is at one instant. `alpha` is theta - pi/2, so sin(theta) = cos(alpha).
template <class Real>
struct VesselPose {
  Real sin_alpha, cos_alpha;
  Real sin_gamma, cos_gamma;
  Real theta_rate, gamma_rate;                  ///< [rad/s]
  Real theta_acceleration, gamma_acceleration;  ///< [rad/s^2]

  void archive(Archive& a) {
    a(sin_alpha, cos_alpha, sin_gamma, cos_gamma, theta_rate, gamma_rate, theta_acceleration,
      gamma_acceleration);
  }
};

/// Pose at `offset` [s] from the start of any drive period. (2.2), (2.5)
template <class Real>
inline VesselPose<Real> pose_at(const MillMotion<Real>& motion, const Real& angular_speed,
                                const Real& frequency, const Real& offset) {
  const auto phase = numerics::sin_cos_turns<Real>(offset * frequency);
  const Real alpha = motion.theta_max * phase.cos;
  const Real gamma = motion.gamma_max * phase.sin;
  const auto a = numerics::sin_cos<Real>(alpha), g = numerics::sin_cos<Real>(gamma);
  const Real alpha_rate = -(motion.theta_max * angular_speed) * phase.sin;
  const Real gamma_rate = (motion.gamma_max * angular_speed) * phase.cos;
  const Real speed_squared = angular_speed * angular_speed;
  return {a.sin, a.cos, g.sin, g.cos, alpha_rate, gamma_rate, -speed_squared * alpha, -speed_squared * gamma};
}

template <class Real>
inline VesselPose<Real> pose_at(const MillMotion<Real>& motion, const Real& offset) {
  return pose_at<Real>(motion, motion.angular_speed(), 1 / motion.period, offset);
}

/// Axes of the vessel frame x (along the arm), y (vessel axis), z in inertial coordinates.
template <class Real>
inline Vec3<Real> vessel_axis_x(const VesselPose<Real>& p) {
  return {-p.sin_alpha, p.cos_alpha, Real(0)};
}
template <class Real>
inline Vec3<Real> vessel_axis_y(const VesselPose<Real>& p) {
  return {-p.cos_alpha * p.cos_gamma, -p.sin_alpha * p.cos_gamma, p.sin_gamma};
}
template <class Real>
inline Vec3<Real> vessel_axis_z(const VesselPose<Real>& p) {
  return {p.cos_alpha * p.sin_gamma, p.sin_alpha * p.sin_gamma, p.cos_gamma};
}

/// A direction in the vessel frame, seen in the inertial one.
template <class Real>
inline Vec3<Real> direction_to_inertial(const VesselPose<Real>& pose, const Vec3<Real>& n) {
  return vessel_axis_x(pose) * n[0] + vessel_axis_y(pose) * n[1] + vessel_axis_z(pose) * n[2];
}

/// Inertial position of a point fixed in the vessel frame: P = R_z(theta) [ (l,0,0) + R_x(gamma) p ]. (2.7')
template <class Real>
inline Vec3<Real> to_inertial(const VesselPose<Real>& pose, const Real& arm, const Vec3<Real>& p) {
  const Real along_arm = arm + p[0];
  const Real b = p[1] * pose.cos_gamma - p[2] * pose.sin_gamma;
  const Real height = p[1] * pose.sin_gamma + p[2] * pose.cos_gamma;
  return {-pose.sin_alpha * along_arm - pose.cos_alpha * b, pose.cos_alpha * along_arm - pose.sin_alpha * b,
          height};
}

/// Position and velocity of a body as seen in the vessel frame.
template <class Real>
struct VesselFrameState {
  Vec3<Real> position;  ///< [m]
  Vec3<Real> velocity;  ///< time derivative of `position` [m/s]
};

/// (2.16'): where a body at `position` is in the vessel.
template <class Real>
inline Vec3<Real> position_in_vessel(const VesselPose<Real>& pose, const Real& arm,
                                     const Vec3<Real>& position) {
  const Real a = position[1] * pose.cos_alpha - position[0] * pose.sin_alpha;
  const Real b = -(position[0] * pose.cos_alpha + position[1] * pose.sin_alpha);
  return {a - arm, b * pose.cos_gamma + position[2] * pose.sin_gamma,
          position[2] * pose.cos_gamma - b * pose.sin_gamma};
}

/// (2.16') and its time derivative for a body at `position` moving with `velocity`.
template <class Real>
inline VesselFrameState<Real> to_vessel_frame(const VesselPose<Real>& pose, const Real& arm,
                                              const Vec3<Real>& position, const Vec3<Real>& velocity) {
  const Real a = position[1] * pose.cos_alpha - position[0] * pose.sin_alpha;
  const Real b = -(position[0] * pose.cos_alpha + position[1] * pose.sin_alpha);
  const Real a_rate = (velocity[1] * pose.cos_alpha - velocity[0] * pose.sin_alpha) + pose.theta_rate * b;
  const Real b_rate = -(velocity[0] * pose.cos_alpha + velocity[1] * pose.sin_alpha) - pose.theta_rate * a;
  const Real y = b * pose.cos_gamma + position[2] * pose.sin_gamma;
  const Real z = position[2] * pose.cos_gamma - b * pose.sin_gamma;
  const Real y_rate = (b_rate * pose.cos_gamma + velocity[2] * pose.sin_gamma) + pose.gamma_rate * z;
  const Real z_rate = (velocity[2] * pose.cos_gamma - b_rate * pose.sin_gamma) - pose.gamma_rate * y;
  return {{a - arm, y, z}, {a_rate, y_rate, z_rate}};
}

/// Second time derivative of a body's vessel-frame position while it falls freely.
/// @param state  of to_vessel_frame for the same body and pose
template <class Real>
inline Vec3<Real> vessel_frame_acceleration(const VesselPose<Real>& pose, const Real& arm,
                                            const VesselFrameState<Real>& state, const Vec3<Real>& velocity,
                                            const Vec3<Real>& gravity) {
  const auto &p = state.position, &u = state.velocity;
  const Real &sa = pose.sin_alpha, &ca = pose.cos_alpha, &sg = pose.sin_gamma, &cg = pose.cos_gamma;
  const Real a = p[0] + arm, b = p[1] * cg - p[2] * sg;
  const Real velocity_a = velocity[1] * ca - velocity[0] * sa,
             velocity_b = -(velocity[0] * ca + velocity[1] * sa);
  const Real gravity_a = gravity[1] * ca - gravity[0] * sa, gravity_b = -(gravity[0] * ca + gravity[1] * sa);
  const Real b_rate = velocity_b - pose.theta_rate * a;
  const Real a_second =
      gravity_a + pose.theta_rate * velocity_b + (pose.theta_acceleration * b + pose.theta_rate * b_rate);
  const Real b_second =
      gravity_b - pose.theta_rate * velocity_a - (pose.theta_acceleration * a + pose.theta_rate * u[0]);
  // y' = b' cos + V_Z sin + gamma' z and z' = V_Z cos - b' sin - gamma' y, once more.
  const Real turned = velocity[2] * cg - b_rate * sg, raised = b_rate * cg + velocity[2] * sg;
  const Real y_second = (b_second * cg + gravity[2] * sg) + pose.gamma_rate * turned +
                        (pose.gamma_acceleration * p[2] + pose.gamma_rate * u[2]);
  const Real z_second = (gravity[2] * cg - b_second * sg) - pose.gamma_rate * raised -
                        (pose.gamma_acceleration * p[1] + pose.gamma_rate * u[1]);
  return {a_second, y_second, z_second};
}

/// Inertial angular velocity of the vessel: theta' about Z plus gamma' about x'.
template <class Real>
inline Vec3<Real> vessel_angular_velocity(const VesselPose<Real>& pose) {
  return {-pose.sin_alpha * pose.gamma_rate, pose.cos_alpha * pose.gamma_rate, pose.theta_rate};
}

/// Inertial velocity of the vessel's material point at inertial `point`: V = W_Z x P + (R_z W_x') x (P - C).
template <class Real>
inline Vec3<Real> wall_velocity(const VesselPose<Real>& pose, const Real& arm, const Vec3<Real>& point) {
  const Vec3<Real> centre{-pose.sin_alpha * arm, pose.cos_alpha * arm, Real(0)};
  const Vec3<Real> about_z{Real(0), Real(0), pose.theta_rate};
  const Vec3<Real> about_arm{-pose.sin_alpha * pose.gamma_rate, pose.cos_alpha * pose.gamma_rate, Real(0)};
  const Vec3<Real> from_centre = point - centre;
  return cross<Real>(about_z, point) + cross<Real>(about_arm, from_centre);
}

/// Inertial acceleration of the vessel's material point at inertial `point` [m/s^2].
template <class Real>
inline Vec3<Real> wall_acceleration(const VesselPose<Real>& pose, const Real& arm, const Vec3<Real>& point) {
  const Vec3<Real> centre{-pose.sin_alpha * arm, pose.cos_alpha * arm, Real(0)};
  const Vec3<Real> about_z{Real(0), Real(0), pose.theta_rate};
  const Vec3<Real> omega = vessel_angular_velocity(pose);
  const Vec3<Real> axis = vessel_axis_x(pose);
  // d/dt omega: the arm axis itself turns about Z.
  const Vec3<Real> about_arm = axis * pose.gamma_rate;
  const Vec3<Real> omega_rate = Vec3<Real>(Real(0), Real(0), pose.theta_acceleration) +
                                Vec3<Real>(axis * pose.gamma_acceleration) + cross<Real>(about_z, about_arm);
  const Vec3<Real> centre_velocity = cross<Real>(about_z, centre);
  const Vec3<Real> centre_acceleration =
      cross<Real>(Vec3<Real>(Real(0), Real(0), pose.theta_acceleration), centre) +
      cross<Real>(about_z, centre_velocity);
  const Vec3<Real> d = point - centre;
  const Vec3<Real> turning = cross<Real>(omega, d);
  return centre_acceleration + cross<Real>(omega_rate, d) + cross<Real>(omega, turning);
}

}  // namespace edmill::model
