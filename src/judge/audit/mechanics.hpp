// The mechanics of the audit, independent of the solver's: the vessel's walls, the outcome of an
// impact by right and by wrong formulas. Equations: docs/theory.md, sections 1, 2 and 5.
#pragma once

#include <algorithm>

#include "logs/event_log.hpp"
#include "model/case.hpp"

namespace edmill::audit {

using Vec = Vec3<double>;
using Case = model::Case<double>;
using Mill = model::Mill<double>;
using logs::Available, logs::BodyState, logs::LoggedEvent, logs::unknown;

EIGEN_ALWAYS_INLINE double dot(const Vec& a, const Vec& b) { return a.dot(b); }
EIGEN_ALWAYS_INLINE double size(const Vec& a) { return std::sqrt(a.dot(a)); }

/// The vessel, or a body in it, at an instant: its axes and its centre C in the inertial frame.
struct VesselFrame {
  Vec x, y, z, centre;
  Vec centre_velocity{0, 0, 0}, angular_velocity{0, 0, 0};
  // For the nested motion only, whose two rotations some codes exchange:
  Vec swing{0, 0, 0};    ///< theta' about Z [rad/s]
  double roll_rate = 0;  ///< gamma' about x' [rad/s]
  /// Displacements of the walls that move in the vessel, by wall; empty if there are none.
  std::vector<model::Moved<double>> moved{};
  Instant<double> when{};

  model::Moved<double> of_wall(int wall) const {
    return moved.empty() ? model::Moved<double>{} : moved[wall];
  }
};

/// The vessel at a time [s]. That of the nested motion is R_z(theta) R_x(gamma), (2.7').
/// @param as_printed  the nested motion's is R_x(gamma) R_z(theta), as (2.14) is printed
VesselFrame vessel_at(const Mill& mill, double time, bool as_printed);

/// Gap of a ball to a wall [m]; negative for an overlap. (2.17'), (2.19'), (2.21)
double wall_gap(const VesselFrame& frame, const Case& of, int wall, int ball, const Vec& position);
double gap_of(const LoggedEvent& event, const Case& of, const VesselFrame& frame);
/// The frames of the vessel, the contact point P, and the ball's centre.
struct WallPoint {
  const VesselFrame &nested, &printed;
  Vec contact, ball_centre;
};
/// A formula that a code may use for the velocity of the wall, and a note that describes it.
struct WallVelocity {
  const char* note;
  Vec (*at)(const WallPoint& point);
};
/// The first is correct, V = W_Z x P + (R_z W_x') x (P - C); the last derives the printed matrix.
extern const std::array<WallVelocity, 10> wall_velocities;

/// Deviations of a code in single terms of the equations, larger, smaller, reversed or missing:
/// factors, 1 for the equations of docs/theory.md, and shifts, 0 for these.
struct Terms {
  // impacts
  double friction = 1, friction_on_velocity = 1, torque = 1, share = 1;
  double compliance_in_limit = 1, compliance_in_impulse = 1;  ///< of c - 1
  double arm = 1;
  /// Formulas for equal balls, used for unequal ones.
  enum class EqualBalls { no, limit_of_sliding, friction, masses, exchanged_masses };
  EqualBalls equal_balls = EqualBalls::no;
  bool friction_of_restitution = false;  ///< limited by mu (1 + e_n) |g_n| at v_s as well
  double wall_velocity = 1, wall_velocity_delay = 0;  ///< delay [s]
  std::size_t wall_velocity_formula = 0;              ///< index in wall_velocities
  double wall_work = 1, dose = 1, spin_in_dose = 1, work_in_dose = 1, supply_in_dose = 1;
  double approach_speed = 1, slip_speed = 1;
  double contact_gap = 0;  ///< at which bodies meet [m]
  // flights
  double gravity = 1, gravity_in_places = 1, gravity_in_velocities = 1, spin_in_flight = 1;
  double time_of_flight = 0, age_of_velocities = 0;  ///< [s]

