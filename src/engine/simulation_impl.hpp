// Implementation of Simulation: set-up, the loop, impacts; included by the instantiation files only.
#pragma once

#include <algorithm>
#include <boost/math/special_functions/cbrt.hpp>

#include "base/errors.hpp"
#include "engine/fetching_impl.hpp"
#include "engine/prediction_impl.hpp"
#include "engine/simulation.hpp"

namespace edmill::engine {

namespace detail {

/// The most that gravity adds to a ball's speed in one flight: one that stays within `reach` of the fulcrum
/// bends by g t^2/8 < 2 reach [m/s].
template <class Real>
Real largest_fall(const model::Mill<Real>& mill) {
  using std::sqrt;
  const Real &R = mill.vessel.radius, &h = mill.vessel.half_height;
  const Real reach = mill.motion.arm + sqrt(R * R + h * h);
  return 4 * sqrt(reach * norm<Real>(mill.gravity));
}

template <class Real>
Real largest_speed(const std::vector<model::BallState<Real>>& states, const model::Mill<Real>& mill) {
  Real largest{1};
  for (const auto& s : states) {
    const Real speed = norm<Real>(s.velocity);
    if (speed > largest) largest = speed;
  }
  const Real wall = (mill.motion.theta_max + mill.motion.gamma_max) * mill.motion.angular_speed() *
                    (mill.motion.arm + mill.vessel.radius + mill.vessel.half_height);
  return 2 * (largest + wall) + largest_fall(mill);
}

template <class Real>
Real smallest_radius(const std::vector<model::BallProperties<Real>>& balls) {
  Real smallest = balls.front().radius;
  for (const auto& b : balls) smallest = b.radius < smallest ? b.radius : smallest;
  return smallest;
}

/// The region that the vessel sweeps, cut into cells that hold about one ball but are thicker than the
/// largest.
template <class Real>
CellGrid make_grid(const model::Mill<Real>& mill, const std::vector<model::BallProperties<Real>>& balls) {
  using std::sqrt;
  const Real &R = mill.vessel.radius, &h = mill.vessel.half_height;
  const Real reach = sqrt(R * R + h * h);
  const Real swing = mill.motion.theta_max < 1 ? mill.motion.theta_max : Real(1);
  const Real tilt = mill.motion.gamma_max < 1 ? mill.motion.gamma_max : Real(1);
  const Real sideways = mill.motion.arm * swing + reach;
  const Real upright = R + h * tilt;
  const Real nearest = mill.motion.arm * (1 - swing * swing) - (R + (h + R * tilt) * swing);
  const Vec3<Real> low{-sideways, nearest, Real(-upright)},
      high{sideways, Real(mill.motion.arm + R + (h + R * tilt) * swing), upright};
  Real largest{0};
  for (const auto& b : balls) largest = b.radius > largest ? b.radius : largest;
  const double volume = static_cast<double>(R * R * h) * 6.28;
  // The C library's cube root is not the same on every machine; nor is long double.
  using boost::math::policies::promote_double;
  constexpr boost::math::policies::policy<promote_double<false>> portable;
  Real edge = 2 * largest * (1 + Real(1) / 1024);
  if (balls.size() <= 32) edge = 4 * sideways;
  const double spacing = 0.45 * boost::math::cbrt(volume / static_cast<double>(balls.size()), portable);
  if (edge < spacing) edge = Real(spacing);
  return CellGrid(vector_cast<double>(low), vector_cast<double>(high), static_cast<double>(edge),
                  static_cast<int>(balls.size()));
}

}  // namespace detail

template <class Real>
Simulation<Real>::Simulation(const model::Case<Real>& the_case,
                             const std::vector<model::BallState<Real>>& states, const Instant<Real>& start,
                             const std::atomic<bool>* interrupt)
    : mill_(the_case.mill),
      clock_(the_case.mill.motion.period),
      balls_(the_case.balls),
      agendas_(states.size()),
      ladder_(the_case.mill, 2 * detail::smallest_radius(the_case.balls),
              detail::largest_speed(states, the_case.mill)),
      pair_filter_(model::mill_cast<double>(the_case.mill),
                   2 * static_cast<double>(detail::smallest_radius(the_case.balls)),
                   static_cast<double>(ladder_.walls().constants().reach),
                   static_cast<double>(detail::largest_speed(states, the_case.mill))),
      grid_(detail::make_grid(the_case.mill, the_case.balls)),
      queue_(static_cast<int>(states.size()), the_case.mill.motion.period),
      collapse_watch_(Real(1000000) * epsilon<Real>() / 2 * ladder_.walls().constants().reach),
      now_(start),
      tolerated_overlap_(2 * detail::smallest_radius(the_case.balls) / 1000000),
      fall_(detail::largest_fall(the_case.mill)),
      top_speed_(detail::largest_speed(states, the_case.mill)) {
  EDMILL_REQUIRE(!balls_.empty() && balls_.size() == states.size(), "one state for each ball");
  for (const auto& ball : balls_) radii_.push_back(static_cast<double>(ball.radius));
  stride_ =
      std::all_of(balls_.begin(), balls_.end(), [&](const auto& b) { return b == balls_.front(); }) ? 0 : 1;
  if constexpr (!std::is_same_v<Real, double>) rough_flights_.resize(states.size());
  for (const auto& s : states) {
    flights_.push_back({s.position, s.velocity, start});
    bodies_.push_back({s.spin, {}, {}});
  }
  for (int i = 0; i < ball_count(); ++i)
    bodies_[i].cell = grid_.insert(i, vector_cast<double>(flights_[i].position));
  if (grid_.single_cell()) table_.emplace(static_cast<int>(states.size()), stride_ == 0);
  for (int i = 0; i < ball_count(); ++i) flight_changed(i);
  const auto pose = model::pose_at<Real>(mill_.motion, start.offset);
  for (int i = 0; i < ball_count(); ++i) {
    if (interrupt && interrupt->load(std::memory_order_relaxed)) throw InterruptedError();
    fetch_neighbours(i, near_);
    predict_all(i, -1, pose, near_);
  }
}

template <class Real>
void Simulation<Real>::archive(Archive& a) {
  const auto balls = flights_.size();
  if (!a.loading()) number_anew();  // often enough for tests to see that it changes nothing
  a(flights_, bodies_, agendas_, impact_number_, ladder_, grid_, counts_, now_, top_speed_);
  if (!a.loading()) return;
  EDMILL_REQUIRE(flights_.size() == balls && agendas_.size() == balls, "a saved state of the same case");
  ladder_.raise_top_speed(top_speed_);
  pair_filter_.raise_top_speed(static_cast<double>(top_speed_));
  for (int i = 0; i < ball_count(); ++i) {
    flight_changed(i);
    requeue(i);  // equal times go to the lower ball, whatever the queue's history
  }
}

template <class Real>
EndReason Simulation<Real>::run_until(const Instant<Real>& end, const std::atomic<bool>* interrupt) {
  stop_.reset();
  for (int next = queue_.top(); queue_.time(next) <= end; next = queue_.top()) {
    if (interrupt && interrupt->load(std::memory_order_relaxed)) return EndReason::interrupted;
    const Event event = next_of(next);
    now_ = event.time;
    look_ahead();
    process(event);
    while (fetched_ < portions) fetch_portion();
    if (stop_) return *stop_;
  }
  now_ = end;
  return EndReason::end_time;
}

/// Queues the earliest entry of a ball's agenda; at equal times a wall comes before a ball, contacts before
/// the rest.
template <class Real>
void Simulation<Real>::requeue(int ball) {
  Agenda& a = agendas_[ball];
  const int pair = a.nearest();
  const bool pair_first = (a.times[pair] < a.times[Agenda::wall_entry]) |
                          ((!a.hits_wall()) & (a.times[pair] == a.times[Agenda::wall_entry]));
  const int contact = Agenda::select(pair_first, pair, Agenda::wall_entry);
  const bool crossing_first = a.times[Agenda::crossing_entry] < a.times[contact];
  a.next = static_cast<std::int8_t>(Agenda::select(crossing_first, Agenda::crossing_entry, contact));
  queue_.set(ball, a.times[a.next]);
}

/// What was queued for a ball.
template <class Real>
auto Simulation<Real>::next_of(int ball) const -> Event {
  const Agenda& a = agendas_[ball];
  const Instant<Real>& time = a.times[a.next];
  if (a.next == Agenda::wall_entry)
    return a.hits_wall() ? Event{EventKind::wall_contact, time, ball, a.wall_id(), a.wall_is_tied()}
                         : Event{EventKind::wall_recheck, time, ball, -1};
  if (a.next == Agenda::crossing_entry) return {EventKind::cell_crossing, time, ball, -1};
  return {EventKind::pair_contact, time, ball, a.partner_at(a.next)};
}

template <class Real>
void Simulation<Real>::process(const Event& event) {
  switch (event.kind) {
    case EventKind::pair_contact:
      if (!still_holds(agendas_[event.ball], agendas_[event.ball].next)) return drop_stale(event.ball);
      break;
    case EventKind::cell_crossing:
      return cross_cell(event.ball);
    case EventKind::wall_recheck:
      return continue_wall_search(event.ball, now_);
    case EventKind::wall_contact:
      break;
  }
  const Event first = has_rivals(event) ? settle_ties(event) : event;
  now_ = first.time;
  if (first.by_rule) ++counts_.simultaneous_contacts;
  if (first.kind == EventKind::wall_contact)
    collide_with_wall(first);
  else
    collide_pair(first);
}

/// The nearest pair contact is void: the partner has collided since. The next one takes its place.
template <class Real>
void Simulation<Real>::drop_stale(int ball) {
  ++counts_.stale_events;
  Agenda& a = agendas_[ball];
  a.drop_nearest();
  if (a.pair_count == 0 && a.forgotten_from < Instant<Real>::never()) {
    fetch_neighbours(ball, near_);
    a.drop_pairs();
    const auto roughly = see_roughly(ball);
    const int found = look_around(ball, roughly, near_);
    predict_suspects(ball, -1, roughly, found, near_);
  }
  requeue(ball);
}

template <class Real>
void Simulation<Real>::cross_cell(int ball) {
  ++counts_.cell_crossings;
  const int axis = agendas_[ball].crossing_axis(), step = agendas_[ball].crossing_step();
  CellOfBall& cell = bodies_[ball].cell;
  grid_.move(ball, cell, axis, step);
  grid_.new_neighbours(cell, axis, step, near_);
  if (many_balls()) fetch_flights(near_);
  const auto roughly = see_roughly(ball);
  const int found = look_at_near(ball, roughly, near_);
  predict_crossing(ball, roughly);
  predict_suspects(ball, -1, roughly, found, near_);
  requeue(ball);
}

template <class Real>
model::VesselPose<Real> Simulation<Real>::pose_now() const {
  const auto& constants = ladder_.walls().constants();
  return model::pose_at<Real>(mill_.motion, constants.angular_speed, constants.frequency, now_.offset);
}

/// The pose now, when the ball's predicted wall contact is due.
template <class Real>
model::VesselPose<Real> Simulation<Real>::pose_at_wall_contact(int ball) const {
  if constexpr (!std::is_same_v<Real, double>) {
    const Agenda& a = agendas_[ball];
    if (a.wall_pose && a.times[Agenda::wall_entry] == now_) return *a.wall_pose;
  }
  return pose_now();
}

template <class Real>
void Simulation<Real>::collide_with_wall(const Event& event) {
  const int ball = event.ball, wall = event.partner;
  fetch_neighbours(ball, near_);
  auto& flight = flights_[ball];
  const Real flight_time = dynamics::fly_to(flight, mill_.gravity, clock_, now_);
  const auto pose = pose_at_wall_contact(ball);
  const auto local = model::to_vessel_frame<Real>(pose, mill_.motion.arm, flight.position, flight.velocity);
  const Real radius = properties(ball).radius;

  Impact<Real> impact{};
  Vec3<Real>& normal = impact.normal;
  if (wall == 2) {
    using std::sqrt;
    const Real &x = local.position[0], &z = local.position[2];
    const Real rho = sqrt(x * x + z * z);
    normal = model::vessel_axis_x(pose) * (-x / rho) + model::vessel_axis_z(pose) * (-z / rho);
    impact.overlap = rho - (mill_.vessel.radius - radius);
  } else {
    const Real side(wall == 0 ? 1 : -1);
    normal = model::vessel_axis_y(pose) * side;
    impact.overlap = -side * local.position[1] - (mill_.vessel.half_height - radius);
  }
  const Vec3<Real> contact_point = flight.position - normal * radius;
  const Vec3<Real> wall_velocity = model::wall_velocity<Real>(pose, mill_.motion.arm, contact_point);
  impact.velocity_before[0] = flight.velocity;
  impact.spin_before[0] = bodies_[ball].spin;
  impact.flight_time[0] = flight_time;
  impact.wall_velocity = wall_velocity;
  impact.outcome = dynamics::collide_with_wall<Real>(normal, properties(ball), wall_velocity, flight.velocity,
                                                     bodies_[ball].spin, mill_.ball_wall);
  impact.ball = ball;
  impact.with_wall = true;
  impact.by_rule = event.by_rule;
  impact.partner = wall;
  number_impact(ball, ball);
  flight_changed(ball);
  after_impact(impact);
  if (stop_ == EndReason::inelastic_collapse) return;
  predict_all(ball, -1, pose, near_);
}

template <class Real>
void Simulation<Real>::collide_pair(const Event& event) {
  const int ball = event.ball, partner = event.partner;
  fetch_neighbours(ball, near_);
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
  impact.outcome =
      dynamics::collide_balls<Real>(impact.normal, properties(ball), properties(partner), one.velocity,
                                    bodies_[ball].spin, two.velocity, bodies_[partner].spin, mill_.ball_ball);
  impact.ball = ball;
  impact.with_wall = false;
  impact.by_rule = event.by_rule;
  impact.partner = partner;
  number_impact(ball, partner);
  flight_changed(ball);
  flight_changed(partner);
  fetch_neighbours(partner, near_partner_);
  after_impact(impact);
  if (stop_ == EndReason::inelastic_collapse) return;
  // Wide scalars begin their wall searches in double.
  const auto pose = std::is_same_v<Real, double> ? pose_now() : model::VesselPose<Real>{};
  predict_all(ball, -1, pose, near_);
  fetch_more();
  predict_all(partner, ball, pose, near_partner_);
}

/// Makes the numbers of impacts small again. Pair contacts that hold go on holding, and no others do.
template <class Real>
void Simulation<Real>::number_anew() {
  for (Agenda& a : agendas_)
    for (int k = 0; k < a.pair_count; ++k) a.known[k] = still_holds(a, Agenda::first_pair + k);
  for (Agenda& a : agendas_) a.last_impact = 1;
  impact_number_ = 1;
}

/// The next impact is that of these balls, which may be one and the same.
template <class Real>
void Simulation<Real>::number_impact(int ball, int partner) {
  if (impact_number_ == 1 << 20) number_anew();
  agendas_[ball].last_impact = agendas_[partner].last_impact = ++impact_number_;
}

template <class Real>
void Simulation<Real>::after_impact(Impact<Real>& impact) {
  impact.index = counts_.impacts++;
  impact.time = now_;
  if (impact.overlap > counts_.deepest_overlap) counts_.deepest_overlap = impact.overlap;
  EDMILL_REQUIRE(impact.overlap < tolerated_overlap_,
                 "an impact was missed: bodies overlap by " + to_text(impact.overlap) + " m");
  const Real fastest = top_speed_ - fall_, limit = fastest * fastest;
  for (int body = 0; body < (impact.with_wall ? 1 : 2); ++body) {
    const Real speed_squared =
        squared_norm<Real>(flights_[body == 0 ? impact.ball : impact.partner].velocity);
    if (speed_squared > limit) {
      using std::sqrt;
      top_speed_ = 2 * sqrt(speed_squared) + fall_;
      ladder_.raise_top_speed(top_speed_);
      pair_filter_.raise_top_speed(static_cast<double>(top_speed_));
    }
  }
  if (impact.with_wall) {
    note_collapse(impact, impact.ball, ball_count() + impact.partner, true, impact.partner);
  } else {
    note_collapse(impact, impact.ball, impact.partner, false, impact.partner);
    note_collapse(impact, impact.partner, impact.ball, false, impact.ball);
  }
  for (auto* observer : observers_) observer->on_impact(impact, *this);
}

template <class Real>
void Simulation<Real>::note_collapse(const Impact<Real>& impact, int ball, int key, bool with_wall,
                                     int partner) {
  const auto& law = with_wall ? mill_.ball_wall : mill_.ball_ball;
  if (law.least_separation > 0) return;
  const bool collapsing = collapse_watch_.note(bodies_[ball].recent, key, now_, impact.outcome.approach_speed,
                                               law.restitution_normal, clock_);
  if (!collapsing) return;
  collapse_ = model::InelasticCollapse<Real>{ball, with_wall, partner,
                                             collapse_watch_.accumulation_time(bodies_[ball].recent, clock_)};
  stop_ = EndReason::inelastic_collapse;
}

template <class Real>
model::BallState<Real> Simulation<Real>::state_at(int i, const Instant<Real>& when) const {
  const Real dt = clock_.elapsed(flights_[i].start, when);
  return {dynamics::position_after(flights_[i], mill_.gravity, dt),
          dynamics::velocity_after(flights_[i], mill_.gravity, dt), bodies_[i].spin};
}

template <class Real>
model::Energy<Real> Simulation<Real>::energy_at(const Instant<Real>& when) const {
  model::Energy<Real> energy;
  for (int i = 0; i < ball_count(); ++i)
    energy += model::energy_of<Real>(properties(i), state_at(i, when), mill_.gravity);
  return energy;
}

}  // namespace edmill::engine
