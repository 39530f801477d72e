// Implementation of Simulation: what comes next for a ball, and which of two contacts is first; included by
// the instantiation files only.
#pragma once

#include "engine/simulation.hpp"

namespace edmill::engine {

/// @pre fetch_neighbours(ball, near)
template <class Real>
void Simulation<Real>::predict_all(int ball, int already_done, const model::VesselPose<Real>& pose,
                                   FoundBalls& near) {
  const auto roughly = see_roughly(ball);
  agendas_[ball].drop_pairs();
  const int found = look_around(ball, roughly, near);
  // Before the suspects: how many there are is known late, and the processor can do this meanwhile.
  predict_crossing(ball, roughly);
  predict_suspects(ball, already_done, roughly, found, near);
  fetch_more();
  predict_wall(ball, pose);
  requeue(ball);
}

/// Finds the suspects among all balls that the ball may meet.
/// @return how many there are
template <class Real>
int Simulation<Real>::look_around(int ball, const RoughlySeen& roughly, FoundBalls& near) {
  if (table_) return table_->look(question(ball, roughly), looks_);
  if (!many_balls()) grid_.neighbours(bodies_[ball].cell, near);
  return look_at_near(ball, roughly, near);
}

template <class Real>
int Simulation<Real>::look_at_near(int ball, const RoughlySeen& roughly, FoundBalls& near) {
  looks_.make_room(near.count);
  return look_at(rough_flights(), radii_.data(), stride_, question(ball, roughly), ball, near.balls.data(),
                 near.count, looks_);
}

/// Predicts contacts with the suspects of `looks_`.
template <class Real>
void Simulation<Real>::predict_suspects(int ball, int already_done, const RoughlySeen& roughly, int found,
                                        const FoundBalls& near) {
  const int* suspects = looks_.suspects();
  for (int k = 0; k < found; ++k) {
    const int other = table_ ? suspects[k] : near.balls[suspects[k]];
    if (other == already_done) continue;
    if constexpr (std::is_same_v<Real, double>) {
      const double delay = looks_.delay(suspects[k]);
      if (delay >= 0) [[likely]] {
        expect_pair(ball, other, delay);
        continue;
      }
    }
    const Real sum = properties(ball).radius + properties(other).radius;
    const auto answer = ladder_.pair(see(ball, roughly), flights_[ball], flights_[other], now_, sum);
    if (answer.verdict == dynamics::Verdict::contact) expect_pair(ball, other, answer.delay);
  }
}

template <class Real>
void Simulation<Real>::flight_changed(int ball) {
  if constexpr (!std::is_same_v<Real, double>)
    rough_flights_[ball] = dynamics::flight_cast<double>(flights_[ball]);
  if (table_) table_->set(ball, rough_flights()[ball], radii_[ball * stride_]);
}

/// Puts a contact into the ball's agenda.
template <class Real>
void Simulation<Real>::expect_pair(int ball, int other, const Real& delay) {
  Agenda& a = agendas_[ball];
  const Instant<Real> time = clock_.after(now_, delay);
  if (time >= a.forgotten_from) return;
  if (a.pair_count < Agenda::capacity) [[likely]] {
    a.put_pair(Agenda::first_pair + a.pair_count++, time, other, impact_number_);
    return;
  }
  const int last = a.farthest();
  a.forgotten_from = time < a.times[last] ? a.times[last] : time;
  if (time < a.times[last]) a.put_pair(last, time, other, impact_number_);
}

template <class Real>
void Simulation<Real>::predict_crossing(int ball, const RoughlySeen& roughly) {
  if (grid_.single_cell()) return;
  Agenda& a = agendas_[ball];
  const auto& gravity = pair_filter_.filter().gravity;
  const auto velocity = dynamics::velocity_after(rough_flights()[ball], gravity, roughly.age);
  const auto crossing = grid_.crossing(bodies_[ball].cell, roughly.position, velocity, gravity);
  a.crossing_face = static_cast<std::int8_t>(2 * crossing.axis + (crossing.step > 0));
  a.times[Agenda::crossing_entry] =
      crossing.delay < Crossing::never ? clock_.after(now_, Real(crossing.delay)) : Instant<Real>::never();
}

/// How far a wall search from `begin` need look: to a little behind the ball's nearest pair contact, so that
/// a wall contact which may be first is known.
template <class Real>
Real Simulation<Real>::search_length(int ball, const Instant<Real>& begin) const {
  const Real& longest = ladder_.walls().longest_window();
  const Agenda& a = agendas_[ball];
  if (a.pair_count == 0) return longest;
  const Real until_pair = clock_.elapsed(begin, a.times[a.nearest()]) + 2 * ladder_.tie_window();
  return std::min(longest, std::max(Real(longest / 4096), until_pair));
}

template <class Real>
void Simulation<Real>::predict_wall(int ball, const model::VesselPose<Real>& pose) {
  ++counts_.wall_searches;
  const Real length = search_length(ball, now_);
  const auto& flight = flights_[ball];
  const dynamics::WallQuery<Real> query{flight, properties(ball).radius, now_, length};
  if constexpr (std::is_same_v<Real, double>) {
    take_wall_answer(ball, ladder_.wall(pose, query), now_);
  } else {
    take_wall_answer(ball, ladder_.wall(query), now_);  // which begins in double
  }
}

template <class Real>
void Simulation<Real>::continue_wall_search(int ball, const Instant<Real>& begin) {
  ++counts_.wall_searches;
  const Real length = search_length(ball, begin);
  take_wall_answer(ball, ladder_.wall({flights_[ball], properties(ball).radius, begin, length}), begin);
  requeue(ball);
}

template <class Real>
void Simulation<Real>::take_wall_answer(int ball, const dynamics::WallAnswer<Real>& answer,
                                        const Instant<Real>& begin) {
  Agenda& a = agendas_[ball];
  if (answer.verdict == dynamics::Verdict::contact) {
    a.wall = static_cast<std::int8_t>(answer.wall + (answer.tie ? Agenda::tied : 0));
    a.times[Agenda::wall_entry] = answer.time;
    a.wall_pose = answer.pose;
  } else {
    // The next search begins where this one's proof still holds, whatever the sum is rounded to.
    a.wall = -1;
    a.times[Agenda::wall_entry] =
        clock_.after(begin, answer.searched - 4 * epsilon<Real>() * clock_.period());
  }
}

/// Whether anything else is due so soon after a contact that it may be first. Rarely.
template <class Real>
bool Simulation<Real>::has_rivals(const Event& event) const {
  const Instant<Real> limit = clock_.after(event.time, ladder_.tie_window());
  const Agenda& a = agendas_[event.ball];
  int due = (a.times[Agenda::wall_entry] <= limit) + (a.forgotten_from <= limit);
  for (int k = 0; k < Agenda::capacity; ++k) due += a.times[Agenda::first_pair + k] <= limit;
  return due > 1 || queue_.runner_up(limit) >= 0;  // one is the event itself
}

/// Of contacts that share a ball and are so close in time that rounding may have put them in the wrong order,
/// the first: wider scalars time them anew. What no scalar can tell apart is put in order by a rule, and
/// marked.
template <class Real>
auto Simulation<Real>::settle_ties(Event event) -> Event {
  std::vector<Event> passed;  // that went behind another one
  for (;;) {
    const Instant<Real> limit = clock_.after(event.time, ladder_.tie_window());
    finish_wall_searches(event, limit);
    find_rivals(event, limit);
    std::optional<Event> first;
    for (const Event& rival : rivals_) {
      const auto same = [&](const Event& e) { return e.same_bodies(rival); };
      if (std::any_of(passed.begin(), passed.end(), same)) continue;
      const int order = ladder_.order(contact_of(event), contact_of(rival));
      event.by_rule |= order == 0;
      if (order > 0 || (order == 0 && rival.goes_before(event))) {
        first = rival;
        first->by_rule |= order == 0;
        break;
      }
    }
    if (!first) return event;
    passed.push_back(event);
    event = *first;
  }
}

/// A search that ends so soon may end just before a contact.
template <class Real>
void Simulation<Real>::finish_wall_searches(const Event& event, const Instant<Real>& limit) {
  const auto finish = [&](int ball) {
    const Agenda& a = agendas_[ball];
    while (!a.hits_wall() && a.times[Agenda::wall_entry] <= limit)
      continue_wall_search(ball, Instant<Real>(a.times[Agenda::wall_entry]));
  };
  finish(event.ball);
  if (event.kind == EventKind::pair_contact) finish(event.partner);
}

/// Fills `rivals_` with the contacts up to `limit` that share a ball with the event.
template <class Real>
void Simulation<Real>::find_rivals(const Event& event, const Instant<Real>& limit) {
  rivals_.clear();
  queue_.due_until(limit, due_);
  for (const int ball : due_) {
    const Agenda& a = agendas_[ball];
    const auto add = [&](const Event& rival) {
      if (rival.shares_ball(event) && !rival.same_bodies(event)) rivals_.push_back(rival);
    };
    if (a.hits_wall() && a.times[Agenda::wall_entry] <= limit)
      add({EventKind::wall_contact, a.times[Agenda::wall_entry], ball, a.wall_id(), a.wall_is_tied()});
    for (int entry = Agenda::first_pair; entry < Agenda::first_pair + a.pair_count; ++entry)
      if (a.times[entry] <= limit && still_holds(a, entry))
        add({EventKind::pair_contact, a.times[entry], ball, a.partner_at(entry)});
    if (a.forgotten_from <= limit) add_rivals_of_full_agenda(ball, event, limit);
  }
}

/// Contacts that the ball's agenda had no room for are predicted anew.
template <class Real>
void Simulation<Real>::add_rivals_of_full_agenda(int ball, const Event& event, const Instant<Real>& limit) {
  for (int other = 0; other < ball_count(); ++other) {
    if (other == ball) continue;
    Event rival{EventKind::pair_contact, limit, ball, other};
    if (!rival.shares_ball(event) || rival.same_bodies(event)) continue;
    const auto contact = contact_of(rival);
    const auto& begin = contact.flight.start;
    const auto answer = ladder_.pair(contact.flight, contact.partner, begin, contact.radius);
    if (answer.verdict != dynamics::Verdict::contact) continue;
    rival.time = clock_.after(begin, answer.delay);
    if (rival.time <= limit) rivals_.push_back(rival);
  }
}

template <class Real>
dynamics::Contact<Real> Simulation<Real>::contact_of(const Event& event) const {
  const auto& flight = flights_[event.ball];
  if (event.kind == EventKind::wall_contact)
    return {true, flight, flight, properties(event.ball).radius, event.time};
  const auto& partner = flights_[event.partner];
  const Real sum = properties(event.ball).radius + properties(event.partner).radius;
  if (flight.start < partner.start) return {false, partner, flight, sum, event.time};
  return {false, flight, partner, sum, event.time};
}

}  // namespace edmill::engine
