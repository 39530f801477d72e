// Implementation of Simulation: set-up, saving, and the loop; for the instantiation files only.
#pragma once

#include <algorithm>
#include <boost/math/special_functions/cbrt.hpp>
#include <vector>

#include "base/errors.hpp"
#include "base/interruption.hpp"
#include "engine/simulation.hpp"

namespace edmill::engine {

// Bounds that are valid for every ball of a run.

template <class Real> bool all_alike(const Balls<Real>& balls) {
  return std::all_of(balls.begin(), balls.end(), [&](const auto& b) { return b == balls.front(); });
}

template <class Real> Real smallest_radius(const Balls<Real>& balls) {
  const auto smaller = [](const auto& a, const auto& b) { return a.radius < b.radius; };
  return std::min_element(balls.begin(), balls.end(), smaller)->radius;
}

/// The most that gravity adds to a ball's speed in one flight [m/s]: the deflection g t^2/8 of a
/// flight that stays within `reach` of the origin is below 2 reach.
template <class Real> Real largest_fall(const model::Mill<Real>& mill) {
  using std::sqrt;
  const Real reach = mill.motion.reach(mill.vessel.reach());
  return 4 * sqrt(reach * norm<Real>(mill.gravity));
}

/// Relative speed that two bodies gain over a path by the accelerations of walls and gravity [m/s].
template <class Real> Real speed_over(const Real& path, const model::Mill<Real>& mill) {
  using std::sqrt;
  const Real reach = mill.motion.reach(mill.vessel.extent());
  Real acceleration = mill.motion.acceleration_within(reach) + norm<Real>(mill.gravity);
  if (const auto* pistons = mill.vessel.pistons()) acceleration += pistons->bound(2);
  for (const auto& body : mill.bodies) acceleration += body.motion.acceleration_within(reach);
  return sqrt(2 * acceleration * path);
}

/// Shortest significant advance of the clock [s]: less moves no ball, or is mere rounding.
template <class Real> Real shortest_advance(const model::Mill<Real>& mill) {
  const Real by_rule = mill.least_separations().second / mill.stall.acceleration;
  return std::max(by_rule, Real(1000000 * epsilon<Real>() * mill.motion.period()));
}

/// Bound on the speed of all balls [m/s], until one has twice that of the fastest at the start.
template <class Real> Real top_speed_of(const States<Real>& states, const model::Mill<Real>& mill) {
  Real largest{1};
  for (const auto& s : states) largest = std::max(largest, norm<Real>(s.velocity));
  Real wall = mill.motion.speed_within(mill.motion.reach(mill.vessel.extent()));
  if (const auto* pistons = mill.vessel.pistons()) wall += pistons->bound(1);
  for (const auto& body : mill.bodies)
    wall = std::max(wall, body.motion.wall_speed(body.shape.size()));
  return 2 * (largest + wall) + largest_fall(mill);
}

/// Divides the region that the vessel sweeps into cells of about one ball, thicker than any.
template <class Real> CellGrid make_grid(const model::Mill<Real>& mill, const Balls<Real>& balls) {
  const auto region = mill.motion.swept(mill.vessel.half_sizes(), mill.vessel.reach());
  Real largest{0};
  for (const auto& b : balls) largest = std::max(largest, b.radius);
  // The C library's cube root is not the same on every machine; nor is long double.
  using boost::math::policies::promote_double;
  constexpr boost::math::policies::policy<promote_double<false>> portable;
  const auto volume = static_cast<double>(mill.vessel.volume());
  const double spacing =
      0.45 * boost::math::cbrt(volume / static_cast<double>(balls.size()), portable);
  Real edge = 2 * largest * (1 + Real(1) / 1024);
  if (balls.size() <= 32) edge = 2 * (region.high - region.low).maxCoeff();
  if (edge < spacing) edge = Real(spacing);
  return CellGrid(vector_cast<double>(region.low), vector_cast<double>(region.high),
      static_cast<double>(edge), static_cast<int>(balls.size()));
}

template <class Real>
Candidates<Real>::Candidates(const model::Mill<Real>& mill, const Balls<Real>& balls,
    const LargeVector<dynamics::Flight<Real>>& flights, const Real& reach, const Real& top_speed)
    : flights_(&flights),
      pairs_(model::mill_cast<double>(mill), 2 * static_cast<double>(smallest_radius(balls)),
          static_cast<double>(reach), static_cast<double>(top_speed)),
      stride_(all_alike(balls) ? 0 : 1), grid_(make_grid(mill, balls)) {
  for (const auto& ball : balls) radii_.push_back(static_cast<double>(ball.radius));
  if constexpr (!is_double) double_flights_.resize(balls.size());
  if (grid_.single_cell()) columns_.emplace(static_cast<int>(balls.size()), stride_ == 0);
}

template <class Real> CellOfBall Candidates<Real>::insert(int ball) {
  const CellOfBall cell = grid_.insert(ball, vector_cast<double>((*flights_)[ball].position));
  update(ball);
  return cell;
}

template <class Real>
Simulation<Real>::Simulation(const model::Case<Real>& the_case, const States<Real>& states,
    const Instant& start, const std::atomic<bool>* interrupt)
    : mill_(the_case.mill), clock_(mill_.motion.period()), balls_(the_case.balls),
      stride_(all_alike(balls_) ? 0 : 1), agendas_(states.size()),
      top_speed_(top_speed_of(states, mill_)),
      ladder_(mill_, 2 * smallest_radius(balls_), top_speed_),
      candidates_(mill_, balls_, flights_, ladder_.walls().reach(), top_speed_),
      queue_(static_cast<int>(states.size()), clock_.period()),
      prefetcher_(queue_, agendas_, flights_, bodies_, candidates_),
      collapse_watch_(Real(1000000) * epsilon<Real>() / 2 * ladder_.walls().reach()),
      may_collapse_(!(mill_.least_separations().first > 0)),
      slow_(speed_over(collapse_watch_.smallest_path(), mill_)),
      stall_watch_(states.size(), start, shortest_advance(mill_)), now_(start),
      tolerated_overlap_(2 * smallest_radius(balls_) / 1000000), fall_(largest_fall(mill_)) {
  EDMILL_REQUIRE(!balls_.empty() && balls_.size() == states.size(), "one state for each ball");
  for (const auto& s : states) {
    flights_.push_back({s.position, s.velocity, start});
    bodies_.push_back({s.spin, {}, 0, {}});
  }
  for (int i = 0; i < ball_count(); ++i) bodies_[i].cell = candidates_.insert(i);
  prefetch(ball_count() > Prefetcher<Real>::worthwhile);
  update_pose();
  const Interruption scope(interrupt);
  for (int i = 0; i < ball_count(); ++i) {
    Interruption::check();
    find_neighbours(i, near_);
    predict_all(i, -1, pose_, near_);
  }
}

template <class Real> void Simulation<Real>::archive(Archive& a) {
  const auto balls = flights_.size();
  if (!a.loading())
    agendas_.renumber_impacts();  // often enough for tests to see that it changes nothing
  a(flights_, bodies_, agendas_, ladder_, candidates_, counts_, stall_watch_, now_, top_speed_);
  if (!a.loading()) return;
  EDMILL_REQUIRE(
      flights_.size() == balls && agendas_.size() == balls, "a saved state of the same case");
  if (!is_sound()) throw InputError("the saved state is not one of a run of this case");
  ladder_.raise_top_speed(top_speed_);
  candidates_.raise_top_speed(top_speed_);
  for (int i = 0; i < ball_count(); ++i) {
    candidates_.update(i);
    requeue(i);  // equal times go to the lower ball, whatever the queue's history
  }
}

/// True if a loaded state, which can come from elsewhere, has all that the loop relies on.
template <class Real> bool Simulation<Real>::is_sound() const {
  using std::isfinite;
  const std::int64_t most = Instant::never().period;
  const auto timed = [&](const Instant& t) {
    return t.period >= -most && t.period <= most && t.offset >= 0 && t.offset <= clock_.period();
  };
  const auto finite = [](const Vec3<Real>& v) {
    return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]);
  };
  const auto cell_of = [this](int ball) -> const CellOfBall& { return bodies_[ball].cell; };
  bool sound = timed(now_) && stall_watch_.is_sound(ball_count(), mill_.wall_count()) &&
      now_.period < most && isfinite(top_speed_) && top_speed_ >= 0 &&
      candidates_.grid().holds_all(cell_of);
  for (int i = 0; sound && i < ball_count(); ++i) {
    const auto& [position, velocity, start] = flights_[i];
    const auto& [spin, recent, unmoved, cell] = bodies_[i];
    const auto& agenda = agendas_[i];
    sound = finite(position) && finite(velocity) && finite(spin) && timed(start) &&
        !(now_ < start) && timed(recent.last) && recent.burst >= 0 &&
        recent.burst <= CollapseWatch<Real>::enough && unmoved >= 0 &&
        unmoved <= mill_.stall.impacts && timed(agenda.forgotten_from) &&
        agenda.is_sound(ball_count(), mill_.wall_count(), agendas_.latest_impact()) &&
        !(top_speed_ * top_speed_ < squared_norm<Real>(velocity));
    for (const auto& time : agenda.times) sound = sound && timed(time) && !(time < now_);
  }
  return sound;
}