  bool operator==(const Terms&) const = default;
  bool change_impulse() const {
    return friction != 1 || friction_on_velocity != 1 || torque != 1 || share != 1 ||
        compliance_in_limit != 1 || compliance_in_impulse != 1 || arm != 1 ||
        equal_balls != EqualBalls::no || friction_of_restitution;
  }
};

/// A logged event as input of the contact law; the event and the law must outlive it.
struct LoggedImpact {
  const LoggedEvent* event = nullptr;
  const model::ContactLaw<double>* law = nullptr;       ///< of the case
  std::array<model::BallProperties<double>, 2> ball{};  ///< the partner only for balls
  Vec normal{1, 0, 0};                                  ///< unit, from the partner to the ball
  double bend = 0;  ///< rotation of the normal per displacement of the ball; 0 on a flat wall [1/m]
  Vec wall_velocity{0, 0, 0};
  bool in_stall = false;  ///< the impact is frictionless
  double arm = 1;         ///< lever arm of the contact point over R; Terms::arm
  /// M, and c = 1 + M/(m_i J_i) + M/(m_j J_j), for a wall 1 + 1/J_i
  double effective_mass = 0, compliance = 0;

  /// Sets the wall velocity by a code's formula, plus the motion of the wall within the vessel.
  void set_wall_velocity(const WallVelocity& formula, const Mill& mill, const VesselFrame& nested,
      const VesselFrame& printed);
  bool with_wall() const { return event->with_wall; }
  std::size_t count() const { return event->count(); }  ///< of balls
  Vec before() const;  ///< relative velocity of the contact points. (2.27)
  Vec after() const;
  double along(const Vec& v) const { return dot(v, normal); }
  Vec across(const Vec& v) const { return v - normal * dot(v, normal); }
  double g_n_after() const { return along(after()); }
  /// e_n for a speed before the impact, and the speed e_n |g_n| after it [m/s].
  double restitution(double g_n) const { return law->restitution(-g_n, bodies()); }
  double by_restitution(double g_n) const { return restitution(g_n) * -g_n; }
  /// Speed at which the contact points separate, max(e_n |g_n|, v_s) [m/s]. (2.23')
  double separation_speed(double g_n) const {
    // Bodies that already separate, by rounding, do not leave more slowly.
    return std::max({by_restitution(g_n), law->least_separation, g_n});
  }
  /// e_t of the law for a normal impulse of `bounce` times the effective mass. (2.24')
  /// @param bounce  |g_n| + g_n' [m/s]
  /// @param c       the compliance, or a code's value in its place
  double tangential_restitution(double c, double bounce, double slip_speed) const;
 private:
  model::ContactBodies<double> bodies() const {
    return {effective_mass, ball[0].radius, with_wall() ? -1 : ball[1].radius};
  }
};

/// The impact of an event, with the right velocity of the wall.
/// @param placed  the log has the positions of the bodies; otherwise the normal is arbitrary
LoggedImpact impact_of(const LoggedEvent& event, const Case& of, const VesselFrame&, bool placed);

/// Result of the contact law: the states after an impact, and e_t.
struct Outcome {
  std::array<BodyState, 2> body;
  double restitution_tangential;
};
/// @param by_logged_impulse  limit the friction by the logged normal impulse instead of the law's
Outcome outcome(const LoggedImpact& impact, const Terms& terms, bool by_logged_impulse = false);

/// Magnitude of the velocities involved [m/s], to which tolerances are relative.
double velocity_scale(const LoggedImpact& impact, bool with_spins);

/// Kinetic energy that the balls of a logged impact gain [J].
double kinetic_change(const LoggedImpact& impact, double spin_factor = 1);
/// Work of the wall on the ball of a logged impact [J]. (A.82)
double work_of_wall(const LoggedImpact& impact);

/// Speeds of the contact points before an impact [m/s].
struct Speeds {
  double g_n, slip;
};
Speeds speeds_before(const LoggedImpact& impact);
/// Energy that an impact adds along the normal [J]; 0 where it dissipates.
double supplied(const LoggedImpact& impact, double g_n, double separation);
/// Milling dose of an impact at these speeds [J]. (2.30'), (2.36')
double dose_by_law(const LoggedImpact& impact, Speeds speeds);

}  // namespace edmill::audit
