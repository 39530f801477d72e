// What single contacts that last show of the contact law: a part of contact_audit.cpp. docs/dem.md, "What
// the audit compares"
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "dem/contacts.hpp"
#include "dem/soft_contact.hpp"
#include "identify/assumptions.hpp"

namespace edmill::dem {

/// What one single contact shows, and what the case has for it.
struct Measured {
  std::vector<std::string>
      parts;                      ///< of the contacts to which it belongs: "at cap -y", "of balls.1 at walls"
  double dose = 0;                ///< [J]
  double approach = 0, slip = 0;  ///< at the touch [m/s]
  double pressed = 0;             ///< what acts meanwhile adds to the approach, over it
  double turned = 0;              ///< by the normal meanwhile [rad]
  double slip_left = 0;           ///< along the slip at the touch, over it
  double wall_speed = 0;          ///< along the normal [m/s]
  // Of the case:
  double law_restitution = 0, law_friction = 0;
  // What it shows, of what it shows at all:
  std::optional<double> restitution = {};  ///< if nothing pressed
  std::optional<double> friction = {};     ///< impulse along the surfaces over that along the normal
  double wound = 0;  ///< the slip that only just stops, over that of a contact that slides throughout
  std::optional<double> stopping_friction = {};  ///< over what just stops the slip
  std::optional<double> spin_change = {};        ///< over that of the impulse, m J R^2 dw = -R n x m dv
  std::optional<double> wall_velocity = {};      ///< over that with which it has the restitution of the case
};

/// Relative velocity of two surfaces [m/s], seen along the unit normal towards the ball.
struct Surfaces {
  Vector normal;
  double separation;
  Vector along;

  Surfaces(const Vector& n, const Vector& velocity)
      : normal(n), separation(dot<double>(velocity, n)), along(velocity - n * separation) {}
};

/// The bodies of a contact in the case.
struct Bodies {
  std::vector<std::string> parts;
  const model::ContactLaw<double>& law;
  const model::BallProperties<double>& ball;
  model::ContactBodies<double> sizes;
  double compliance;  ///< 1 + M/(m_i J_i) + M/(m_j J_j)
};

/// While a contact lasts, walls turn and are round, the line of centres of a pair turns, and gravity acts:
/// this presses the bodies together or lifts them, as flights that go on through the contact show.
/// @param at  surfaces at a time, with the states of the ball and its partner
inline Measured measured_by(const Contact& c, const Vector& gravity, const Bodies& bodies, const auto& at) {
  const double duration = c.end - c.begin;
  const auto on = [&](const BallState& state) { return flown(state, gravity, duration); };
  const auto back = [&](const BallState& state) { return flown(state, gravity, -duration); };
  const Surfaces touch = at(c.begin, c.before, c.partner_before), leave = at(c.end, c.after, c.partner_after),
                 flown_on = at(c.end, on(c.before), on(c.partner_before)),
                 flown_back = at(c.begin, back(c.after), back(c.partner_after));
  Measured measured{.parts = bodies.parts,
                    .dose = c.dose,
                    .approach = -touch.separation,
                    .slip = norm<double>(touch.along)};
  if (!(measured.approach > 0)) return measured;
  bool has_friction = false;
  measured.law_restitution = bodies.law.restitution(measured.approach, bodies.sizes);
  bodies.law.parameters([&](const model::Parameter& p, double value) {
    if (p.key != std::string("friction")) return;
    has_friction = true;
    measured.law_friction = value;
  });
  // Flights before and after press by different amounts; friction leads from the one to the other.
  const double first = (touch.separation - flown_on.separation) / (2 * measured.approach),
               last = (flown_back.separation - leave.separation) / (2 * measured.approach),
               early = (3 * first + last) / 4, late = (first + 3 * last) / 4;
  measured.pressed = early + late;
  measured.turned = norm<double>(Vector(leave.normal - touch.normal));
  const double separation = leave.separation / measured.approach, e = measured.law_restitution;
  // What presses before the bodies are closest is an approach, what presses later brakes; both alike have
  // the effect c.
  measured.restitution = separation + (2 * press_effect(e) + e) * late - e * early;
  const Vector left = leave.along - (flown_on.along - touch.along);
  if (measured.slip > 0)
    measured.slip_left = dot<double>(left, touch.along) / (measured.slip * measured.slip);
  const Vector both = touch.normal + leave.normal, normal = both / norm<double>(both);
  const Vector change = c.after.velocity - c.before.velocity - gravity * duration,
               along = change - normal * dot<double>(change, normal),
               due = cross<double>(normal, along) / (-bodies.ball.reduced_inertia * bodies.ball.radius);
  const double friction = norm<double>(along) / dot<double>(change, normal);
  if (friction > 0.05)
    measured.spin_change = dot<double>(Vector(c.after.spin - c.before.spin), due) / dot<double>(due, due);
  if (!has_friction) return measured;
  // Slip above which the case's contact slides throughout.
  const double least =
      measured.law_friction * bodies.compliance * (1 + separation + measured.pressed) * measured.approach;
  measured.wound = least / measured.slip;
  if (measured.slip > least)
    measured.friction = friction;
  else if (measured.slip > 0.3 * least)
    measured.stopping_friction = friction * measured.wound / measured.law_friction;
  return measured;
}

/// The bodies of a case as its contacts name them.
class SingleContacts {
 public:
  /// The mill and the vessel must outlive it.
  /// @param gravity  in which the balls fly [m/s^2]
  SingleContacts(const casefile::CaseSpec& spec, const model::Mill<double>& mill, const MovingVessel& vessel,
                 const Vector& gravity)
      : mill_(mill), vessel_(vessel), gravity_(gravity), partners_(casefile::partners_of(spec)) {
    for (const auto& group : identify::ball_groups(spec))
      for (std::size_t k = group.first; k < group.last; ++k) kinds_.push_back(group.key);
  }