template <class Real>
model::BallState<Real> Simulation<Real>::state_at(int i, const Instant& when) const {
  const Real dt = clock_.elapsed(flights_[i].start, when);
  return {dynamics::position_after(flights_[i], mill_.gravity, dt),
      dynamics::velocity_after(flights_[i], mill_.gravity, dt), bodies_[i].spin};
}

template <class Real> model::Energy<Real> Simulation<Real>::energy_at(const Instant& when) const {
  model::Energy<Real> energy;
  for (int i = 0; i < ball_count(); ++i)
    energy += model::energy_of<Real>(properties(i), state_at(i, when), mill_.gravity);
  return energy;
}

// The loop: the next event, the order of contacts that are close in time, impacts, and predictions.

template <class Real>
EndReason Simulation<Real>::run_until(const Instant& end, const std::atomic<bool>* interrupt) try {
  const Interruption scope(interrupt);
  stop_.reset();
  for (int next = queue_.top(); queue_.time(next) <= end; next = queue_.top()) {
    if (interrupt && interrupt->load(std::memory_order_relaxed)) return EndReason::interrupted;
    const auto event = event_of(next);  // or an earlier one that nearly ties with it
    prefetcher_.begin();
    now_ = event.time;
    switch (event.kind) {
      case EventKind::void_contact: drop_void_contact(event.ball); break;
      case EventKind::cell_crossing: cross_cell(event.ball); break;
      case EventKind::wall_horizon: continue_wall_search(event.ball, now_); break;
      case EventKind::wall_contact:
      case EventKind::pair_contact: {
        const auto impact = collide(event);
        notify(impact);
        if (stop_ != EndReason::inelastic_collapse) predict(impact);
      }
    }
    prefetcher_.finish();
    if (stop_) return *stop_;
  }
  now_ = end;
  return EndReason::end_time;
} catch (const InterruptedError&) {  // from a search before an event
  return EndReason::interrupted;
}

