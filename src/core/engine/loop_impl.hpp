// Implementation of Simulation: the loop; included by the instantiation files only.
#pragma once

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

}  // namespace edmill::engine
