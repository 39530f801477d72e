// The queue of next events: one entry for each ball, the earliest on top.
#pragma once

#include <vector>

#include "edmill/core/instant.hpp"

namespace edmill::engine {

/// A tournament over the balls' next event times. Setting one time replays log2(N) matches; equal times go to
/// the lower ball, so the order of events does not depend on history.
template <class Real>
class EventQueue {
 public:
  explicit EventQueue(int balls) : times_(balls, Instant<Real>::never()) {
    while (leaves_ < balls) leaves_ *= 2;
    winners_.assign(2 * leaves_, -1);
    for (int i = 0; i < balls; ++i) winners_[leaves_ + i] = i;
    for (int node = leaves_ - 1; node >= 1; --node) winners_[node] = match(node);
  }

  int top() const { return winners_[1]; }
  const Instant<Real>& time(int ball) const { return times_[ball]; }

  void set(int ball, const Instant<Real>& time) {
    times_[ball] = time;
    for (int node = (leaves_ + ball) / 2; node >= 1; node /= 2) {
      const int before = winners_[node];
      winners_[node] = match(node);
      // A match that this ball neither won nor wins changes nothing further up.
      if (before != ball && winners_[node] != ball) return;
    }
  }

  /// The ball whose event is next after the top's, or -1.
  int runner_up() const {
    int best = -1;
    for (int node = leaves_ + top(); node > 1; node /= 2) {
      const int other = winners_[node ^ 1];
      if (other >= 0 && (best < 0 || before(other, best))) best = other;
    }
    return best;
  }

 private:
  bool before(int a, int b) const {
    if (times_[a] < times_[b]) return true;
    return times_[a] == times_[b] && a < b;
  }
  int match(int node) const {
    const int left = winners_[2 * node], right = winners_[2 * node + 1];
    if (right < 0) return left;
    return before(right, left) ? right : left;
  }

  int leaves_ = 1;
  std::vector<Instant<Real>> times_;
  std::vector<int> winners_;
};

}  // namespace edmill::engine