/// The next event, where `ball` is the first in the queue: the queued event of this ball, unless
/// that is a contact and another one is simultaneous within rounding.
template <class Real> auto Simulation<Real>::event_of(int ball) -> Event {
  auto event = queued_event(ball);
  const bool with_wall = event.kind == EventKind::wall_contact;
  if ((with_wall || event.is_pair()) && has_rivals(event)) event = settle_ties(event);
  // Where times are closer than their errors the ladder may have put the later one first.
  if (event.time < now_) event.time = now_;
  return event;
}

template <class Real> auto Simulation<Real>::queued_event(int ball) const -> Event {
  const Agenda& a = agendas_[ball];
  const Instant& time = a.times[a.next];
  if (a.next == crossing_entry) return {EventKind::cell_crossing, time, ball};
  if (a.next == wall_entry && !a.hits_wall()) return {EventKind::wall_horizon, time, ball};
  if (a.next == wall_entry)
    return {EventKind::wall_contact, time, ball, a.wall_id(), a.wall_is_tied()};
  const bool holds = agendas_.still_holds(a, a.next);
  return {
      holds ? EventKind::pair_contact : EventKind::void_contact, time, ball, a.partner_at(a.next)};
}

template <class Real> void Simulation<Real>::requeue(int ball) {
  Agenda& a = agendas_[ball];
  a.next = static_cast<std::int8_t>(a.earliest());
  queue_.set(ball, a.times[a.next]);
}

