// Implementation of Simulation: what is asked of memory early, where balls do not fit into the near caches;
// included by the instantiation files only. Nothing here changes a result.
#pragma once

#include "edmill/engine/simulation.hpp"

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
  grid_.neighbours(ball, near);
  fetch_flights(near);
}

/// What every event of a ball needs.
template <class Real>
void Simulation<Real>::fetch_ball(int ball) const {
  const char* agenda = reinterpret_cast<const char*>(&agendas_[ball]);
  for (std::size_t line = 0; line < sizeof(Agenda); line += 64) fetch(agenda + line);
  fetch(&flights_[ball]);
  grid_.fetch_place(ball);
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
/// agenda tells two events early what else it needs.
template <class Real>
void Simulation<Real>::fetch_portion() {
  const auto [next, second, third] = upcoming_;
  const Agenda& agenda = agendas_[second];
  const bool crossing = agenda.next == Agenda::crossing_entry;
  const auto partner = [&](int ball) {
    const Agenda& a = agendas_[ball];
    return a.next < Agenda::first_pair ? ball : a.partner_at(a.next);
  };
  switch (fetched_++) {
    case 0:
      return fetch_ball(third);
    case 1:
      if (partner(next) != next) grid_.fetch_cells(partner(next));
      return;
    case 2:
      if (partner(second) == second) return;
      fetch_ball(partner(second));
      fetch(&bodies_[second]);
      return fetch(&bodies_[partner(second)]);
    default:
      if (crossing)
        grid_.fetch_new_cells(second, agenda.crossing_axis(), agenda.crossing_step());
      else
        grid_.fetch_cells(second);
  }
}

}  // namespace edmill::engine