  Measured at_wall(const Contact& c) const {
    const auto ball = static_cast<std::size_t>(c.ball);
    const auto& b = vessel_.ball(ball);
    const Bodies bodies{parts_of({"at " + partners_[c.partner].label, "of " + kinds_[ball] + " at walls"},
                                 {ball}, "at walls"),
                        mill_.law_with_wall(b, c.partner),
                        b,
                        {b.mass, b.radius},
                        1 + 1 / b.reduced_inertia};
    const auto middle = vessel_.at((c.begin + c.end) / 2);
    auto measured = measured_by(c, gravity_, bodies, [&](double time, const BallState& i, const BallState&) {
      const auto pose = vessel_.at(time);
      const Vector n = vessel_.normal(pose, ball, c.partner, i.position), arm = n * -b.radius;
      return Surfaces(
          n, i.velocity + cross<double>(i.spin, arm) - vessel_.wall_velocity(pose, i.position + arm));
    });
    measured.wall_speed = dot<double>(vessel_.wall_velocity(middle, c.before.position),
                                      vessel_.normal(middle, ball, c.partner, c.before.position));
    const double change = (1 + measured.law_restitution) * measured.wall_speed;
    if (measured.restitution && std::abs(measured.wall_speed) > 0.3 * measured.approach)
      measured.wall_velocity =
          1 + (*measured.restitution - measured.law_restitution) * measured.approach / change;
    return measured;
  }

  Measured between_balls(const Contact& c) const {
    const auto one = static_cast<std::size_t>(c.ball), two = static_cast<std::size_t>(c.partner);
    const auto &a = vessel_.ball(one), &b = vessel_.ball(two);
    const double effective = a.mass * b.mass / (a.mass + b.mass);
    const auto [low, high] = std::minmax(kinds_[one], kinds_[two]);
    const Bodies bodies{
        parts_of({"between " + low + " and " + high}, {one, two}, "with balls"),
        mill_.law_between(a, b),
        a,
        {effective, a.radius, b.radius},
        1 + effective / (a.mass * a.reduced_inertia) + effective / (b.mass * b.reduced_inertia)};
    return measured_by(c, gravity_, bodies, [&](double, const BallState& i, const BallState& j) {
      const Vector apart = i.position - j.position, n = apart / norm<double>(apart);
      return Surfaces(
          n, i.velocity - j.velocity - cross<double>(Vector(i.spin * a.radius + j.spin * b.radius), n));
    });
  }

 private:
  /// With each ball by itself, where there are not too many.
  std::vector<std::string> parts_of(std::vector<std::string> parts, std::initializer_list<std::size_t> balls,
                                    const char* where) const {
    constexpr std::size_t most = 40;
    for (const auto ball : balls)
      if (kinds_.size() <= most) parts.push_back(fmt::format("of ball {} {}", ball, where));
    return parts;
  }

  const model::Mill<double>& mill_;
  const MovingVessel& vessel_;
  Vector gravity_;
  model::Partners partners_;
  std::vector<std::string> kinds_;  ///< of balls: the entry of the case that they are from
};

}  // namespace edmill::dem
