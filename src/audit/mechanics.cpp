#include "audit/mechanics.hpp"

#include <algorithm>
#include <cmath>

namespace edmill::audit {

namespace {

Vec cross(const Vec& a, const Vec& b) { return edmill::cross<double>(a, b); }

/// A place as seen in the vessel.
Vec inside(const VesselFrame& frame, const Vec& position) {
  const Vec d = position - frame.centre;
  return {dot(d, frame.x), dot(d, frame.y), dot(d, frame.z)};
}

VesselFrame frame_of(const model::AnyMotion<double>& motion, const model::AnyPose<double>& pose,
                     bool as_printed) {
  const auto* spex = motion.get_if<model::SpexMotion<double>>();
  if (!spex) {
    VesselFrame frame{motion.axis_x(pose), motion.axis_y(pose), motion.axis_z(pose),
                      motion.to_inertial(pose, Vec(0, 0, 0))};
    frame.centre_velocity = motion.wall_velocity(pose, frame.centre);
    frame.angular_velocity = motion.angular_velocity(pose);
    return frame;
  }
  const auto& p = std::get<model::SpexPose<double>>(pose);
  const double s = p.cos_alpha, c = -p.sin_alpha;  // sin and cos of theta = alpha + pi/2
  const double sg = p.sin_gamma, cg = p.cos_gamma;
  const Vec centre{c * spex->arm(), s * spex->arm(), 0};
  VesselFrame frame = as_printed
                          ? VesselFrame{{c, s * cg, s * sg}, {-s, c * cg, c * sg}, {0, -sg, cg}, centre}
                          : VesselFrame{{c, s, 0}, {-s * cg, c * cg, sg}, {s * sg, -c * sg, cg}, centre};
  frame.swing = {0, 0, p.theta_rate};
  frame.roll_rate = p.gamma_rate;
  frame.centre_velocity = cross(frame.swing, centre);
  frame.angular_velocity = frame.swing + frame.x * frame.roll_rate;
  return frame;
}

}  // namespace

VesselFrame vessel_at(const model::Mill<double>& mill, double time, bool as_printed) {
  const auto when = DriveClock<double>(mill.motion.period()).at(time);
  auto frame = frame_of(mill.motion, mill.motion.pose(when), as_printed);
  if (const auto* pistons = mill.vessel.pistons())
    for (int wall = 0; wall < mill.vessel.wall_count(); ++wall)
      frame.moved.push_back(pistons->of_wall(wall, when));
  return frame;
}

double wall_gap(const VesselFrame& frame, const model::AnyVessel<double>& vessel, int wall, double radius,
                const Vec& position) {
  return -vessel.inset(radius).overlap(wall, inside(frame, position)) - frame.of_wall(wall).value;
}

Vec wall_normal(const VesselFrame& frame, const model::AnyVessel<double>& vessel, int wall, double radius,
                const Vec& position) {
  const Vec own = vessel.inset(radius).normal(wall, inside(frame, position));
  const Vec normal = frame.x * own[0] + frame.y * own[1] + frame.z * own[2];
  return size(normal) > 0 ? normal : frame.x;  // on the axis of a cylinder there is none
}

double wall_bend(const VesselFrame& frame, const model::AnyVessel<double>& vessel, int wall, double radius,
                 const Vec& position) {
  if (vessel.is_flat(wall)) return 0;
  const auto room = vessel.inset(radius);
  const Vec place = inside(frame, position), normal = room.normal(wall, place);
  const double step = 1e-6 * vessel.reach();
  double square = 0;
  for (int axis = 0; axis < 3; ++axis) {
    Vec moved = place;
    moved[axis] += step;
    const Vec turned = room.normal(wall, moved) - normal;
    square += dot(turned, turned);
  }
  return std::sqrt(square) / step;
}

const char* name_of(WallVelocity formula) {
  static constexpr std::array<const char*, wall_velocity_count> names = {
      "",
      "a wall at rest",
      "the velocity of the vessel's centre for every point",
      "the wall's velocity without the rotation by gamma",
      "the wall's velocity without the rotation by theta",
      "the wall's velocity with the opposite sign",
      "the wall's velocity with the opposite sign of gamma'",
      "gamma' about the inertial X axis instead of x'",
      "the wall's velocity at the ball's centre instead of the contact point",
      "the derivative of the printed matrix (2.14)"};
  return names[static_cast<std::size_t>(formula)];
}

Vec wall_velocity(WallVelocity formula, const VesselFrame& nested, const VesselFrame& printed,
                  const Vec& point, const Vec& ball_centre) {
  const auto at = [&](const Vec& place) {
    return Vec(nested.centre_velocity + cross(nested.angular_velocity, Vec(place - nested.centre)));
  };
  const Vec X{1, 0, 0}, d = point - nested.centre;
  const Vec roll = cross(Vec(nested.x * nested.roll_rate), d);
  switch (formula) {
    case WallVelocity::nested:
      return at(point);
    case WallVelocity::none:
      return {0, 0, 0};
    case WallVelocity::of_the_centre:
      return nested.centre_velocity;
    case WallVelocity::without_gamma:
      return at(point) - roll;
    case WallVelocity::without_theta:
      return at(point) - cross(nested.swing, point);
    case WallVelocity::reversed:
      return -at(point);
    case WallVelocity::gamma_reversed:
      return at(point) - 2 * roll;
    case WallVelocity::gamma_about_X:
      return at(point) - roll + cross(Vec(X * nested.roll_rate), d);
    case WallVelocity::at_the_ball_centre:
      return at(ball_centre);
    case WallVelocity::of_the_printed_matrix: {
      // P = C + R_x R_z p: R_z p rotates about Z, then everything but C rotates about X.
      const Vec turned_z = cross(Vec(X * nested.roll_rate), d);
      // The axis Z of the inner rotation as R_x leaves it is the printed frame's z.
      return nested.centre_velocity + turned_z + cross(Vec(printed.z * nested.swing[2]), d);
    }
  }
  return {0, 0, 0};
}

void ContactGeometry::set_masses() {
  if (with_wall) {
    effective_mass = ball[0].mass;
    compliance = 1 + 1 / ball[0].reduced_inertia;
    return;
  }
  effective_mass = 1 / (1 / ball[0].mass + 1 / ball[1].mass);
  compliance = 1;
  for (const auto& b : ball) compliance += effective_mass / (b.mass * b.reduced_inertia);
}

void ContactGeometry::set_wall_velocity(WallVelocity formula, const VesselFrame& nested,
                                        const VesselFrame& printed, const Vec& ball_centre) {
  const Vec point = ball_centre - normal * ball[0].radius;
  wall_velocity = audit::wall_velocity(formula, nested, printed, point, ball_centre) +
                  piston_velocity(nested, wall, normal);
}

ContactGeometry geometry_of(const LoggedEvent& event, const model::Case<double>& the_case,
                            const VesselFrame& frame, bool placed) {
  ContactGeometry impact;
  impact.with_wall = event.with_wall;
  impact.ball[0] = the_case.balls[static_cast<std::size_t>(event.ball)];
  impact.normal = {1, 0, 0};
  const Vec& place = event.body[0].position;
  if (event.with_wall) {
    impact.wall = event.partner;
    if (placed) {
      const auto& vessel = the_case.mill.vessel;
      impact.normal = wall_normal(frame, vessel, event.partner, impact.ball[0].radius, place);
      impact.bend = wall_bend(frame, vessel, event.partner, impact.ball[0].radius, place);
      impact.set_wall_velocity(WallVelocity::nested, frame, frame, place);
    }
  } else {
    impact.ball[1] = the_case.balls[static_cast<std::size_t>(event.partner)];
    const Vec apart = place - event.body[1].position;
    const double distance = size(apart);
    if (placed && distance > 0) impact.normal = apart * (1 / distance);
  }
  impact.set_masses();
  return impact;
}

const model::ContactLaw<double>& law_of(const model::Mill<double>& mill, const ContactGeometry& impact) {
  return impact.with_wall ? mill.law_with_wall(impact.ball[0], impact.wall)
                          : mill.law_between(impact.ball[0], impact.ball[1]);
}

Vec ContactGeometry::contact_velocity(const Vec& v_i, const Vec& w_i, const Vec& v_j, const Vec& w_j) const {
  // The ball's contact point is at -R n from its centre, the partner's at +R n.
  const Vec own = v_i - cross(w_i, normal) * ball[0].radius;
  if (with_wall) return own - wall_velocity;
  return own - (v_j + cross(w_j, normal) * ball[1].radius);
}

Vec ContactGeometry::before(const LoggedEvent& e) const {
  return contact_velocity(e.body[0].velocity_before, e.body[0].spin_before, e.body[1].velocity_before,
                          e.body[1].spin_before);
}
Vec ContactGeometry::after(const LoggedEvent& e) const {
  return contact_velocity(e.body[0].velocity_after, e.body[0].spin_after, e.body[1].velocity_after,
                          e.body[1].spin_after);
}

double separation_speed(const model::ContactLaw<double>& law, const ContactGeometry& impact, double g_n) {
  // Bodies that already separate, by rounding, do not leave more slowly.
  return std::max({law.restitution(-g_n, impact.bodies()) * -g_n, law.least_separation, g_n});
}

double tangential_restitution(const model::ContactLaw<double>& law, const ContactGeometry& impact,
                              double compliance, double bounce, double slip_speed) {
  if (impact.in_stall) return 1;
  // A formula of its own where balls slide, so that a mistake in the law that runs use is seen.
  if (const auto* coulomb = std::get_if<model::WaltonBraun<double>>(&law.law)) {
    const double reversal = coulomb->friction * compliance * bounce;  // reduction of the slip by full sliding
    if (reversal >= (1 - coulomb->min_tangential) * slip_speed) return coulomb->min_tangential;
    return 1 - reversal / slip_speed;
  }
  return law.restitution_of_slip(bounce, slip_speed, compliance);
}

std::array<BodyState, 2> outcome(const ContactGeometry& impact, const model::ContactLaw<double>& law,
                                 const LoggedEvent& event, const Formula& formula) {
  const Vec g = impact.before(event);
  const double g_n = dot(g, impact.normal);
  const Vec slip = g - impact.normal * g_n;
  const double bounce = separation_speed(law, impact, g_n) - g_n;
  const double in_friction = formula.friction_of_restitution
                                 ? -(1 + law.restitution(-g_n, impact.bodies())) * std::min(g_n, 0.0)
                                 : bounce;
  const double c_in_law = formula.compliance_in_e_t > 0 ? formula.compliance_in_e_t : impact.compliance;
  const double c = formula.compliance_in_impulse > 0 ? formula.compliance_in_impulse : impact.compliance;
  const double e_t = tangential_restitution(law, impact, c_in_law, in_friction, size(slip));
  const Vec normal_part = impact.normal * bounce, tangential_part = slip * (-(1 - e_t) / c);
  auto result = event.body;
  for (std::size_t k = 0; k < (impact.with_wall ? 1u : 2u); ++k) {
    const auto& ball = impact.ball[k];
    const double side = k == 0 ? 1 : -1;
    const double share = formula.share[k] >= 0 ? formula.share[k] : impact.effective_mass / ball.mass;
    result[k].velocity_after = event.body[k].velocity_before +
                               (normal_part + tangential_part * formula.velocity_sign) * (side * share);
    // Torque of the tangential impulse on an arm of -R n, of the other ball +R n: the same sign.
    const Vec torque = cross(Vec(impact.normal * -1.0), tangential_part);
    result[k].spin_after = event.body[k].spin_before +
                           torque * (formula.spin_sign * share / (ball.radius * ball.reduced_inertia));
  }
  return result;
}

double distance(const ContactGeometry& impact, const std::array<BodyState, 2>& one,
                const std::array<BodyState, 2>& other) {
  double worst = 0;
  for (std::size_t k = 0; k < (impact.with_wall ? 1u : 2u); ++k) {
    worst = std::max(worst, size(Vec(one[k].velocity_after - other[k].velocity_after)));
    worst = std::max(worst, impact.ball[k].radius * size(Vec(one[k].spin_after - other[k].spin_after)));
  }
  return worst;
}

double velocity_scale(const ContactGeometry& impact, const LoggedEvent& event, bool with_spins) {
  double scale = size(impact.wall_velocity);
  for (std::size_t k = 0; k < (impact.with_wall ? 1u : 2u); ++k) {
    const auto& body = event.body[k];
    scale = std::max({scale, size(body.velocity_before), size(body.velocity_after)});
    if (with_spins)
      scale = std::max({scale, impact.ball[k].radius * size(body.spin_before),
                        impact.ball[k].radius * size(body.spin_after)});
  }
  return scale;
}

double kinetic_change(const LoggedEvent& event, const ContactGeometry& impact) {
  double change = 0;
  for (std::size_t k = 0; k < impact.count(); ++k) {
    const auto& ball = impact.ball[k];
    const auto& b = event.body[k];
    // (a - b).(a + b) loses fewer digits than a.a - b.b.
    change += ball.mass / 2 *
              dot(Vec(b.velocity_after - b.velocity_before), Vec(b.velocity_after + b.velocity_before));
    change += ball.mass * ball.reduced_inertia * ball.radius * ball.radius / 2 *
              dot(Vec(b.spin_after - b.spin_before), Vec(b.spin_after + b.spin_before));
  }
  return change;
}

double work_of_wall(const LoggedEvent& event, const ContactGeometry& impact) {
  if (!impact.with_wall) return 0;
  return impact.ball[0].mass *
         dot(impact.wall_velocity, Vec(event.body[0].velocity_after - event.body[0].velocity_before));
}

Speeds speeds_before(const LoggedEvent& event, const ContactGeometry& impact) {
  const Vec g = impact.before(event);
  const double g_n = dot(g, impact.normal);
  return {g_n, size(Vec(g - impact.normal * g_n))};
}

double supplied(const ContactGeometry& impact, double g_n, double separation) {
  return std::max(0.0, impact.effective_mass / 2 * (separation - g_n) * (separation + g_n));
}

double dose_by_law(const ContactGeometry& impact, const model::ContactLaw<double>& law,
                   const Speeds& speeds) {
  const double separation = separation_speed(law, impact, speeds.g_n);
  const double bounce = separation - speeds.g_n;
  const double e_t = tangential_restitution(law, impact, impact.compliance, bounce, speeds.slip);
  const double normal = std::max(0.0, (-speeds.g_n - separation) * bounce);
  return impact.effective_mass / 2 *
         (normal + (1 - e_t * e_t) / impact.compliance * speeds.slip * speeds.slip);
}

}  // namespace edmill::audit
