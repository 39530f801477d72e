// Escalation: a decision that a scalar cannot make is left to the next wider one, for one state.
#pragma once

#include <memory>
#include <vector>

#include "dynamics/pair_search.hpp"
#include "dynamics/wall_search.hpp"
#include "model/outcome.hpp"

namespace edmill::dynamics {

/// A predicted contact with its flights, so that a wider scalar can recompute its time.
template <class Real> struct Contact {
  bool with_wall;
  Flight<Real> flight;   ///< of the ball; for a pair the one of the two flights that started later
  Flight<Real> partner;  ///< of a pair
  Real radius;           ///< of the ball, or the sum of both radii
  Instant<Real> time;    ///< as predicted
  int wall = -1;
};

/// The searches of one mill in one scalar, and the next rung of the ladder.
template <class Real> class DecisionLadder {
  using Query = WallQuery<Real>;
  using Answer = WallAnswer<Real>;
  using Contact = dynamics::Contact<Real>;
 public:
  /// @param smallest_sum  least sum of two radii in the case [m]
  /// @param top_speed     no ball is faster [m/s]; `raise_top_speed` increases it
  DecisionLadder(const model::Mill<Real>& mill, const Real& smallest_sum, const Real& top_speed);
  ~DecisionLadder();
  DecisionLadder(DecisionLadder&&) noexcept;

  /// Certified answer to a wall query; `pose` is the vessel's at the begin of the window.
  /// @throws UndecidedError, with the state, only for a defect: the widest scalar decides all
  Answer wall(const model::AnyPose<Real>& pose, const Query& query) {
    const auto answer = walls_.search(pose, query);
    return is_settled(answer) ? answer : wall_above(query);
  }
  Answer wall(const Query& query) {
    const auto answer = walls_(query);
    if constexpr (std::is_void_v<Wider<Real>>) passed_up_.wall += answer.by_rule;
    return is_settled(answer) ? answer : wall_above(query);
  }

  /// Certified answer for two balls from `now` on; see PairSearch.
  PairAnswer<Real> pair(const Flight<Real>& i, const Flight<Real>& j, const Instant<Real>& now,
      const Real& radius_sum) {
    return pair(pairs_.state(i, now), i, j, now, radius_sum);
  }
  PairAnswer<Real> pair(const typename PairSearch<Real>::State& seen, const Flight<Real>& i,
      const Flight<Real>& j, const Instant<Real>& now, const Real& radius_sum) {
    const auto answer = pairs_(seen, j, now, radius_sum);
    return is_settled(answer) ? answer : pair_above(i, j, now, radius_sum);
  }

  /// Orders two contacts that share a ball: negative if `a` comes first, positive if `b` does, zero
  /// if they are simultaneous or no rung of the ladder separates them.
  int order(const Contact& a, const Contact& b);

  /// Contacts closer in time than this [s] are ordered by `order`. Far above the rounding of most
  /// contact times; one whose error exceeds a quarter of it is recomputed by the next rung.
  const Real& tie_window() const { return pairs_.tie_window(); }

  void raise_top_speed(const Real& speed);

  const AnyWallSearch<Real>& walls() const { return walls_; }
  AnyWallSearch<Real>& walls() { return walls_; }
  const PairSearch<Real>& pairs() const { return pairs_; }

  /// Decisions passed to each wider scalar, narrowest first, and last those made by a rule.
  std::vector<model::Escalations> escalations() const;

  /// Saves or loads the counters; all else follows from the mill and the top speed.
  void archive(Archive& a);
 private:
  bool is_settled(const auto& answer) const {
    if (answer.verdict == Verdict::undecided) return false;
    // The top rung accepts any time error, since no wider scalar can reduce it.
    return std::is_void_v<Wider<Real>> || answer.verdict == Verdict::none ||
        4 * answer.time_error <= tie_window();
  }
  Answer wall_above(const Query& query);
  PairAnswer<Real> pair_above(const Flight<Real>& i, const Flight<Real>& j,
      const Instant<Real>& now, const Real& radius_sum);
  /// Bound on the error of rounding a time from a wider scalar to this one [s].
  Real rounding() const { return 4 * epsilon<Real>() * pairs_.clock().period(); }
  struct Timed {
    Instant<Real> time;
    Real time_error;  ///< [s]
  };
  Timed time_of(const Contact& contact);

  struct Above;  // the next rung
  Above& above();

  model::Mill<Real> mill_;
  Real smallest_sum_;
  AnyWallSearch<Real> walls_;
  PairSearch<Real> pairs_;
  model::Escalations passed_up_;
  std::unique_ptr<Above> above_;
};

extern template class DecisionLadder<double>;

}  // namespace edmill::dynamics
