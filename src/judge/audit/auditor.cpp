#include "audit/auditor.hpp"

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"

namespace edmill::audit {

namespace {

/// What a ball has hit: the other ball, or -1 - wall.
int other_of(const LoggedEvent& event, std::size_t body) {
  if (event.with_wall) return -1 - event.partner;
  return body == 0 ? event.partner : event.ball;
}

}  // namespace

void Auditor::begin(const std::vector<model::BallState<double>>& states, double time) {
  for (std::size_t k = 0; k < states.size(); ++k)
    flights_.begin_at_start(static_cast<int>(k), states[k], time);
  stalls_.begin(time);
}

void Auditor::take(LoggedEvent& event) {
  findings_.judged(Check::order);
  findings_.judged(Check::bodies);
  if (event.earlier_by > 0)
    tell(Kind::out_of_order, event, event.earlier_by, event.time, event.time + event.earlier_by);
  if (!event.problem.empty()) {
    tell(event.unknown_body ? Kind::unknown_body : Kind::not_finite, event, 1, unknown, unknown);
    const auto forget = [&](int k) {
      if (k < 0 || k >= flights_.balls()) return;
      flights_.of(k) = Track{};
      stalls_.forget(k);
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
  scene.friction = stalls_.take(event, *scene.impact.law, tolerances_.relative);
  for (std::size_t body = 0; body < event.count(); ++body)
    flights_.judge(event.ball_at(body), {&event, body, touch.late, touch.displaced});
  if (touch.usable) impacts_.judge(scene);

  for (std::size_t body = 0; body < event.count(); ++body) {
    const int k = event.ball_at(body);
    flights_.begin(k, event.time, event.body[body], available_.body[body]);
    last_[k] = {event.time, other_of(event, body), event.approach_speed, event.body[body].velocity_before,
                event.body[body].velocity_after};
  }
}

/// Bodies that have separated cannot have the same impact again at the same time.
bool Auditor::is_repeated(const LoggedEvent& event) const {
  const LastEvent& last = last_[event.ball];
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
  for (std::size_t body = 0; body < event.count(); ++body) {
    if (!available_.body[body].position || !available_.body[body].velocity_before) continue;
    const auto off = [&](int k) {
      const Track& track = flights_.of(k);
      if (!track.state_known || event.time < track.start) return -1.0;
      return size(Vec(flights_.position_at(k, event.time) - event.body[body].position));
    };
    const int named = event.ball_at(body);
    const double own = off(named), speed = size(event.body[body].velocity_before);
    const double path = own >= 0 ? speed * (event.time - flights_.of(named).start) : 0;
    const double allowed = tolerances_.position(event.time, path, speed), radius = radius_of(named);
    // Balls that may be half a radius away are not told from each other.
    if (own <= radius / 100 + allowed || allowed > radius / 2) continue;
    for (int k = 0; k < flights_.balls(); ++k) {
      const double theirs = off(k);
      if (k == named || theirs < 0 || k == event.ball_at(1 - body) ||
          !vanishes(own, theirs,
                    tolerances_.position(event.time, speed * (event.time - flights_.of(k).start), speed)))
        continue;
      tell(Kind::wrong_partner, event, own, named, k, "the states are another ball's");
      (body == 0 ? event.ball : event.partner) = k;
      break;
    }
  }
}

/// Notes how late an event is that does not come before its bodies touch.
void Auditor::note_delay(const LoggedEvent& event, const Scene& scene, double depth) {
  if (!available_.velocities_before(event.with_wall)) return;
  const double closing = -scene.impact.g_n();
  if (closing > velocity_scale(scene.impact, false) / 10)
    delays_.add(event.with_wall ? event.partner : -1, std::max(depth, 0.0) / closing);
}

auto Auditor::judge_touch(LoggedEvent& event, Scene& scene) -> Touch {
  const bool placed = available_.positions(event.with_wall);
  scene.impact = impact_of(event, case_, scene.nested, placed);
  if (!placed) return {};
  if (event.with_wall) return judge_wall_touch(event, scene);
  findings_.judged(Check::touch);
  const double gap = gap_of(event, case_, scene.nested);
  const bool late = gap < -tolerances_.gap;
  if (late) tell(Kind::late_event, event, -gap, gap, 0);
  if (gap > tolerances_.gap)
    tell(Kind::early_event, event, gap, gap, 0);
  else
    note_delay(event, scene, late ? -gap : 0);
  return {late, false, true};
}

auto Auditor::judge_wall_touch(LoggedEvent& event, Scene& scene) -> Touch {
  const double radius = radius_of(event.ball), allowed = tolerances_.touch(event.time, true);
  ++with_wall_[event.partner];
  // A wall that may be half a radius away is not told from what is beside it.
  if (tolerances_.wall_places(event.time) > radius / 2) {
    findings_.unresolved(Check::touch);
    return {};
  }
  findings_.judged(Check::touch);
  const double gap = gap_of(event, case_, scene.nested);
  if (std::abs(gap) > allowed) return judge_off_the_wall(event, scene, gap, allowed);
  note_delay(event, scene, 0);
  if (rotations_.is_suspected() && std::abs(gap_of(event, case_, scene.printed)) > allowed)
    rotations_.contradicted();
  return {};
}

auto Auditor::judge_off_the_wall(LoggedEvent& event, Scene& scene, double gap, double allowed) -> Touch {
  const auto& vessel = case_.mill.vessel;
  const double radius = radius_of(event.ball);
  const Vec& position = event.body[0].position;
  const double printed_gap = std::abs(gap_of(event, case_, scene.printed));
  const auto off_the_wall =
      finding(gap < 0 ? Kind::late_event : Kind::early_event, event, std::abs(gap), gap, 0);
  if (vanishes(std::abs(gap), printed_gap, allowed)) {
    rotations_.explains(std::abs(gap), printed_gap)
        .add(finding(Kind::rotation_order, event, std::abs(gap), gap, 0,
                     "touches with the printed matrix (2.14)", true));
    rotations_.plain().add(off_the_wall);
    flights_.set_printed_walls(rotations_.is_named());
    // The other checks use the wall as that code has it.
    scene.displaced = true;
    scene.impact.normal = wall_normal(scene.printed, vessel, event.partner, radius, position);
    scene.impact.set_wall_velocity(wall_velocities[0], scene.nested, scene.printed);
    return {gap < 0, true, true};
  }
  if (rotations_.is_suspected()) rotations_.contradicted();
  if (another_body_is_there(event, allowed, gap)) {
    if (!event.with_wall) return {false, false, false};  // the partner's state is not in the log
    scene.impact = impact_of(event, case_, scene.nested, true);
    return {};
  }
  findings_.add(off_the_wall);
  if (gap < 0) note_delay(event, scene, -gap);
  return {gap < 0, false, true};
}

/// Finds the body that is actually touched; the other checks of the event use it.
bool Auditor::another_body_is_there(LoggedEvent& event, double allowed, double gap) {
  const auto frame = flights_.nested_at(event.time);
  const double radius = radius_of(event.ball);
  const Vec& position = event.body[0].position;
  for (int wall = 0; wall < static_cast<int>(with_wall_.size()); ++wall)
    if (wall != event.partner && std::abs(gap) > radius / 100 &&
        vanishes(std::abs(gap), std::abs(wall_gap(frame, case_, wall, event.ball, position)), allowed)) {
      tell(Kind::wrong_partner, event, std::abs(gap), event.partner, wall, "another wall is touched");
      event.partner = wall;
      return true;
    }
  for (int k = 0; k < flights_.balls(); ++k) {
    if (k == event.ball || !flights_.of(k).state_known || event.time < flights_.of(k).start) continue;
    const Vec between = flights_.position_at(k, event.time) - position;
    const double apart = std::abs(size(between) - radius - radius_of(k));
    if (vanishes(std::abs(gap), apart, allowed) && std::abs(gap) > radius / 100) {
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
