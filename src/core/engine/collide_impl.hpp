// Implementation of Simulation: impacts; included by the instantiation files only.
#pragma once

#include "base/errors.hpp"
#include "engine/simulation.hpp"

namespace edmill::engine {

/// Advances the balls of a contact to it and applies the impulse.
template <class Real>
Impact<Real> Simulation<Real>::collide(const Event<Real>& event) {
  if (event.by_rule) ++counts_.simultaneous_contacts;
  auto impact = event.kind == EventKind::wall_contact ? collide_with_wall(event) : collide_pair(event);
  impact.index = counts_.impacts++;
  impact.time = now_;
  impact.ball = event.ball;
  impact.with_wall = event.kind == EventKind::wall_contact;
  impact.partner = event.partner;
  impact.by_rule = event.by_rule;
  if (impact.overlap > counts_.deepest_overlap) counts_.deepest_overlap = impact.overlap;
  EDMILL_REQUIRE(impact.overlap < tolerated_overlap_,
                 "an impact was missed: bodies overlap by " + to_text(impact.overlap) + " m");
  raise_top_speed(event.ball);
  if (!impact.with_wall) raise_top_speed(event.partner);
  return impact;
}

/// Sets the pose to that of now.
template <class Real>
void Simulation<Real>::update_pose() {
  model::with_parts<Real>(mill_.motion, mill_.vessel, [&]<class M>(const M& motion, const auto&) {
    if constexpr (std::is_same_v<M, model::AnyMotion<Real>>)
      pose_ = motion.pose(now_);
    else
      pose_.template emplace<typename M::Pose>(motion.pose(now_));
  });
}

/// Updates the pose when the ball's predicted wall contact is due, whose pose a wide scalar has kept.
template <class Real>
void Simulation<Real>::update_pose_at_wall_contact(int ball) {
  if constexpr (!std::is_same_v<Real, double>) {
    const Agenda<Real>& a = agendas_[ball];
    if (a.wall_pose && a.times[Agenda<Real>::wall_entry] == now_) {
      pose_ = *a.wall_pose;
      return;
    }
  }
  update_pose();
}

template <class Real>
Impact<Real> Simulation<Real>::collide_with_wall(const Event<Real>& event) {
  const int ball = event.ball, wall = event.partner;
  find_neighbours(ball, near_);
  auto& flight = flights_[ball];
  const Real flight_time = dynamics::fly_to(flight, mill_.gravity, clock_, now_);
  update_pose_at_wall_contact(ball);
  const Real radius = properties(ball).radius;

  Impact<Real> impact{};
  model::with_parts<Real>(
      mill_.motion, mill_.vessel, [&]<class M, class V>(const M& motion, const V& vessel) {
        const auto& pose = model::pose_of<M>(pose_);
        const auto place = motion.position_in_vessel(pose, flight.position);
        const auto room = vessel.inset(radius);
        impact.normal = motion.direction_to_inertial(pose, room.normal(wall, place));
        impact.overlap = room.overlap(wall, place);
        impact.wall_velocity = motion.wall_velocity(pose, flight.position - impact.normal * radius);
      });
  if (const auto* pistons = mill_.vessel.pistons()) {
    const auto moved = pistons->of_wall(wall, now_);
    impact.overlap += moved.value;
    impact.wall_velocity += impact.normal * moved.rate;
  }
  impact.velocity_before[0] = flight.velocity;
  impact.spin_before[0] = bodies_[ball].spin;
  impact.flight_time[0] = flight_time;
  const auto& law = mill_.law_with_wall(properties(ball), wall);
  impact.outcome = dynamics::collide_with_wall<Real>(impact.normal, properties(ball), impact.wall_velocity,
                                                     flight.velocity, bodies_[ball].spin, law,
                                                     friction_rests(ball, flight_time, law));
  agendas_.number_impact(ball, ball);
  candidates_.update(ball);
  return impact;
}

template <class Real>
Impact<Real> Simulation<Real>::collide_pair(const Event<Real>& event) {
  const int ball = event.ball, partner = event.partner;
  find_neighbours(ball, near_);
  auto &one = flights_[ball], &two = flights_[partner];
  const Real flight_times[2] = {dynamics::fly_to(one, mill_.gravity, clock_, now_),
                                dynamics::fly_to(two, mill_.gravity, clock_, now_)};
  const Vec3<Real> between = one.position - two.position;
  const Real distance = norm<Real>(between);

  Impact<Real> impact{};
  impact.normal = between * (1 / distance);
  impact.overlap = properties(ball).radius + properties(partner).radius - distance;
  impact.velocity_before[0] = one.velocity;
  impact.velocity_before[1] = two.velocity;
  impact.spin_before[0] = bodies_[ball].spin;
  impact.spin_before[1] = bodies_[partner].spin;
  impact.flight_time[0] = flight_times[0], impact.flight_time[1] = flight_times[1];
  const auto& law = mill_.law_between(properties(ball), properties(partner));
  const bool rests_for_one = friction_rests(ball, flight_times[0], law),
             rests_for_two = friction_rests(partner, flight_times[1], law);
  impact.outcome = dynamics::collide_balls<Real>(impact.normal, properties(ball), properties(partner),
                                                 one.velocity, bodies_[ball].spin, two.velocity,
                                                 bodies_[partner].spin, law, rests_for_one || rests_for_two);
  agendas_.number_impact(ball, partner);
  candidates_.update(ball);
  candidates_.update(partner);
  find_neighbours(partner, near_partner_);
  return impact;
}

/// Counts the ball's impacts that came without time to move. @return whether there were so many in a row
/// before this one that friction rests
template <class Real>
bool Simulation<Real>::friction_rests(int ball, const Real& flight_time, const model::ContactLaw<Real>& law) {
  auto& unmoved = bodies_[ball].unmoved;
  if (mill_.stall.has_moved(flight_time, law.least_separation)) [[likely]] {
    unmoved = 0;
    return false;
  }
  if (unmoved >= mill_.stall.impacts) return true;
  ++unmoved;
  return false;
}

/// Bounds that grow with the speed of the fastest ball follow the ball's new velocity.
template <class Real>
void Simulation<Real>::raise_top_speed(int ball) {
  const Real fastest = top_speed_ - fall_;
  const Real speed_squared = squared_norm<Real>(flights_[ball].velocity);
  if (!(speed_squared > fastest * fastest)) return;
  using std::sqrt;
  top_speed_ = 2 * sqrt(speed_squared) + fall_;
  ladder_.raise_top_speed(top_speed_);
  candidates_.raise_top_speed(top_speed_);
}

/// Whether the impact is one of infinitely many in finite time, or of many while the clock stands still; then
/// everybody who watches is told of it.
template <class Real>
void Simulation<Real>::notify(const Impact<Real>& impact) {
  if (may_collapse_ && impact.with_wall) {
    note_collapse(impact, impact.ball, ball_count() + impact.partner, true, impact.partner);
  } else if (may_collapse_) {
    note_collapse(impact, impact.ball, impact.partner, false, impact.partner);
    note_collapse(impact, impact.partner, impact.ball, false, impact.ball);
  }
  if (stall_watch_.note(now_, clock_, impact.ball, impact.with_wall, impact.partner)) {
    stall_ = stall_watch_.found();
    stop_ = EndReason::stalled;
  }
  for (auto* observer : observers_) observer->on_impact(impact, *this);
}

template <class Real>
void Simulation<Real>::note_collapse(const Impact<Real>& impact, int ball, int key, bool with_wall,
                                     int partner) {
  const auto& law = with_wall ? mill_.law_with_wall(properties(ball), partner)
                              : mill_.law_between(properties(ball), properties(partner));
  if (law.least_separation > 0) return;
  const Real slow = std::max(slow_, Real(1000 * epsilon<Real>() * top_speed_));
  const bool collapsing = collapse_watch_.note(bodies_[ball].recent, key, now_, impact.outcome.approach_speed,
                                               slow, impact.outcome.restitution_normal(), clock_);
  if (!collapsing) return;
  collapse_ = model::InelasticCollapse<Real>{ball, with_wall, partner,
                                             collapse_watch_.accumulation_time(bodies_[ball].recent, clock_)};
  stop_ = EndReason::inelastic_collapse;
}

}  // namespace edmill::engine
