// The mechanics of the audit, written from the definitions and independently of the solver's own
// impulse: the vessel's walls, the correct outcome of an impact, and its outcome with wrong formulas.
// Equations: docs/theory.md, sections 1, 2 and 5.
#pragma once

#include <array>
#include <vector>

#include "audit/event_log.hpp"
#include "model/case.hpp"

namespace edmill::audit {

using Vec = Vec3<double>;

inline double dot(const Vec& a, const Vec& b) { return edmill::dot<double>(a, b); }
inline double size(const Vec& a) { return edmill::norm<double>(a); }

/// The vessel at an instant: its axes x, y, z and its centre C in the inertial frame.
struct VesselFrame {
  Vec x, y, z, centre;
  Vec centre_velocity{0, 0, 0}, angular_velocity{0, 0, 0};
  // For the nested motion only, whose two rotations codes take for each other:
  Vec swing{0, 0, 0};    ///< theta' about Z [rad/s]
  double roll_rate = 0;  ///< gamma' about x' [rad/s]
  /// Where the walls stand that move in the vessel, by wall; empty where none does.
  std::vector<model::Moved<double>> moved{};

  model::Moved<double> of_wall(int wall) const {
    return moved.empty() ? model::Moved<double>{} : moved[static_cast<std::size_t>(wall)];
  }
};

/// By the nested motion R_z(theta) R_x(gamma), (2.7'), or any other as it is.
/// @param as_printed  R_x(gamma) R_z(theta) in place of it, as (2.14) is printed
VesselFrame vessel_at(const model::Mill<double>& mill, double time, bool as_printed);

/// Gap of a ball to a wall [m]; negative for an overlap. (2.17'), (2.19'), (2.21)
double wall_gap(const VesselFrame& frame, const model::AnyVessel<double>& vessel, int wall, double radius,
                const Vec& position);
/// Unit, from the wall to the ball.
Vec wall_normal(const VesselFrame& frame, const model::AnyVessel<double>& vessel, int wall, double radius,
                const Vec& position);

/// How much the normal turns where the ball is moved [1/m]: 0 on a flat wall.
double wall_bend(const VesselFrame& frame, const model::AnyVessel<double>& vessel, int wall, double radius,
                 const Vec& position);

/// Velocities of the wall in different codes; the first is right: V = W_Z x P + (R_z W_x') x (P - C).
enum class WallVelocity {
  nested,
  none,
  of_the_centre,
  without_gamma,
  without_theta,
  reversed,
  gamma_reversed,
  gamma_about_X,
  at_the_ball_centre,
  of_the_printed_matrix,
};
inline constexpr int wall_velocity_count = 10;
const char* name_of(WallVelocity formula);
/// @param point  contact point on the wall; the ball's centre is `point + normal R`
Vec wall_velocity(WallVelocity formula, const VesselFrame& nested, const VesselFrame& printed,
                  const Vec& point, const Vec& ball_centre);

/// Velocity of a wall in its vessel, which comes on top of the above. @param normal  into the vessel
inline Vec piston_velocity(const VesselFrame& frame, int wall, const Vec& normal) {
  return normal * frame.of_wall(wall).rate;
}

/// The impact of a logged event as input of the contact law: bodies, geometry, and the wall's velocity.
struct ContactGeometry {
  bool with_wall = false;
  int wall = -1;                                      ///< id, of an impact with one
  std::array<model::BallProperties<double>, 2> ball;  ///< the partner only for balls
  Vec normal;                                         ///< unit, from the partner to the ball
  double bend = 0;                                    ///< of a wall's normal with the ball's place [1/m]
  Vec wall_velocity{0, 0, 0};
  bool in_stall = false;  ///< friction rests
  /// M, and c = 1 + M/(m_i J_i) + M/(m_j J_j), for a wall 1 + 1/J_i
  double effective_mass = 0, compliance = 0;

  void set_masses();
  /// Sets the velocity of the wall that a code has by this formula, with that in its vessel.
  void set_wall_velocity(WallVelocity formula, const VesselFrame& nested, const VesselFrame& printed,
                         const Vec& ball_centre);
  std::size_t count() const { return with_wall ? 1 : 2; }  ///< of balls
  model::ContactBodies<double> bodies() const {
    return {effective_mass, ball[0].radius, with_wall ? -1 : ball[1].radius};
  }
  /// Relative velocity of the contact points. (2.27)
  Vec contact_velocity(const Vec& v_i, const Vec& w_i, const Vec& v_j, const Vec& w_j) const;
  Vec before(const LoggedEvent& e) const;
  Vec after(const LoggedEvent& e) const;
};

/// The impact of an event, with the right velocity of the wall.
/// @param placed  whether the log has the places of its bodies; else the normal is any
ContactGeometry geometry_of(const LoggedEvent& event, const model::Case<double>& the_case,
                            const VesselFrame& frame, bool placed);

const model::ContactLaw<double>& law_of(const model::Mill<double>& mill, const ContactGeometry& impact);

/// Speed along the normal at which the contact points separate, max(e_n |g_n|, v_s) [m/s]. (2.23')
/// @param g_n  before the impact; negative while the bodies approach
double separation_speed(const model::ContactLaw<double>& law, const ContactGeometry& impact, double g_n);

/// e_t of the law for an impact that gives the normal impulse `bounce` times the effective mass. (2.24')
/// @param bounce  |g_n| + g_n' [m/s]
double tangential_restitution(const model::ContactLaw<double>& law, const ContactGeometry& impact,
                              double compliance, double bounce, double slip_speed);

/// A formula for the outcome of an impact: the right one, or one with a mistake.
struct Formula {
  double velocity_sign = 1;              ///< of the tangential term of the velocity; -1 is (2.34) as printed
  double spin_sign = 1;                  ///< of the spin's change
  double compliance_in_e_t = 0;          ///< instead of c in (2.24); 0 for c
  double compliance_in_impulse = 0;      ///< instead of c in (2.28); 0 for c
  bool friction_of_restitution = false;  ///< limited by mu (1 + e_n) |g_n| where the bodies separate at v_s
  std::array<double, 2> share{-1, -1};   ///< M/m of each ball; the right ones when negative
};

/// Velocities and spins after the impact.
std::array<BodyState, 2> outcome(const ContactGeometry& impact, const model::ContactLaw<double>& law,
                                 const LoggedEvent& event, const Formula& formula);

/// Largest difference of velocities after an impact, with spins times the radius [m/s].
double distance(const ContactGeometry& impact, const std::array<BodyState, 2>& one,
                const std::array<BodyState, 2>& other);

/// Magnitude of the velocities involved [m/s], to which tolerances are relative.
double velocity_scale(const ContactGeometry& impact, const LoggedEvent& event, bool with_spins);

/// Kinetic energy that the balls of a logged impact gain [J].
double kinetic_change(const LoggedEvent& event, const ContactGeometry& impact);
/// Work of the wall on the ball of a logged impact [J]. (A.82)
double work_of_wall(const LoggedEvent& event, const ContactGeometry& impact);

/// Speeds of the contact points before an impact [m/s].
struct Speeds {
  double g_n, slip;
};
Speeds speeds_before(const LoggedEvent& event, const ContactGeometry& impact);
/// Energy that an impact adds along the normal [J]; 0 where it dissipates.
double supplied(const ContactGeometry& impact, double g_n, double separation);
/// Milling dose of an impact at these speeds [J]. (2.30'), (2.36')
double dose_by_law(const ContactGeometry& impact, const model::ContactLaw<double>& law, const Speeds& speeds);

}  // namespace edmill::audit
