// What can happen next.
#pragma once

#include <algorithm>
#include <tuple>

#include "base/instant.hpp"

namespace edmill::engine {

enum class EventKind {
  wall_contact,
  pair_contact,
  void_contact,   ///< a pair contact whose partner has had an impact since it was predicted
  cell_crossing,  ///< a ball leaves its cell of the grid
  wall_horizon,   ///< up to here walls are proven out of reach; the search goes on
};

template <class Real>
struct Event {
  EventKind kind;
  Instant<Real> time;
  int ball;
  int partner = -1;      ///< a wall or a ball
  bool by_rule = false;  ///< a rule put it before another contact

  bool involves(int other) const {
    return ball == other || (kind == EventKind::pair_contact && partner == other);
  }
  bool shares_ball(const Event& other) const {
    return involves(other.ball) || (other.kind == EventKind::pair_contact && involves(other.partner));
  }
  bool same_bodies(const Event& other) const {
    if (kind != other.kind) return false;
    return (ball == other.ball && partner == other.partner) ||
           (kind == EventKind::pair_contact && ball == other.partner && partner == other.ball);
  }
  /// The rule for contacts at one time: a wall goes before a ball, then the lower numbers.
  bool goes_before(const Event& other) const {
    const auto place = [](const Event& e) {
      const bool pair = e.kind == EventKind::pair_contact;
      return std::tuple(pair, pair ? std::min(e.ball, e.partner) : e.ball,
                        pair ? std::max(e.ball, e.partner) : e.partner);
    };
    return place(*this) < place(other);
  }
};

}  // namespace edmill::engine
