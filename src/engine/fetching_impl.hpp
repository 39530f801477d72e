// Implementation of Simulation: what is asked of memory early, where balls do not fit into the near caches;
// included by the instantiation files only. Nothing here changes a result.
#pragma once

#include "engine/simulation.hpp"

namespace edmill::engine {

template <class Real>
void Simulation<Real>::fetch_flights(const FoundBalls& near) const {
  for (int k = 0; k < near.count; ++k) fetch(&rough_flights()[near.balls[k]]);
}

/// The balls of the adjacent cells are found before an impact is worked out, so that memory brings their
/// flights meanwhile.
template <class Real>
void Simulation<Real>::fetch_neighbours(int ball, FoundBalls& near) const {
  if (table_ || !many_balls()) return;
  grid_.neighbours(bodies_[ball].cell, near);
  fetch_flights(near);
}

/// What every event of a ball needs.
template <class Real>
void Simulation<Real>::fetch_ball(int ball) const {
  const char* agenda = reinterpret_cast<const char*>(&agendas_[ball]);
  for (std::size_t line = 0; line < sizeof(Agenda); line += 64) fetch(agenda + line);
  fetch(&flights_[ball]);
  fetch(&bodies_[ball]);
  queue_.fetch_entry(ball);
}

/// Begins to fetch what the next events need.
template <class Real>
void Simulation<Real>::look_ahead() {
  if (!many_balls()) return;
  upcoming_ = queue_.upcoming();
  fetched_ = 0;
}

/// Fetches one more portion: memory takes about ten lines at a time and lets the next ones wait, so there
/// should be other work between two portions. An event is begun three events early with its ball, whose
/// agenda tells two events early what else it needs, and its partner's agenda one event early whether the
/// contact is void.
template <class Real>
void Simulation<Real>::fetch_portion() {
  const auto [next, second, third] = upcoming_;
  const auto pair_comes = [&](int ball) { return agendas_[ball].next >= Agenda::first_pair; };
  const auto partner = [&](int ball) { return agendas_[ball].partner_at(agendas_[ball].next); };
  switch (fetched_++) {
    case 0:
      return fetch_ball(third);
    case 1:
      if (pair_comes(next) && still_holds(agendas_[next], agendas_[next].next))
        grid_.fetch_cells(bodies_[partner(next)].cell);
      return;
    case 2:
      if (pair_comes(second)) fetch_ball(partner(second));
      return;
    default:
      const Agenda& agenda = agendas_[second];
      const CellOfBall& cell = bodies_[second].cell;
      if (agenda.next == Agenda::crossing_entry)
        grid_.fetch_new_cells(cell, agenda.crossing_axis(), agenda.crossing_step());
      else
        grid_.fetch_cells(cell);
  }
}

}  // namespace edmill::engine