/// Drops the nearest pair contact of a ball, which is void; the next one takes its place.
template <class Real> void Simulation<Real>::drop_void_contact(int ball) {
  ++counts_.stale_events;
  Agenda& a = agendas_[ball];
  a.drop_nearest();
  if (a.pair_count == 0 && a.forgotten_from < Instant::never()) {
    find_neighbours(ball, near_);
    a.drop_pairs();
    const auto state = candidates_.state(ball, now_);
    predict_pairs(ball, -1, state, candidates_.find(ball, state, now_, near_), near_);
  }
  requeue(ball);
}

/// Moves a ball to the next cell and predicts its contacts with the balls of new neighbours.
template <class Real> void Simulation<Real>::cross_cell(int ball) {
  ++counts_.cell_crossings;
  const int axis = agendas_[ball].crossing_axis(), step = agendas_[ball].crossing_step();
  candidates_.cross(ball, bodies_[ball].cell, axis, step, near_);
  prefetcher_.flights_of(near_);
  const auto state = candidates_.state(ball, now_);
  const int found = candidates_.find_among(ball, state, now_, near_);
  predict_crossing(ball, state);
  predict_pairs(ball, -1, state, found, near_);
  requeue(ball);
}

/// True if another event follows a contact so soon that it may be first, which is rare.
template <class Real> bool Simulation<Real>::has_rivals(const Event& event) const {
  const Instant limit = clock_.after(event.time, ladder_.tie_window());
  const Agenda& a = agendas_[event.ball];
  int due = (a.times[wall_entry] <= limit) + (a.forgotten_from <= limit);
  for (int k = 0; k < Agenda::capacity; ++k) due += a.times[first_pair + k] <= limit;
  return due > 1 || queue_.has_more_until(limit);  // one is the event itself
}

/// Finds the first of contacts that share a ball and are so close in time that rounding may have
/// reversed them: wider scalars recompute the times. A rule orders and marks the inseparable ones.
template <class Real> auto Simulation<Real>::settle_ties(Event event) -> Event {
  // Continues wall searches whose windows end before `limit`: a contact may follow immediately.
  const auto finish = [&](int ball, const Instant& limit) {
    const Agenda& a = agendas_[ball];
    while (!a.hits_wall() && a.times[wall_entry] <= limit)
      continue_wall_search(ball, Instant(a.times[wall_entry]));
  };
  std::vector<Event> passed;  // contacts that come after another one
  for (;;) {
    const Instant limit = clock_.after(event.time, ladder_.tie_window());
    finish(event.ball, limit);
    if (event.is_pair()) finish(event.partner, limit);
    find_rivals(event, limit);
    std::optional<Event> first;
    for (const Event& rival : rivals_) {
      const auto same = [&](const Event& e) { return e.same_bodies(rival); };
      if (std::any_of(passed.begin(), passed.end(), same)) continue;
      const int order = ladder_.order(contact_of(event), contact_of(rival));
      event.by_rule |= order == 0;
      if (order < 0 || (order == 0 && !rival.goes_before(event))) continue;
      first = rival;
      first->by_rule |= order == 0;
      break;
    }
    if (!first) return event;
    passed.push_back(event);
    event = *first;
  }
}

