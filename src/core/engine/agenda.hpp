// The data of each ball besides its flight: its predicted events, and what all events need.
#pragma once

#include <array>
#include <cstdint>

#include "base/instant.hpp"
#include "base/memory.hpp"
#include "base/vector.hpp"
#include "dynamics/flight.hpp"
#include "engine/cell_grid.hpp"
#include "engine/watches.hpp"

namespace edmill::engine {

/// Entries of an agenda: the wall, the next cell, and the pair contacts from here on.
inline constexpr int wall_entry = 0, crossing_entry = 1, first_pair = 2;

/// The predicted events of one ball. Its own pair contacts are in any order; one becomes void when
/// the partner has an impact, and of predictions by both balls the later one is valid. The
/// processor cannot predict which entry is the earliest: it is found without branches.
template <class Real> struct alignas(sizeof(Real) == 8 ? 64 : alignof(Real)) Agenda {
  static constexpr int capacity = 3;                            ///< of pair contacts
  std::array<Instant<Real>, first_pair + capacity> times;       ///< by entry; never() where free
  [[no_unique_address]] dynamics::ContactPose<Real> wall_pose;  ///< at the wall's time
  Instant<Real> forgotten_from;  ///< later contacts found no room; never() if all are stored
  std::array<int, capacity> partners{};
  std::array<std::uint32_t, capacity> known;  ///< latest impact of all when predicted
  std::uint32_t last_impact = 0;              ///< number of the ball's latest
  std::int8_t pair_count = 0;
  /// A wall id, plus `tied` if another wall is hit at that time; -1 if a search ends there.
  std::int8_t wall = -1;
  std::int8_t crossing_face = 0;  ///< twice the axis, and 1 more when upwards
  std::int8_t next = wall_entry;  ///< the entry that was queued

  Agenda() {
    times.fill(Instant<Real>::never());
    drop_pairs();
  }

  /// Entries of the earliest and the latest pair contact, when there are any.
  int nearest() const {
    const int first = first_pair + (times[first_pair + 1] < times[first_pair]);
    return select(times[first_pair + 2] < times[first], first_pair + 2, first);
  }
  int farthest() const {
    const int last = first_pair + (times[first_pair + 1] > times[first_pair]);
    return select(times[first_pair + 2] > times[last], first_pair + 2, last);
  }
  /// The earliest entry; at equal times a wall comes before a ball, and contacts before the rest.
  int earliest() const {
    const int pair = nearest();
    const auto &time = times[pair], &wall_time = times[wall_entry];
    const bool pair_first = (time < wall_time) | ((!hits_wall()) & (time == wall_time));
    const int contact = select(pair_first, pair, wall_entry);
    return select(times[crossing_entry] < times[contact], crossing_entry, contact);
  }

  static constexpr int tied = 64;
  bool hits_wall() const { return wall >= 0; }
  bool wall_is_tied() const { return wall >= tied; }
  int wall_id() const { return wall % tied; }
  int crossing_axis() const { return crossing_face / 2; }
  int crossing_step() const { return crossing_face % 2 ? 1 : -1; }
  int partner_at(int entry) const { return partners[entry - first_pair]; }

  void put_pair(int entry, const Instant<Real>& time, int partner, std::uint32_t latest_impact) {
    times[entry] = time;
    partners[entry - first_pair] = partner;
    known[entry - first_pair] = latest_impact;
  }
  void drop_nearest() {
    const int first = nearest(), last = first_pair + --pair_count;
    put_pair(first, times[last], partners[last - first_pair], known[last - first_pair]);
    times[last] = Instant<Real>::never();
  }
  void drop_pairs() {
    for (int k = 0; k < capacity; ++k) times[first_pair + k] = Instant<Real>::never();
    pair_count = 0;
    forgotten_from = Instant<Real>::never();
  }

  /// True if its values are possible in a run with this many balls and walls.
  bool is_sound(int balls, int walls, std::uint32_t latest_impact) const {
    const bool known_wall = wall >= -1 && (wall < walls || (wall >= tied && wall < tied + walls));
    bool sound = pair_count >= 0 && pair_count <= capacity && crossing_face >= 0 &&
        crossing_face < 6 && known_wall && last_impact <= latest_impact && latest_impact <= 1 << 20;
    for (int k = 0; sound && k < capacity; ++k)
      sound = k < pair_count ? partners[k] >= 0 && partners[k] < balls
                             : times[first_pair + k] == Instant<Real>::never();
    return sound;
  }

  void archive(Archive& a) {
    a(times, wall_pose, forgotten_from, partners, known, last_impact, pair_count, wall,
        crossing_face);
  }
 private:
  static int select(bool condition, int yes, int no) {
    return no ^ ((yes ^ no) & -static_cast<int>(condition));
  }
};

/// The agendas of all balls. Impacts are numbered, by which pair contacts are known to be void.
template <class Real> class Agendas {
 public:
  explicit Agendas(std::size_t balls) : agendas_(balls) {}

  std::size_t size() const { return agendas_.size(); }
  Agenda<Real>& operator[](int ball) { return agendas_[ball]; }
  const Agenda<Real>& operator[](int ball) const { return agendas_[ball]; }

  bool still_holds(const Agenda<Real>& a, int entry) const {
    return agendas_[a.partner_at(entry)].last_impact <= a.known[entry - first_pair];
  }

  /// Numbers the next impact. @param partner  equals `ball` for an impact with a wall
  void number_impact(int ball, int partner) {
    if (latest_impact_ == 1 << 20) renumber_impacts();
    agendas_[ball].last_impact = agendas_[partner].last_impact = ++latest_impact_;
  }
  std::uint32_t latest_impact() const { return latest_impact_; }

  /// Makes the numbers of impacts small again; pair contacts remain valid or void.
  [[gnu::noinline]] void renumber_impacts() {
    for (auto& a : agendas_)
      for (int k = 0; k < a.pair_count; ++k) a.known[k] = still_holds(a, first_pair + k);
    for (auto& a : agendas_) a.last_impact = 1;
    latest_impact_ = 1;
  }

  void archive(Archive& a) { a(agendas_, latest_impact_); }
 private:
  LargeVector<Agenda<Real>> agendas_;
  std::uint32_t latest_impact_ = 0;
};

/// Further data of a ball that events need. In double it is one cache line.
template <class Real> struct alignas(sizeof(Real) == 8 ? 64 : alignof(Real)) Body {
  Vec3<Real> spin;  ///< [rad/s]
  RecentImpacts<Real> recent;
  std::int16_t unmoved = 0;  ///< impacts in a row without time to move, up to the rule's limit
  CellOfBall cell;

  void archive(Archive& a) { a(spin, recent, unmoved, cell); }
};
static_assert(sizeof(Body<double>) == 64);

}  // namespace edmill::engine
