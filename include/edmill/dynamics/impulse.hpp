// What an impact does: new velocities and spins, milling dose, wall work.
// Equations: (2.28), (2.30), (2.34'), (2.35), (2.36), (A.82) of docs/theory.md.
#pragma once

#include "edmill/core/vector.hpp"
#include "edmill/model/ball.hpp"
#include "edmill/model/contact_law.hpp"

namespace edmill::dynamics {

/// The quantities of one impact.
template <class Real>
struct ImpactOutcome {
  Real approach_speed{};  ///< -g.n before the impact [m/s]
  Real slip_speed{};      ///< |g_t| before the impact [m/s]
  model::Restitution<Real> restitution{};
  Real normal_impulse{};      ///< [N s]
  Real tangential_impulse{};  ///< [N s]
  Real milling_dose{};        ///< [J], (2.30) or (2.36); never negative
  Real wall_work{};           ///< [J], (A.82); zero between balls
};

/// What the impacts before say of this one; theory.md, section 6.
template <class Real>
struct Persistence {
  bool collapsing = false;  ///< within t_c of the last one
  bool resting = false;     ///< of a body at rest for every purpose
  /// At which bodies at rest leave each other at least [m/s]: a slower approach is rounding.
  Real least_separation{0};
};

namespace detail {

/// The common part of both impacts.
template <class Real>
struct ImpulseParts {
  Vec3<Real> per_mass;     ///< velocity change of a body of the effective mass M, with the sign for body i
  Vec3<Real> spin_torque;  ///< n x B g_t
  ImpactOutcome<Real> outcome;
};

/// @param compliance  1 + M/(m_i J_i) + M/(m_j J_j); the last term is zero for a wall
template <class Real>
ImpulseParts<Real> impulse_parts(const Vec3<Real>& normal, const Vec3<Real>& contact_velocity,
                                 const Real& effective_mass, const Real& compliance,
                                 const model::ContactLaw<Real>& law, const Persistence<Real>& contact) {
  const Real normal_speed = dot<Real>(contact_velocity, normal);  // negative while approaching
  const Vec3<Real> slip = contact_velocity - normal * normal_speed;
  ImpulseParts<Real> parts;
  auto& out = parts.outcome;
  out.approach_speed = -normal_speed;
  out.slip_speed = norm<Real>(slip);
  const Real approach = normal_speed < 0 ? Real(-normal_speed) : Real(0);
  out.restitution =
      law.restitution(approach, out.slip_speed, compliance, contact.collapsing, contact.resting);
  const Real e_n = out.restitution.normal, e_t = out.restitution.tangential;
  const Real gain = (1 - e_t) / compliance;
  Real change = -((1 + e_n) * normal_speed);
  if (contact.resting && approach < contact.least_separation) {
    // Below it the approach is rounding, and may even have the wrong sign.
    change =
        contact.least_separation > normal_speed ? Real(contact.least_separation - normal_speed) : Real(0);
  }
  parts.per_mass = normal * change - slip * gain;
  parts.spin_torque = cross<Real>(normal, slip) * gain;
  out.normal_impulse = effective_mass * (change > 0 ? change : Real(0));
  out.tangential_impulse = effective_mass * (gain * out.slip_speed);
  out.milling_dose = effective_mass / 2 *
                     ((1 - e_n * e_n) * (normal_speed * normal_speed) +
                      (1 - e_t * e_t) / compliance * (out.slip_speed * out.slip_speed));
  return parts;
}

}  // namespace detail

/// Impact of two balls. (2.28), (2.30)
/// @param normal  contact normal, unit, from ball j to ball i
template <class Real>
ImpactOutcome<Real> collide_balls(const Vec3<Real>& normal, const model::BallProperties<Real>& ball_i,
                                  const model::BallProperties<Real>& ball_j, Vec3<Real>& velocity_i,
                                  Vec3<Real>& spin_i, Vec3<Real>& velocity_j, Vec3<Real>& spin_j,
                                  const model::ContactLaw<Real>& law, const Persistence<Real>& contact = {}) {
  const Real total = ball_i.mass + ball_j.mass;
  const Real share_i = ball_j.mass / total;  // M / m_i
  const Real share_j = ball_i.mass / total;
  const Real effective_mass = ball_i.mass * share_i;
  const Real compliance = 1 + share_i / ball_i.reduced_inertia + share_j / ball_j.reduced_inertia;
  const Vec3<Real> rolling = spin_i * ball_i.radius + spin_j * ball_j.radius;
  const Vec3<Real> contact_velocity = (velocity_i - velocity_j) - cross<Real>(rolling, normal);
  const auto parts =
      detail::impulse_parts<Real>(normal, contact_velocity, effective_mass, compliance, law, contact);
  velocity_i += parts.per_mass * share_i;
  velocity_j -= parts.per_mass * share_j;
  spin_i += parts.spin_torque * (share_i / (ball_i.radius * ball_i.reduced_inertia));
  spin_j += parts.spin_torque * (share_j / (ball_j.radius * ball_j.reduced_inertia));
  return parts.outcome;
}

/// Impact of a ball with a wall that moves with `wall_velocity` at the contact point. (2.34'), (2.35), (2.36)
/// @param normal  contact normal, unit, from the wall to the ball
template <class Real>
ImpactOutcome<Real> collide_with_wall(const Vec3<Real>& normal, const model::BallProperties<Real>& ball,
                                      const Vec3<Real>& wall_velocity, Vec3<Real>& velocity, Vec3<Real>& spin,
                                      const model::ContactLaw<Real>& law,
                                      const Persistence<Real>& contact = {}) {
  const Real compliance = 1 + 1 / ball.reduced_inertia;
  const Vec3<Real> rolling = spin * ball.radius;
  const Vec3<Real> contact_velocity = (velocity - wall_velocity) - cross<Real>(rolling, normal);
  auto parts = detail::impulse_parts<Real>(normal, contact_velocity, ball.mass, compliance, law, contact);
  velocity += parts.per_mass;
  spin += parts.spin_torque * (1 / (ball.radius * ball.reduced_inertia));
  parts.outcome.wall_work = ball.mass * dot<Real>(wall_velocity, parts.per_mass);
  return parts.outcome;
}

}  // namespace edmill::dynamics