/// Fills `rivals_` with the contacts up to `limit` that share a ball with the event.
template <class Real> void Simulation<Real>::find_rivals(const Event& event, const Instant& limit) {
  rivals_.clear();
  std::vector<int> near;  // and no others, however many have events at the same time
  add_near(event.ball, near);
  if (event.is_pair()) add_near(event.partner, near);
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
  for (const int ball : near) {
    if (limit < queue_.time(ball)) continue;
    const Agenda& a = agendas_[ball];
    const auto add = [&](const Event& rival) {
      if (rival.shares_ball(event) && !rival.same_bodies(event)) rivals_.push_back(rival);
    };
    const Instant& wall_time = a.times[wall_entry];
    if (a.hits_wall() && wall_time <= limit)
      add({EventKind::wall_contact, wall_time, ball, a.wall_id(), a.wall_is_tied()});
    for (int entry = first_pair; entry < first_pair + a.pair_count; ++entry)
      if (a.times[entry] <= limit && agendas_.still_holds(a, entry))
        add({EventKind::pair_contact, a.times[entry], ball, a.partner_at(entry)});
    if (a.forgotten_from <= limit) add_rivals_of_full_agenda(ball, event, limit);
  }
}

/// Adds the balls of the adjacent cells and the ball itself.
template <class Real> void Simulation<Real>::add_near(int ball, std::vector<int>& balls) {
  FoundBalls found;
  candidates_.grid().neighbours(bodies_[ball].cell, found);
  balls.insert(balls.end(), found.balls.begin(), found.balls.begin() + found.count);
}

/// Adds the contacts that did not fit into the ball's agenda, by predicting them again.
template <class Real>
void Simulation<Real>::add_rivals_of_full_agenda(
    int ball, const Event& event, const Instant& limit) {
  std::vector<int> others;
  if (event.involves(ball)) {
    add_near(ball, others);
    std::sort(others.begin(), others.end());
  } else {
    others.push_back(event.ball);
    if (event.is_pair()) others.push_back(event.partner);
  }
  for (const int other : others) {
    if (other == ball) continue;
    Event rival{EventKind::pair_contact, limit, ball, other};
    if (rival.same_bodies(event)) continue;
    const auto contact = contact_of(rival);
    const auto& begin = contact.flight.start;
    const auto answer = ladder_.pair(contact.flight, contact.partner, begin, contact.radius);
    if (answer.verdict != dynamics::Verdict::contact) continue;
    rival.time = clock_.after(begin, answer.delay);
    if (rival.time <= limit) rivals_.push_back(rival);
  }
}

template <class Real>
auto Simulation<Real>::contact_of(const Event& event) const -> dynamics::Contact<Real> {
  const auto& flight = flights_[event.ball];
  if (event.kind == EventKind::wall_contact)
    return {.with_wall = true,
        .flight = flight,
        .partner = flight,
        .radius = properties(event.ball).radius,
        .time = event.time,
        .wall = event.partner};
  const auto& partner = flights_[event.partner];
  const Real sum = properties(event.ball).radius + properties(event.partner).radius;
  if (flight.start < partner.start) return {false, partner, flight, sum, event.time};
  return {false, flight, partner, sum, event.time};
}

/// Advances the balls of a contact to it and applies the impulse.
template <class Real> auto Simulation<Real>::collide(const Event& event) -> Impact {
  if (event.by_rule) ++counts_.simultaneous_contacts;
  const bool with_wall = event.kind == EventKind::wall_contact;
  auto impact = with_wall ? collide_with_wall(event) : collide_pair(event);
  impact.index = counts_.impacts++;
  impact.time = now_;
  impact.ball = event.ball;
  impact.with_wall = with_wall;
  impact.partner = event.partner;
  impact.by_rule = event.by_rule;
  if (impact.overlap > counts_.deepest_overlap) counts_.deepest_overlap = impact.overlap;
  EDMILL_REQUIRE(impact.overlap < tolerated_overlap_,
      "an impact was missed: bodies overlap by " + to_text(impact.overlap) + " m");
  raise_top_speed(event.ball);
  if (!impact.with_wall) raise_top_speed(event.partner);
  return impact;
}

template <class Real> void Simulation<Real>::update_pose() {
  const auto update = [&](const auto& motion, const auto&) { pose_ = motion.pose(now_); };
  model::with_parts<Real>(mill_.motion, mill_.vessel, update);
}

