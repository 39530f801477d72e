#include "check/auditor.hpp"

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"

namespace edmill::audit {

namespace {

/// Bodies of an event: the ball, and its partner if that is a ball.
std::size_t bodies(const LoggedEvent& event) { return event.with_wall ? 1 : 2; }
int ball_of(const LoggedEvent& event, std::size_t body) { return body == 0 ? event.ball : event.partner; }
/// What a ball has hit: the other ball, or -1 - wall.
int other_of(const LoggedEvent& event, std::size_t body) {
  if (event.with_wall) return -1 - event.partner;
  return body == 0 ? event.partner : event.ball;
}

}  // namespace

Auditor::Auditor(const model::Case<double>& the_case, const Available& available,
                 const Tolerances& tolerances, Findings& findings)
    : case_(the_case),
      available_(available),
      tolerances_(tolerances),
      findings_(findings),
      impacts_(the_case.mill, available, tolerances, findings),
      flights_(the_case, available, tolerances, findings),
      last_(the_case.balls.size()),
      with_wall_(the_case.mill.vessel.walls().size()),
      early_by_wall_(with_wall_.size()) {}

void Auditor::begin(const std::vector<model::BallState<double>>& states, double time) {
  for (std::size_t k = 0; k < states.size(); ++k)
    flights_.begin_at_start(static_cast<int>(k), states[k], time);
}

void Auditor::tell(Kind kind, const LoggedEvent& event, double size, double found, double expected,
                   const char* note) {
  findings_.add({kind, size, event.line, event.time, event.ball, event.with_wall, event.partner, found,
                 expected, note});
}

void Auditor::take(LoggedEvent& event) {
  findings_.judged(Check::order);
  findings_.judged(Check::bodies);
  if (event.earlier_by > 0)
    tell(Kind::out_of_order, event, event.earlier_by, event.time, event.time + event.earlier_by);
  if (!event.problem.empty()) {
    tell(event.unknown_body ? Kind::unknown_body : Kind::not_finite, event, 1, unknown, unknown);
    const auto forget = [&](int k) {
      if (k >= 0 && k < flights_.balls()) flights_.of(k) = Track{};
    };
    forget(event.ball);
    if (!event.with_wall) forget(event.partner);
    return;
  }
  EDMILL_REQUIRE(
      event.ball >= 0 && event.ball < flights_.balls() && event.partner >= 0 &&
          event.partner < (event.with_wall ? static_cast<int>(with_wall_.size()) : flights_.balls()),
      "bodies that the case has");
  if (is_repeated(event)) return tell(Kind::duplicate, event, 0, unknown, unknown);

  Scene scene;
  scene.nested = flights_.nested_at(event.time);
  scene.printed = flights_.printed_at(event.time);
  find_wrong_balls(event);
  const Touch touch = judge_touch(event, scene);
  for (std::size_t body = 0; body < bodies(event); ++body)
    flights_.judge(ball_of(event, body), {&event, body, touch.late, touch.displaced});
  if (touch.usable) impacts_.judge(event, scene);

  for (std::size_t body = 0; body < bodies(event); ++body) {
    const int k = ball_of(event, body);
    flights_.begin(k, event.time, event.body[body], available_.body[body]);
    last_[static_cast<std::size_t>(k)] = {event.time, other_of(event, body), event.approach_speed,
                                          event.body[body].velocity_before, event.body[body].velocity_after};
  }
}

/// Bodies that have separated cannot have the same impact again at the same time.
bool Auditor::is_repeated(const LoggedEvent& event) const {
  const LastEvent& last = last_[static_cast<std::size_t>(event.ball)];
  if (last.time != event.time || last.other != other_of(event, 0)) return false;
  if (available_.body[0].velocity_before && available_.body[0].velocity_after) {
    // In a line with the roles exchanged, these are the states of the other ball.
    return last.velocity_before == event.body[0].velocity_before &&
           last.velocity_after == event.body[0].velocity_after && last.velocity_before != last.velocity_after;
  }
  return last.approach_speed == event.approach_speed && event.approach_speed > 0;
}

/// A ball that is not at the end of its flight, but at the end of another ball's flight, has the wrong
/// number.
void Auditor::find_wrong_balls(LoggedEvent& event) {
  for (std::size_t body = 0; body < bodies(event); ++body) {
    if (!available_.body[body].position || !available_.body[body].velocity_before) continue;
    const auto off = [&](int k) {
      const Track& track = flights_.of(k);
      if (!track.state_known || event.time < track.start) return -1.0;
      return size(Vec(flights_.position_at(k, event.time) - event.body[body].position));
    };
    const int named = ball_of(event, body);
    const double own = off(named), speed = size(event.body[body].velocity_before);
    const double path = own >= 0 ? speed * (event.time - flights_.of(named).start) : 0;
    if (own <= ball(named).radius / 100 + tolerances_.position(event.time, path, speed)) continue;
    for (int k = 0; k < flights_.balls(); ++k) {
      const double theirs = off(k);
      if (k == named || theirs < 0 || k == ball_of(event, 1 - body) ||
          theirs > tolerances_.position(event.time, speed * (event.time - flights_.of(k).start), speed))
        continue;
      tell(Kind::wrong_partner, event, own, named, k, "the states are another ball's");
      (body == 0 ? event.ball : event.partner) = k;
      break;
    }
  }
}

void Auditor::complete_scene(const LoggedEvent& event, Scene& scene) const {
  LoggedImpact& impact = scene.impact;
  impact.with_wall = event.with_wall;
  impact.ball[0] = ball(event.ball);
  if (event.with_wall)
    impact.wall = event.partner;
  else
    impact.ball[1] = ball(event.partner);
  impact.set_masses();
  impact.normal = {1, 0, 0};
  if (!available_.positions(event.with_wall)) return;
  if (event.with_wall) {
    impact.normal = wall_normal(scene.nested, case_.mill.vessel, event.partner, impact.ball[0].radius,
                                event.body[0].position);
    impact.wall_velocity = wall_velocity(WallVelocity::nested, scene.nested, scene.printed,
                                         event.body[0].position - impact.normal * impact.ball[0].radius,
                                         event.body[0].position) +
                           piston_velocity(scene.nested, impact.wall, impact.normal);
  } else {
    const Vec apart = event.body[0].position - event.body[1].position;
    const double distance = size(apart);
    if (distance > 0) impact.normal = apart * (1 / distance);
  }
}

void Auditor::tell_late(const LoggedEvent& event, const Scene& scene, double depth) {
  tell(Kind::late_event, event, depth, -depth, 0);
  if (!available_.velocities_before(event.with_wall)) return;
  const double closing = -dot(scene.impact.before(event), scene.impact.normal);
  if (closing > velocity_scale(scene.impact, event, false) / 10) latest_ = std::max(latest_, depth / closing);
}

auto Auditor::judge_touch(LoggedEvent& event, Scene& scene) -> Touch {
  complete_scene(event, scene);
  if (!available_.positions(event.with_wall)) return {};
  findings_.judged(Check::touch);
  const double speed = velocity_scale(scene.impact, event, false);
  const double allowed = tolerances_.touch(event.time, speed);
  if (event.with_wall) return judge_wall_touch(event, scene, allowed);
  const double gap = size(Vec(event.body[0].position - event.body[1].position)) - ball(event.ball).radius -
                     ball(event.partner).radius;
  if (gap < -allowed) tell_late(event, scene, -gap);
  if (gap > allowed) tell(Kind::early_event, event, gap, gap, 0);
  return {gap < -allowed, false, true};
}

auto Auditor::judge_wall_touch(LoggedEvent& event, Scene& scene, double allowed) -> Touch {
  const auto& vessel = case_.mill.vessel;
  const double radius = ball(event.ball).radius;
  const Vec& position = event.body[0].position;
  const auto wall = static_cast<std::size_t>(event.partner);
  ++with_wall_[wall];
  const double gap = wall_gap(scene.nested, vessel, event.partner, radius, position);
  if (std::abs(gap) <= allowed) return {};
  const double printed_gap = wall_gap(scene.printed, vessel, event.partner, radius, position);
  if (std::abs(printed_gap) <= allowed) {
    tell(Kind::rotation_order, event, std::abs(gap), gap, 0, "touches with the printed matrix (2.14)");
    // The other checks use the wall as that code has it.
    scene.displaced = true;
    scene.impact.normal = wall_normal(scene.printed, vessel, event.partner, radius, position);
    const Vec point = position - scene.impact.normal * radius;
    scene.impact.wall_velocity =
        wall_velocity(WallVelocity::nested, scene.nested, scene.printed, point, position) +
        piston_velocity(scene.nested, event.partner, scene.impact.normal);
    return {gap < 0, true, true};
  }
  if (another_body_is_there(event, allowed, gap)) {
    if (!event.with_wall) return {false, false, false};  // the partner's state is not in the log
    complete_scene(event, scene);
    return {};
  }
  if (gap < 0) {
    tell_late(event, scene, -gap);
    return {true, false, true};
  }
  ++early_by_wall_[wall];
  tell(Kind::early_event, event, gap, gap, 0);
  return {};
}

/// Finds the body that is actually touched; the other checks of the event use it.
bool Auditor::another_body_is_there(LoggedEvent& event, double allowed, double gap) {
  const auto frame = flights_.nested_at(event.time);
  const double radius = ball(event.ball).radius;
  const Vec& position = event.body[0].position;
  for (int wall = 0; wall < static_cast<int>(with_wall_.size()); ++wall)
    if (wall != event.partner && std::abs(gap) > radius / 100 &&
        std::abs(wall_gap(frame, case_.mill.vessel, wall, radius, position)) <= allowed) {
      tell(Kind::wrong_partner, event, std::abs(gap), event.partner, wall, "another wall is touched");
      event.partner = wall;
      return true;
    }
  for (int k = 0; k < flights_.balls(); ++k) {
    if (k == event.ball || !flights_.of(k).state_known || event.time < flights_.of(k).start) continue;
    const double apart = size(Vec(flights_.position_at(k, event.time) - position)) - radius - ball(k).radius;
    if (std::abs(apart) <= allowed && std::abs(gap) > radius / 100) {
      tell(Kind::wrong_partner, event, std::abs(gap), event.partner, k, "a ball is touched, and no wall");
      flights_.of(k) = Track{};
      event.with_wall = false;
      event.partner = k;
      return true;
    }
  }
  return false;
}

}  // namespace edmill::audit
