// Prefetches what the next events need, where balls do not fit into the near caches.
#pragma once

#include <array>

#include "base/memory.hpp"
#include "engine/agenda.hpp"
#include "engine/candidates.hpp"
#include "engine/event_queue.hpp"

namespace edmill::engine {

/// Prefetches data for the next events, without which a run has the same bits and takes longer. The
/// memory system handles about ten cache lines at a time, so there is other work between two
/// portions. A ball is prefetched three events ahead; two events ahead its agenda shows what else
/// is needed, and one event ahead the partner's agenda shows whether the contact is void.
template <class Real> class Prefetcher {
 public:
  static constexpr int worthwhile = 1024;  ///< more balls do not fit into the near caches

  Prefetcher(const EventQueue<Real>& queue, const Agendas<Real>& agendas,
      const LargeVector<dynamics::Flight<Real>>& flights, const LargeVector<Body<Real>>& bodies,
      const Candidates<Real>& candidates)
      : queue_(queue), agendas_(agendas), flights_(flights), bodies_(bodies),
        candidates_(candidates) {}

  void enable(bool yes) { enabled_ = yes; }

  /// Starts prefetching for the next events, in portions; `finish` fetches the remaining ones.
  void begin() {
    if (!enabled_) return;
    upcoming_ = queue_.upcoming();
    portion_ = 0;
  }
  /// Fetches the next portion, if there is one; to be called between other work.
  void more() {
    if (portion_ < portions) prefetch_next();
  }
  void finish() {
    while (portion_ < portions) prefetch_next();
  }

  void flights_of(const FoundBalls& near) const {
    if (!enabled_) return;
    for (int k = 0; k < near.count; ++k) fetch(&candidates_.flights()[near.balls[k]]);
  }
 private:
  static constexpr int portions = 4;

  void prefetch_next() {
    const auto [next, second, third] = upcoming_;
    const auto pair_comes = [&](int ball) { return agendas_[ball].next >= first_pair; };
    const auto partner = [&](int ball) { return agendas_[ball].partner_at(agendas_[ball].next); };
    const CellGrid& grid = candidates_.grid();
    switch (portion_++) {
      case 0: return fetch_ball(third);
      case 1:
        if (pair_comes(next) && agendas_.still_holds(agendas_[next], agendas_[next].next))
          grid.fetch_cells(bodies_[partner(next)].cell);
        return;
      case 2:
        if (pair_comes(second)) fetch_ball(partner(second));
        return;
      default:
        const auto& agenda = agendas_[second];
        const CellOfBall& cell = bodies_[second].cell;
        if (agenda.next == crossing_entry)
          grid.fetch_new_cells(cell, agenda.crossing_axis(), agenda.crossing_step());
        else
          grid.fetch_cells(cell);
    }
  }

  void fetch_ball(int ball) const {
    const char* agenda = reinterpret_cast<const char*>(&agendas_[ball]);
    for (std::size_t line = 0; line < sizeof(Agenda<Real>); line += 64) fetch(agenda + line);
    fetch(&flights_[ball]);
    fetch(&bodies_[ball]);
    queue_.fetch_entry(ball);
  }

  const EventQueue<Real>& queue_;
  const Agendas<Real>& agendas_;
  const LargeVector<dynamics::Flight<Real>>& flights_;
  const LargeVector<Body<Real>>& bodies_;
  const Candidates<Real>& candidates_;
  bool enabled_ = false;
  std::array<int, 3> upcoming_{};  ///< balls of the next events, most likely
  int portion_ = portions;         ///< the next portion to be fetched
};

}  // namespace edmill::engine