/// The contact of a ball with a body: normal, overlap, and velocity of the body's surface.
template <class Real> auto Simulation<Real>::collide_with_wall(const Event& event) -> Impact {
  const int ball = event.ball, wall = event.partner;
  find_neighbours(ball, near_);
  auto& flight = flights_[ball];
  const Real flight_time = dynamics::fly_to(flight, mill_.gravity, clock_, now_);
  bool pose_is_known = false;
  if constexpr (!is_double) {  // a wide scalar has kept that of a predicted contact
    const Agenda& a = agendas_[ball];
    pose_is_known = a.wall_pose && a.times[wall_entry] == now_;
    if (pose_is_known) pose_ = *a.wall_pose;
  }
  if (!pose_is_known) update_pose();
  const Real radius = properties(ball).radius;

  Impact impact{};
  const auto* body = mill_.body_of(wall);
  if (body) [[unlikely]] {
    const auto touch = model::touch_of(mill_, wall, radius, now_, flight.position);
    impact.normal = touch.normal, impact.overlap = touch.overlap,
    impact.wall_velocity = touch.wall_velocity;
  } else {
    const auto touch = [&]<class M, class V>(const M& motion, const V& vessel) {
      const auto& pose = model::pose_of<M>(pose_);
      const auto place = motion.position_in_vessel(pose, flight.position);
      const auto room = vessel.inset(radius);
      impact.normal = motion.direction_to_inertial(pose, room.normal(wall, place));
      impact.overlap = room.overlap(wall, place);
      impact.wall_velocity = motion.wall_velocity(pose, flight.position - impact.normal * radius);
    };
    model::with_parts<Real>(mill_.motion, mill_.vessel, touch);
  }
  if (const auto* pistons = mill_.vessel.pistons(); pistons && !body) {
    const auto moved = pistons->of_wall(wall, now_);
    impact.overlap += moved.value;
    impact.wall_velocity += impact.normal * moved.rate;
  }
  impact.velocity_before[0] = flight.velocity;
  impact.spin_before[0] = bodies_[ball].spin;
  impact.flight_time[0] = flight_time;
  const auto& law = mill_.law_with_wall(properties(ball), wall);
  const bool rests = friction_rests(ball, flight_time, law);
  impact.outcome = dynamics::collide_with_wall<Real>(impact.normal, properties(ball),
      impact.wall_velocity, flight.velocity, bodies_[ball].spin, law, rests);
  agendas_.number_impact(ball, ball);
  candidates_.update(ball);
  return impact;
}

template <class Real> auto Simulation<Real>::collide_pair(const Event& event) -> Impact {
  const int ball = event.ball, partner = event.partner;
  find_neighbours(ball, near_);
  auto &one = flights_[ball], &two = flights_[partner];
  Impact impact{};
  impact.flight_time[0] = dynamics::fly_to(one, mill_.gravity, clock_, now_);
  impact.flight_time[1] = dynamics::fly_to(two, mill_.gravity, clock_, now_);
  const Vec3<Real> between = one.position - two.position;
  const Real distance = norm<Real>(between);
  impact.normal = between * (1 / distance);
  impact.overlap = properties(ball).radius + properties(partner).radius - distance;
  impact.velocity_before[0] = one.velocity;
  impact.velocity_before[1] = two.velocity;
  impact.spin_before[0] = bodies_[ball].spin;
  impact.spin_before[1] = bodies_[partner].spin;
  const auto& law = mill_.law_between(properties(ball), properties(partner));
  const bool rests_for_one = friction_rests(ball, impact.flight_time[0], law);
  const bool rests = friction_rests(partner, impact.flight_time[1], law) || rests_for_one;
  impact.outcome =
      dynamics::collide_balls<Real>(impact.normal, properties(ball), properties(partner),
          one.velocity, bodies_[ball].spin, two.velocity, bodies_[partner].spin, law, rests);
  agendas_.number_impact(ball, partner);
  candidates_.update(ball);
  candidates_.update(partner);
  find_neighbours(partner, near_partner_);
  return impact;
}

