#include "audit/mechanics.hpp"

namespace edmill::audit {

namespace {

Vec cross(const Vec& a, const Vec& b) { return edmill::cross<double>(a, b); }

Vec inside(const VesselFrame& frame, const Vec& position) {
  const Vec d = position - frame.centre;
  return {dot(d, frame.x), dot(d, frame.y), dot(d, frame.z)};
}

/// The frame of a motion whose axes are not nested.
template <class M> VesselFrame plain_frame(const M& motion, const typename M::Pose& pose) {
  VesselFrame frame{motion.axis_x(pose), motion.axis_y(pose), motion.axis_z(pose),
      motion.to_inertial(pose, Vec(0, 0, 0))};
  frame.centre_velocity = motion.wall_velocity(pose, frame.centre);
  frame.angular_velocity = motion.angular_velocity(pose);
  return frame;
}

VesselFrame frame_of(
    const model::AnyMotion<double>& motion, const model::AnyPose<double>& pose, bool as_printed) {
  const auto* spex = motion.get_if<model::SpexMotion<double>>();
  if (!spex) return plain_frame(motion, pose);
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

Vec velocity_at(const WallPoint& p, const Vec& place) {
  return p.nested.centre_velocity + cross(p.nested.angular_velocity, Vec(place - p.nested.centre));
}
Vec from_centre(const WallPoint& p) { return p.contact - p.nested.centre; }
Vec by_roll(const WallPoint& p) {
  return cross(Vec(p.nested.x * p.nested.roll_rate), from_centre(p));
}
Vec by_roll_about_X(const WallPoint& p) {
  return cross(Vec(Vec(1, 0, 0) * p.nested.roll_rate), from_centre(p));
}

/// The ball's contact point is at -R n from its centre, the partner's at +R n.
Vec contact_velocity(const LoggedImpact& impact, Vec BodyState::*velocity, Vec BodyState::*spin) {
  const auto& [one, two] = impact.event->body;
  const auto& [ball, partner] = impact.ball;
  const Vec own = one.*velocity - cross(one.*spin, impact.normal) * (impact.arm * ball.radius);
  if (impact.with_wall()) return own - impact.wall_velocity;
  return own - (two.*velocity + cross(two.*spin, impact.normal) * (impact.arm * partner.radius));
}

/// Rotation of a wall's normal per displacement of the ball [1/m]. @param step  displacement [m]
double bend_of(const auto& room, int wall, const Vec& place, double step) {
  const Vec normal = room.normal(wall, place);
  double square = 0;
  for (int axis = 0; axis < 3; ++axis) {
    Vec moved = place;
    moved[axis] += step;
    const Vec turned = room.normal(wall, moved) - normal;
    square += dot(turned, turned);
  }
  return std::sqrt(square) / step;
}

/// Calls f(frame, room, number) with the vessel or body of a wall, and its number there.
auto with_wall(const Mill& mill, int wall, const VesselFrame& vessel, double radius, auto f) {
  const auto* body = mill.body_of(wall);
  if (!body) return f(vessel, mill.vessel.inset(radius), wall);
  return f(plain_frame(body->motion, body->motion.pose(vessel.when)), body->shape.inset(radius), 0);
}

}  // namespace

VesselFrame vessel_at(const Mill& mill, double time, bool as_printed) {
  const auto when = DriveClock<double>(mill.motion.period()).at(time);
  auto frame = frame_of(mill.motion, mill.motion.pose(when), as_printed);
  frame.when = when;
  if (const auto* pistons = mill.vessel.pistons())
    for (int wall = 0; wall < mill.vessel.wall_count(); ++wall)
      frame.moved.push_back(pistons->of_wall(wall, when));
  return frame;
}

double wall_gap(const VesselFrame& frame, const Case& of, int wall, int ball, const Vec& position) {
  return with_wall(of.mill, wall, frame, of.balls[ball].radius,
      [&](const VesselFrame& own, const auto& room, int number) {
        return -room.overlap(number, inside(own, position)) - own.of_wall(number).value;
      });
}

double gap_of(const LoggedEvent& event, const Case& of, const VesselFrame& frame) {
  const auto& [one, two] = event.body;
  if (event.with_wall) return wall_gap(frame, of, event.partner, event.ball, one.position);
  return size(Vec(one.position - two.position)) - of.balls[event.ball].radius -
      of.balls[event.partner].radius;
}

const std::array<WallVelocity, 10> wall_velocities = {{
    {"", [](const WallPoint& p) { return velocity_at(p, p.contact); }},
    {"a wall at rest", [](const WallPoint&) { return Vec(0, 0, 0); }},
    {"the velocity of the vessel's centre for every point",
        [](const WallPoint& p) { return p.nested.centre_velocity; }},
    {"the wall's velocity without the rotation by gamma",
        [](const WallPoint& p) { return Vec(velocity_at(p, p.contact) - by_roll(p)); }},
    {"the wall's velocity without the rotation by theta",
        [](const WallPoint& p) {
          return Vec(velocity_at(p, p.contact) - cross(p.nested.swing, p.contact));
        }},
    {"the wall's velocity with the opposite sign",
        [](const WallPoint& p) { return Vec(-velocity_at(p, p.contact)); }},
    {"the wall's velocity with the opposite sign of gamma'",
        [](const WallPoint& p) { return Vec(velocity_at(p, p.contact) - 2 * by_roll(p)); }},
    {"gamma' about the inertial X axis instead of x'",
        [](const WallPoint& p) {
          return Vec(velocity_at(p, p.contact) - by_roll(p) + by_roll_about_X(p));
        }},
    {"the wall's velocity at the ball's centre instead of the contact point",
        [](const WallPoint& p) { return velocity_at(p, p.ball_centre); }},
    {"the derivative of the printed matrix (2.14)",
        [](const WallPoint& p) {
          // P = C + R_x R_z p: R_z p rotates about Z, then everything but C rotates about X. The
          // axis Z of the inner rotation as R_x leaves it is the printed frame's z.
          return Vec(p.nested.centre_velocity + by_roll_about_X(p) +
              cross(Vec(p.printed.z * p.nested.swing[2]), from_centre(p)));
        }},
}};

void LoggedImpact::set_wall_velocity(const WallVelocity& formula, const Mill& mill,
    const VesselFrame& nested, const VesselFrame& printed) {
  const Vec& ball_centre = event->body[0].position;
  const Vec contact = ball_centre - normal * ball[0].radius;
  if (const auto* body = mill.body_of(event->partner)) {
    const auto own = plain_frame(body->motion, body->motion.pose(nested.when));
    wall_velocity = formula.at({own, own, contact, ball_centre});
  } else {
    wall_velocity = formula.at({nested, printed, contact, ball_centre}) +
        normal * nested.of_wall(event->partner).rate;
  }
}

LoggedImpact impact_of(
    const LoggedEvent& event, const Case& of, const VesselFrame& frame, bool placed) {
  const auto& mill = of.mill;
  LoggedImpact impact;
  impact.event = &event;
  auto& [ball, partner] = impact.ball;
  ball = of.balls[event.ball];
  const Vec& place = event.body[0].position;
  if (event.with_wall) {
    impact.law = &mill.law_with_wall(ball, event.partner);
    impact.effective_mass = ball.mass;
    impact.compliance = 1 + 1 / ball.reduced_inertia;
    if (!placed) return impact;
    with_wall(mill, event.partner, frame, ball.radius,
        [&](const VesselFrame& own, const auto& room, int number) {
          const Vec seen = inside(own, place), normal = room.normal(number, seen);
          impact.normal = own.x * normal[0] + own.y * normal[1] + own.z * normal[2];
          if (!(size(impact.normal) > 0))
            impact.normal = own.x;  // undefined on the axis of a cylinder
          if (!room.is_flat(number))
            impact.bend = bend_of(room, number, seen, 1e-6 * mill.vessel.reach());
        });
    impact.set_wall_velocity(wall_velocities[0], mill, frame, frame);
    return impact;
  }
  partner = of.balls[event.partner];
  impact.law = &mill.law_between(ball, partner);
  impact.effective_mass = 1 / (1 / ball.mass + 1 / partner.mass);
  impact.compliance = 1;
  for (const auto& b : impact.ball)
    impact.compliance += impact.effective_mass / (b.mass * b.reduced_inertia);
  const Vec apart = place - event.body[1].position;
  const double distance = size(apart);
  if (placed && distance > 0) impact.normal = apart * (1 / distance);
  return impact;
}

Vec LoggedImpact::before() const {
  return contact_velocity(*this, &BodyState::velocity_before, &BodyState::spin_before);
}
Vec LoggedImpact::after() const {
  return contact_velocity(*this, &BodyState::velocity_after, &BodyState::spin_after);
}

double LoggedImpact::tangential_restitution(double c, double bounce, double slip_speed) const {
  if (in_stall) return 1;
  // Sliding has a formula of its own here: a mistake in the law that runs use is detected.
  if (const auto* coulomb = std::get_if<model::WaltonBraun<double>>(&law->law)) {
    const double reversal = coulomb->friction * c * bounce;  // of the slip by full sliding
    if (reversal >= (1 - coulomb->min_tangential) * slip_speed) return coulomb->min_tangential;
    return 1 - reversal / slip_speed;
  }
  return law->restitution_of_slip(bounce, slip_speed, c);
}

Outcome outcome(const LoggedImpact& impact, const Terms& terms, bool by_logged_impulse) {
  using EqualBalls = Terms::EqualBalls;
  const auto equal = impact.with_wall() ? EqualBalls::no : terms.equal_balls;
  std::array<double, 2> share{};  // M/m of each ball
  for (std::size_t k = 0; k < impact.count(); ++k)
    share[k] = std::max(0.0, terms.share * impact.effective_mass / impact.ball[k].mass);
  if (equal == EqualBalls::masses) share = {0.5, 0.5};
  if (equal == EqualBalls::exchanged_masses) std::swap(share[0], share[1]);
  const double alone = 1 + 1 / impact.ball[0].reduced_inertia, less = impact.compliance - 1;
  const auto compliance = [&](double factor) { return std::max(1e-3, 1 + less * factor); };
  const bool in_limit = equal == EqualBalls::limit_of_sliding || equal == EqualBalls::friction;
  const double c_in_limit = in_limit ? alone : compliance(terms.compliance_in_limit);
  const double c = equal == EqualBalls::friction ? alone : compliance(terms.compliance_in_impulse);

  const Vec g = impact.before();
  const double g_n = impact.along(g), by_law = impact.separation_speed(g_n) - g_n;
  const Vec slip = g - impact.normal * g_n;
  double bounce = by_law;
  const auto& own = impact.event->body[0];
  if (by_logged_impulse && share[0] > 0)
    bounce = std::max(0.0, impact.along(Vec(own.velocity_after - own.velocity_before)) / share[0]);
  if (terms.friction_of_restitution) bounce = -(1 + impact.restitution(g_n)) * std::min(g_n, 0.0);
  const double e_t = impact.tangential_restitution(c_in_limit, bounce, size(slip));
  const Vec normal_part = impact.normal * by_law;
  const Vec tangential_part = slip * (-terms.friction * (1 - e_t) / c);
  Outcome result{impact.event->body, e_t};
  for (std::size_t k = 0; k < impact.count(); ++k) {
    const auto& ball = impact.ball[k];
    auto& body = result.body[k];
    const double side = k == 0 ? 1 : -1;
    body.velocity_after = body.velocity_before +
        (normal_part + tangential_part * terms.friction_on_velocity) * (side * share[k]);
    // Torque of the tangential impulse on an arm of -R n, of the other ball +R n: the same sign.
    const Vec torque = cross(Vec(impact.normal * -1.0), tangential_part);
    body.spin_after = body.spin_before +
        torque * (terms.torque * share[k] / (ball.radius * ball.reduced_inertia));
  }
  return result;
}

double velocity_scale(const LoggedImpact& impact, bool with_spins) {
  double scale = size(impact.wall_velocity);
  for (std::size_t k = 0; k < impact.count(); ++k) {
    const auto& body = impact.event->body[k];
    scale = std::max({scale, size(body.velocity_before), size(body.velocity_after)});
    if (with_spins)
      scale = std::max({scale, impact.ball[k].radius * size(body.spin_before),
          impact.ball[k].radius * size(body.spin_after)});
  }
  return scale;
}

double kinetic_change(const LoggedImpact& impact, double spin_factor) {
  double change = 0;
  for (std::size_t k = 0; k < impact.count(); ++k) {
    const auto& ball = impact.ball[k];
    const auto& b = impact.event->body[k];
    // (a - b).(a + b) loses fewer digits than a.a - b.b.
    change += ball.mass / 2 *
        dot(Vec(b.velocity_after - b.velocity_before), Vec(b.velocity_after + b.velocity_before));
    change += spin_factor * ball.mass * ball.reduced_inertia * ball.radius * ball.radius / 2 *
        dot(Vec(b.spin_after - b.spin_before), Vec(b.spin_after + b.spin_before));
  }
  return change;
}

double work_of_wall(const LoggedImpact& impact) {
  if (!impact.with_wall()) return 0;
  const auto& b = impact.event->body[0];
  return impact.ball[0].mass * dot(impact.wall_velocity, Vec(b.velocity_after - b.velocity_before));
}

Speeds speeds_before(const LoggedImpact& impact) {
  const Vec g = impact.before();
  return {impact.along(g), size(impact.across(g))};
}

double supplied(const LoggedImpact& impact, double g_n, double separation) {
  return std::max(0.0, impact.effective_mass / 2 * (separation - g_n) * (separation + g_n));
}

double dose_by_law(const LoggedImpact& impact, Speeds speeds) {
  const double separation = impact.separation_speed(speeds.g_n);
  const double bounce = separation - speeds.g_n;
  const double e_t = impact.tangential_restitution(impact.compliance, bounce, speeds.slip);
  const double normal = std::max(0.0, (-speeds.g_n - separation) * bounce);
  return impact.effective_mass / 2 *
      (normal + (1 - e_t * e_t) / impact.compliance * speeds.slip * speeds.slip);
}

}  // namespace edmill::audit
