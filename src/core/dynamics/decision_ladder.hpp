// Escalation: what one scalar cannot decide, the next wider one does, for the state as stored.
#pragma once

#include <memory>
#include <vector>

#include "dynamics/pair_search.hpp"
#include "dynamics/wall_search.hpp"
#include "model/outcome.hpp"

namespace edmill::dynamics {

/// A predicted contact with what it was predicted from, so that a wider scalar can time it anew.
template <class Real>
struct Contact {
  bool with_wall;
  Flight<Real> flight;   ///< of the ball; for a pair the one of the two flights that started later
  Flight<Real> partner;  ///< of a pair
  Real radius;           ///< of the ball, or the sum of both radii
  Instant<Real> time;    ///< as predicted
  int wall = -1;
};

/// The searches of one mill in one scalar, with the rung above them.
template <class Real>
class DecisionLadder {
 public:
  /// @param smallest_sum  least sum of two radii in the case [m]
  /// @param top_speed     no ball is faster [m/s]; `raise_top_speed` mends it
  DecisionLadder(const model::Mill<Real>& mill, const Real& smallest_sum, const Real& top_speed);
  ~DecisionLadder();
  DecisionLadder(DecisionLadder&&) noexcept;

  /// Certified answer for a wall query; `pose` is the vessel's at its begin, where the caller knows it.
  /// @throws UndecidedError for a fault of the search: the widest scalar decides all; its text reproduces the
  /// state
  WallAnswer<Real> wall(const model::AnyPose<Real>& pose, const WallQuery<Real>& query) {
    const auto answer = walls_.search(pose, query);
    return is_settled(answer) ? answer : wall_above(query);
  }
  WallAnswer<Real> wall(const WallQuery<Real>& query) {
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

  /// Which of two contacts that share a ball comes first: negative `a`, positive `b`, zero when they come at
  /// one time, or no rung of the ladder separates them.
  int order(const Contact<Real>& a, const Contact<Real>& b);

  /// Contacts closer in time than this [s] are handed to `order`. Far more than rounding puts between most;
  /// a contact whose time is not sharper than a quarter of it is timed by the next rung.
  const Real& tie_window() const { return pairs_.tie_window(); }

  void raise_top_speed(const Real& speed);

  const AnyWallSearch<Real>& walls() const { return walls_; }
  AnyWallSearch<Real>& walls() { return walls_; }
  const PairSearch<Real>& pairs() const { return pairs_; }

  /// One entry for each wider scalar, narrowest first, and one for what a rule decides.
  std::vector<model::Escalations> escalations() const;

  /// What it has counted. The rest follows from the mill and the top speed, which is the owner's.
  void archive(Archive& a);

 private:
  template <class Answer>
  bool is_settled(const Answer& answer) const {
    if (answer.verdict == Verdict::undecided) return false;
    // The top has nothing above that knows a time better.
    return std::is_void_v<Wider<Real>> || answer.verdict == Verdict::none ||
           4 * answer.time_error <= tie_window();
  }
  WallAnswer<Real> wall_above(const WallQuery<Real>& query);
  PairAnswer<Real> pair_above(const Flight<Real>& i, const Flight<Real>& j, const Instant<Real>& now,
                              const Real& radius_sum);
  /// What rounding a wider time to this scalar does to it at most [s].
  Real rounding() const { return 4 * epsilon<Real>() * pairs_.clock().period(); }
  struct Timed {
    Instant<Real> time;
    Real time_error;  ///< [s]
  };
  Timed time_of(const Contact<Real>& contact);
  int order_by_exact_times(const Contact<Real>& a, const Contact<Real>& b);

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