/// Counts the ball's impacts in a row without time to move. @return true if this is frictionless
template <class Real>
bool Simulation<Real>::friction_rests(
    int ball, const Real& flight_time, const model::ContactLaw<Real>& law) {
  auto& unmoved = bodies_[ball].unmoved;
  if (mill_.stall.has_moved(flight_time, law.least_separation)) [[likely]] {
    unmoved = 0;
    return false;
  }
  if (unmoved >= mill_.stall.impacts) return true;
  ++unmoved;
  return false;
}

/// Raises the bounds that depend on the fastest ball if the ball's new velocity requires it.
template <class Real> void Simulation<Real>::raise_top_speed(int ball) {
  using std::sqrt;
  const Real fastest = top_speed_ - fall_;
  const Real speed_squared = squared_norm<Real>(flights_[ball].velocity);
  if (!(speed_squared > fastest * fastest)) return;
  top_speed_ = 2 * sqrt(speed_squared) + fall_;
  ladder_.raise_top_speed(top_speed_);
  candidates_.raise_top_speed(top_speed_);
}

/// Tests whether the impact is one of infinitely many in finite time, or at one time; notifies.
template <class Real> void Simulation<Real>::notify(const Impact& impact) {
  if (may_collapse_) {
    note_collapse(impact, impact.ball, impact.partner);
    if (!impact.with_wall) note_collapse(impact, impact.partner, impact.ball);
  }
  if (stall_watch_.note(now_, clock_, impact.ball, impact.with_wall, impact.partner)) {
    stall_ = stall_watch_.found();
    stop_ = EndReason::stalled;
  }
  for (auto* observer : observers_) observer->on_impact(impact, *this);
}

template <class Real>
void Simulation<Real>::note_collapse(const Impact& hit, int ball, int partner) {
  const bool with_wall = hit.with_wall;
  const int key = with_wall ? ball_count() + partner : partner;
  const auto& law = with_wall ? mill_.law_with_wall(properties(ball), partner)
                              : mill_.law_between(properties(ball), properties(partner));
  if (law.least_separation > 0) return;
  const Real slow = std::max(slow_, Real(1000 * epsilon<Real>() * top_speed_));
  auto& recent = bodies_[ball].recent;
  const Real &speed = hit.outcome.approach_speed, e = hit.outcome.restitution_normal();
  if (!collapse_watch_.note(recent, key, now_, speed, slow, e, clock_)) return;
  const Real time = collapse_watch_.accumulation_time(recent, clock_);
  collapse_ = model::InelasticCollapse<Real>{ball, with_wall, partner, time};
  stop_ = EndReason::inelastic_collapse;
}

template <class Real> void Simulation<Real>::predict(const Impact& impact) {
  if (impact.with_wall) return predict_all(impact.ball, -1, pose_, near_);
  // Wide scalars begin their wall searches in double.
  if constexpr (is_double) update_pose();
  predict_all(impact.ball, -1, pose_, near_);
  prefetcher_.more();
  predict_all(impact.partner, impact.ball, pose_, near_partner_);
}

/// @pre find_neighbours(ball, near)
template <class Real>
void Simulation<Real>::predict_all(int ball, int already_done, const Pose& pose, FoundBalls& near) {
  const auto state = candidates_.state(ball, now_);
  agendas_[ball].drop_pairs();
  const int found = candidates_.find(ball, state, now_, near);
  // Before the candidates are used, whose number is known late: the processor does this meanwhile.
  predict_crossing(ball, state);
  predict_pairs(ball, already_done, state, found, near);
  prefetcher_.more();
  predict_wall(ball, pose);
  requeue(ball);
}

template <class Real>
void Simulation<Real>::predict_pairs(
    int ball, int already_done, const DoubleState& state, int found, const FoundBalls& near) {
  const int* places = candidates_.places();
  for (int k = 0; k < found; ++k) {
    const int other = candidates_.ball_at(places[k], near);
    if (other == already_done) continue;
    if constexpr (is_double) {
      const double delay = candidates_.delay(places[k]);
      if (delay >= 0) [[likely]] {
        expect_pair(ball, other, delay);
        continue;
      }
    }
    const Real sum = properties(ball).radius + properties(other).radius;
    dynamics::PairAnswer<Real> answer;
    if constexpr (is_double)
      answer = ladder_.pair(state, flights_[ball], flights_[other], now_, sum);
    else
      answer = ladder_.pair(flights_[ball], flights_[other], now_, sum);
    if (answer.verdict == dynamics::Verdict::contact) expect_pair(ball, other, answer.delay);
  }
}

