// Collision rules: velocities and spins after an impact, milling dose, wall work.
// Equations: (2.23'), (2.28'), (2.30'), (2.34'), (2.35), (2.36'), (A.82) of docs/theory.md.
#pragma once

#include "base/vector.hpp"
#include "model/ball.hpp"
#include "model/contact_law.hpp"

namespace edmill::dynamics {

template <class Real> struct ImpactOutcome {
  Real approach_speed{};          ///< -g.n before the impact [m/s]
  Real separation_speed{};        ///< g.n after the impact [m/s]
  Real slip_speed{};              ///< |g_t| before the impact [m/s]
  Real restitution_tangential{};  ///< e_t
  bool least_separation{};    ///< the least separation speed, and not the restitution, decided g.n
  bool in_stall{};            ///< frictionless by the stall rule
  Real normal_impulse{};      ///< [N s]
  Real tangential_impulse{};  ///< [N s]
  Real milling_dose{};        ///< [J], (2.30') or (2.36'); never negative
  Real normal_dose{};      ///< the part of the dose that the motion along the normal gives up [J]
  Real supplied_energy{};  ///< that the least separation speed adds to the motion [J]; >= 0
  Real wall_work{};        ///< [J], (A.82); zero between balls

  /// M/2 g_n^2, the kinetic energy of the approach along the normal [J]; 0 without approach.
  Real impact_energy() const {
    const Real &before = approach_speed, &after = separation_speed;
    return before > 0 ? Real(normal_impulse / (before + after) * (before * before) / 2) : Real(0);
  }
  /// Separation over approach speed: above 1 with supplied energy, 1 without approach.
  Real restitution_normal() const {
    return approach_speed > 0 ? Real(separation_speed / approach_speed) : Real(1);
  }
};

namespace detail {

template <class Real> struct ImpulseParts {
  Vec3<Real> per_mass;     ///< velocity change of a body i of the effective mass M
  Vec3<Real> spin_torque;  ///< n x B g_t
  ImpactOutcome<Real> outcome;
};

/// @param compliance  1 + M/(m_i J_i) + M/(m_j J_j); the last term is zero for a wall
template <class Real>
ImpulseParts<Real> impulse_parts(const Vec3<Real>& normal, const Vec3<Real>& contact_velocity,
    const model::ContactBodies<Real>& bodies, const Real& compliance,
    const model::ContactLaw<Real>& law, bool in_stall) {
  const Real& mass = bodies.effective_mass;
  const Real normal_speed = dot<Real>(contact_velocity, normal);  // negative while approaching
  const Vec3<Real> slip = contact_velocity - normal * normal_speed;
  ImpulseParts<Real> parts;
  auto& out = parts.outcome;
  out.approach_speed = -normal_speed;
  out.slip_speed = norm<Real>(slip);
  const Real approach = normal_speed < 0 ? Real(-normal_speed) : Real(0);
  const Real by_restitution = law.restitution(approach, bodies) * approach;
  const Real separation =
      by_restitution < law.least_separation ? law.least_separation : by_restitution;
  out.least_separation = separation > by_restitution && separation > normal_speed;
  // Bodies that already separate faster, because of rounding, keep their velocities.
  out.separation_speed = separation > normal_speed ? separation : normal_speed;
  const Real change = out.separation_speed - normal_speed;
  out.in_stall = in_stall;
  Real& e_t = out.restitution_tangential;
  e_t = in_stall ? Real(1) : law.restitution_of_slip(change, out.slip_speed, compliance);
  const Real gain = (1 - e_t) / compliance;
  parts.per_mass = normal * change - slip * gain;
  parts.spin_torque = cross<Real>(normal, slip) * gain;
  out.normal_impulse = mass * change;
  out.tangential_impulse = mass * (gain * out.slip_speed);
  const Real normal_loss = mass / 2 * ((out.approach_speed - out.separation_speed) * change);
  if (normal_loss < 0)
    out.supplied_energy = -normal_loss;
  else
    out.normal_dose = normal_loss;
  const Real slip_squared = out.slip_speed * out.slip_speed;
  out.milling_dose = out.normal_dose + mass / 2 * ((1 - e_t * e_t) / compliance * slip_squared);
  return parts;
}

}  // namespace detail

/// Impact of two balls. (2.28'), (2.30') @param normal  contact normal, unit, from ball j to ball i
/// @param in_stall  the impact is frictionless (theory.md, section 6)
template <class Real>
ImpactOutcome<Real> collide_balls(const Vec3<Real>& normal,
    const model::BallProperties<Real>& ball_i, const model::BallProperties<Real>& ball_j,
    Vec3<Real>& velocity_i, Vec3<Real>& spin_i, Vec3<Real>& velocity_j, Vec3<Real>& spin_j,
    const model::ContactLaw<Real>& law, bool in_stall = false) {
  const Real total = ball_i.mass + ball_j.mass;
  const Real share_i = ball_j.mass / total, share_j = ball_i.mass / total;  // M / m
  const Real compliance = 1 + share_i / ball_i.reduced_inertia + share_j / ball_j.reduced_inertia;
  const Vec3<Real> rolling = spin_i * ball_i.radius + spin_j * ball_j.radius;
  const Vec3<Real> contact_velocity = (velocity_i - velocity_j) - cross<Real>(rolling, normal);
  const model::ContactBodies<Real> bodies{ball_i.mass * share_i, ball_i.radius, ball_j.radius};
  const auto parts =
      detail::impulse_parts<Real>(normal, contact_velocity, bodies, compliance, law, in_stall);
  velocity_i += parts.per_mass * share_i;
  velocity_j -= parts.per_mass * share_j;
  spin_i += parts.spin_torque * (share_i / (ball_i.radius * ball_i.reduced_inertia));
  spin_j += parts.spin_torque * (share_j / (ball_j.radius * ball_j.reduced_inertia));
  return parts.outcome;
}

/// Impact of a ball with a wall that moves with `wall_velocity` there. (2.34'), (2.35), (2.36')
/// @param normal  unit, from the wall to the ball
template <class Real>
ImpactOutcome<Real> collide_with_wall(const Vec3<Real>& normal,
    const model::BallProperties<Real>& ball, const Vec3<Real>& wall_velocity, Vec3<Real>& velocity,
    Vec3<Real>& spin, const model::ContactLaw<Real>& law, bool in_stall = false) {
  const Real compliance = 1 + 1 / ball.reduced_inertia;
  const Vec3<Real> rolling = spin * ball.radius;
  const Vec3<Real> contact_velocity = (velocity - wall_velocity) - cross<Real>(rolling, normal);
  auto parts = detail::impulse_parts<Real>(
      normal, contact_velocity, {ball.mass, ball.radius}, compliance, law, in_stall);
  velocity += parts.per_mass;
  spin += parts.spin_torque * (1 / (ball.radius * ball.reduced_inertia));
  parts.outcome.wall_work = ball.mass * dot<Real>(wall_velocity, parts.per_mass);
  return parts.outcome;
}

}  // namespace edmill::dynamics
