// Implementation of Simulation: the loop, and which of contacts that are close in time is first; included by
// the instantiation files only.
#pragma once

#include <algorithm>

#include "base/interruption.hpp"
#include "engine/simulation.hpp"

namespace edmill::engine {

/// Processes every event up to `end`.
template <class Real>
EndReason Simulation<Real>::run_until(const Instant<Real>& end, const std::atomic<bool>* interrupt) try {
  const Interruption scope(interrupt);
  stop_.reset();
  for (int next = queue_.top(); queue_.time(next) <= end; next = queue_.top()) {
    if (interrupt && interrupt->load(std::memory_order_relaxed)) return EndReason::interrupted;
    const auto event = event_of(next);  // of near ties the first
    const auto prefetching = prefetcher_.scope();
    now_ = event.time;
    switch (event.kind) {
      case EventKind::void_contact:
        drop_void_contact(event.ball);
        break;
      case EventKind::cell_crossing:
        cross_cell(event.ball);
        break;
      case EventKind::wall_horizon:
        continue_wall_search(event.ball, now_);
        break;
      case EventKind::wall_contact:
      case EventKind::pair_contact: {
        const auto impact = collide(event);
        notify(impact);
        if (stop_ != EndReason::inelastic_collapse) predict(impact);
      }
    }
    if (stop_) return *stop_;
  }
  now_ = end;
  return EndReason::end_time;
} catch (const InterruptedError&) {  // from a search before an event
  return EndReason::interrupted;
}

/// What happens next, where `ball` is the first in the queue: what was queued for it, unless that is a
/// contact and another one is as early within rounding.
template <class Real>
auto Simulation<Real>::event_of(int ball) -> Event<Real> {
  auto event = queued_event(ball);
  const bool is_contact = event.kind == EventKind::wall_contact || event.kind == EventKind::pair_contact;
  if (is_contact && has_rivals(event)) event = settle_ties(event);
  // Where times are closer than their errors the ladder may have put the later one first.
  if (event.time < now_) event.time = now_;
  return event;
}

/// What was queued for a ball.
template <class Real>
auto Simulation<Real>::queued_event(int ball) const -> Event<Real> {
  const Agenda<Real>& a = agendas_[ball];
  const Instant<Real>& time = a.times[a.next];
  if (a.next == Agenda<Real>::wall_entry)
    return a.hits_wall() ? Event<Real>{EventKind::wall_contact, time, ball, a.wall_id(), a.wall_is_tied()}
                         : Event<Real>{EventKind::wall_horizon, time, ball};
  if (a.next == Agenda<Real>::crossing_entry) return {EventKind::cell_crossing, time, ball};
  const auto kind = agendas_.still_holds(a, a.next) ? EventKind::pair_contact : EventKind::void_contact;
  return {kind, time, ball, a.partner_at(a.next)};
}

/// Queues the earliest entry of a ball's agenda.
template <class Real>
void Simulation<Real>::requeue(int ball) {
  Agenda<Real>& a = agendas_[ball];
  a.next = static_cast<std::int8_t>(a.earliest());
  queue_.set(ball, a.times[a.next]);
}

/// The next pair contact takes the place of the nearest one, which is void.
template <class Real>
void Simulation<Real>::drop_void_contact(int ball) {
  ++counts_.stale_events;
  Agenda<Real>& a = agendas_[ball];
  a.drop_nearest();
  if (a.pair_count == 0 && a.forgotten_from < Instant<Real>::never()) {
    find_neighbours(ball, near_);
    a.drop_pairs();
    const auto state = candidates_.state(ball, now_);
    const int found = candidates_.find(ball, state, now_, near_);
    predict_pairs(ball, -1, state, found, near_);
  }
  requeue(ball);
}

/// The ball may meet the balls of the cells that are new to it.
template <class Real>
void Simulation<Real>::cross_cell(int ball) {
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

/// Whether anything else is due so soon after a contact that it may be first. Rarely.
template <class Real>
bool Simulation<Real>::has_rivals(const Event<Real>& event) const {
  const Instant<Real> limit = clock_.after(event.time, ladder_.tie_window());
  const Agenda<Real>& a = agendas_[event.ball];
  int due = (a.times[Agenda<Real>::wall_entry] <= limit) + (a.forgotten_from <= limit);
  for (int k = 0; k < Agenda<Real>::capacity; ++k) due += a.times[Agenda<Real>::first_pair + k] <= limit;
  return due > 1 || queue_.runner_up(limit) >= 0;  // one is the event itself
}

/// Finds the first of the contacts that share a ball and are so close in time that rounding may have put them
/// in the wrong order: wider scalars time them anew. What no scalar can tell apart is put in order by a rule,
/// and marked.
template <class Real>
auto Simulation<Real>::settle_ties(Event<Real> event) -> Event<Real> {
  std::vector<Event<Real>> passed;  // that went after another one
  for (;;) {
    const Instant<Real> limit = clock_.after(event.time, ladder_.tie_window());
    finish_wall_searches(event, limit);
    find_rivals(event, limit);
    std::optional<Event<Real>> first;
    for (const Event<Real>& rival : rivals_) {
      const auto same = [&](const Event<Real>& e) { return e.same_bodies(rival); };
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
void Simulation<Real>::finish_wall_searches(const Event<Real>& event, const Instant<Real>& limit) {
  const auto finish = [&](int ball) {
    const Agenda<Real>& a = agendas_[ball];
    while (!a.hits_wall() && a.times[Agenda<Real>::wall_entry] <= limit)
      continue_wall_search(ball, Instant<Real>(a.times[Agenda<Real>::wall_entry]));
  };
  finish(event.ball);
  if (event.kind == EventKind::pair_contact) finish(event.partner);
}

/// Fills `rivals_` with the contacts up to `limit` that share a ball with the event.
template <class Real>
void Simulation<Real>::find_rivals(const Event<Real>& event, const Instant<Real>& limit) {
  rivals_.clear();
  find_due(event, limit);
  for (const int ball : due_) {
    const Agenda<Real>& a = agendas_[ball];
    const auto add = [&](const Event<Real>& rival) {
      if (rival.shares_ball(event) && !rival.same_bodies(event)) rivals_.push_back(rival);
    };
    if (a.hits_wall() && a.times[Agenda<Real>::wall_entry] <= limit)
      add({EventKind::wall_contact, a.times[Agenda<Real>::wall_entry], ball, a.wall_id(), a.wall_is_tied()});
    for (int entry = Agenda<Real>::first_pair; entry < Agenda<Real>::first_pair + a.pair_count; ++entry)
      if (a.times[entry] <= limit && agendas_.still_holds(a, entry))
        add({EventKind::pair_contact, a.times[entry], ball, a.partner_at(entry)});
    if (a.forgotten_from <= limit) add_rivals_of_full_agenda(ball, event, limit);
  }
}

/// Fills `due_` with balls that have an event up to `limit`, all that may share one with a ball of `event`
/// among them.
template <class Real>
void Simulation<Real>::find_due(const Event<Real>& event, const Instant<Real>& limit) {
  if (!candidates_.uses_cells()) return queue_.due_until(limit, due_);
  // However many others have events at the same time.
  due_.clear();
  add_near(event.ball, due_);
  if (event.kind == EventKind::pair_contact) add_near(event.partner, due_);
  std::sort(due_.begin(), due_.end());
  due_.erase(std::unique(due_.begin(), due_.end()), due_.end());
  std::erase_if(due_, [&](int ball) { return limit < queue_.time(ball); });
}

/// Adds the balls of the adjacent cells, with the ball itself, or all balls where cells are not used.
template <class Real>
void Simulation<Real>::add_near(int ball, std::vector<int>& balls) {
  if (!candidates_.uses_cells()) {
    for (int other = 0; other < ball_count(); ++other) balls.push_back(other);
    return;
  }
  candidates_.neighbours(bodies_[ball].cell, near_due_);
  balls.insert(balls.end(), near_due_.balls.begin(), near_due_.balls.begin() + near_due_.count);
}

/// Contacts that the ball's agenda had no room for are predicted anew.
template <class Real>
void Simulation<Real>::add_rivals_of_full_agenda(int ball, const Event<Real>& event,
                                                 const Instant<Real>& limit) {
  std::vector<int> others;
  if (event.involves(ball)) {
    add_near(ball, others);
    std::sort(others.begin(), others.end());
  } else {
    others.push_back(event.ball);
    if (event.kind == EventKind::pair_contact) others.push_back(event.partner);
  }
  for (const int other : others) {
    if (other == ball) continue;
    Event<Real> rival{EventKind::pair_contact, limit, ball, other};
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
dynamics::Contact<Real> Simulation<Real>::contact_of(const Event<Real>& event) const {
  const auto& flight = flights_[event.ball];
  if (event.kind == EventKind::wall_contact)
    return {true, flight, flight, properties(event.ball).radius, event.time, event.partner};
  const auto& partner = flights_[event.partner];
  const Real sum = properties(event.ball).radius + properties(event.partner).radius;
  if (flight.start < partner.start) return {false, partner, flight, sum, event.time};
  return {false, flight, partner, sum, event.time};
}

}  // namespace edmill::engine