template <class Real> void Simulation<Real>::expect_pair(int ball, int other, const Real& delay) {
  Agenda& a = agendas_[ball];
  const Instant time = clock_.after(now_, delay);
  if (time >= a.forgotten_from) return;
  if (a.pair_count < Agenda::capacity) [[likely]] {
    a.put_pair(first_pair + a.pair_count++, time, other, agendas_.latest_impact());
    return;
  }
  const int last = a.farthest();
  a.forgotten_from = time < a.times[last] ? a.times[last] : time;
  if (time < a.times[last]) a.put_pair(last, time, other, agendas_.latest_impact());
}

template <class Real> void Simulation<Real>::predict_crossing(int ball, const DoubleState& state) {
  if (!candidates_.uses_cells()) return;
  Agenda& a = agendas_[ball];
  const auto& gravity = candidates_.filter().gravity;
  const auto velocity = dynamics::velocity_after(candidates_.flights()[ball], gravity, state.age);
  const auto& cell = bodies_[ball].cell;
  const auto crossing = candidates_.grid().crossing(cell, state.position, velocity, gravity);
  a.crossing_face = static_cast<std::int8_t>(2 * crossing.axis + (crossing.step > 0));
  const bool leaves = crossing.delay < Crossing::never;
  a.times[crossing_entry] = leaves ? clock_.after(now_, Real(crossing.delay)) : Instant::never();
}

/// Length of the window for a wall search from `begin` [s]: up to a little after the ball's nearest
/// pair contact, so that every wall contact that may come first is found.
template <class Real> Real Simulation<Real>::search_length(int ball, const Instant& begin) const {
  const Real& longest = ladder_.walls().longest_window();
  const Agenda& a = agendas_[ball];
  if (a.pair_count == 0) return longest;
  const Real until_pair = clock_.elapsed(begin, a.times[a.nearest()]) + 2 * ladder_.tie_window();
  return std::min(longest, std::max(Real(longest / 4096), until_pair));
}

template <class Real> void Simulation<Real>::predict_wall(int ball, const Pose& pose) {
  ++counts_.wall_searches;
  const Real length = search_length(ball, now_);
  const dynamics::WallQuery<Real> query{flights_[ball], properties(ball).radius, now_, length};
  try {
    if constexpr (is_double)
      take_wall_answer(ball, ladder_.wall(pose, query), now_);
    else
      take_wall_answer(ball, ladder_.wall(query), now_);  // which begins in double
  } catch (const InterruptedError&) {
    agendas_[ball].wall = -1;  // the impact has happened; a continued run begins by searching
    agendas_[ball].times[wall_entry] = now_;
    stop_ = EndReason::interrupted;
  }
}

template <class Real> void Simulation<Real>::continue_wall_search(int ball, const Instant& begin) {
  ++counts_.wall_searches;
  const Real length = search_length(ball, begin), &radius = properties(ball).radius;
  take_wall_answer(ball, ladder_.wall({flights_[ball], radius, begin, length}), begin);
  requeue(ball);
}

template <class Real>
void Simulation<Real>::take_wall_answer(
    int ball, const dynamics::WallAnswer<Real>& answer, const Instant& begin) {
  Agenda& a = agendas_[ball];
  if (answer.verdict == dynamics::Verdict::contact) {
    a.wall = static_cast<std::int8_t>(answer.wall + (answer.by_rule ? Agenda::tied : 0));
    a.times[wall_entry] = answer.time;
    a.wall_pose = answer.pose;
  } else {
    // The next search begins where this proof is still valid, however the sum is rounded.
    const Real proven = answer.searched - 4 * epsilon<Real>() * clock_.period();
    a.wall = -1;
    a.times[wall_entry] = clock_.after(begin, proven);
  }
}

}  // namespace edmill::engine
