// In which impacts of a log friction rests. docs/theory.md, section 6
#pragma once

#include <algorithm>
#include <vector>

#include "audit/event_log.hpp"
#include "audit/tolerances.hpp"
#include "model/case.hpp"

namespace edmill::audit {

/// What friction does in an impact; either, where the log does not tell how long the flights before were.
enum class Friction { acts, rests, either };

/// Counts each ball's impacts in a row that came without time to move, between a least and a most number.
class StallHistory {
 public:
  explicit StallHistory(const model::Mill<double>& mill, std::size_t balls)
      : mill_(mill), balls_(balls, Ball{unknown, 0, mill.stall.impacts}) {}

  /// All flights begin at `time`: the log has what follows from then on.
  void begin(double time) { std::fill(balls_.begin(), balls_.end(), Ball{time, 0, 0}); }
  /// Events of the ball are missing.
  void forget(int ball) { balls_[ball] = {unknown, 0, mill_.stall.impacts}; }

  /// The next event. @param relative  tolerance of logged times
  Friction take(const LoggedEvent& event, const model::ContactLaw<double>& law, double relative) {
    const Friction one = count(event.ball, event.time, law, relative);
    if (event.with_wall) return one;
    const Friction other = count(event.partner, event.time, law, relative);
    if (one == Friction::rests || other == Friction::rests) return Friction::rests;
    return one == other ? one : Friction::either;
  }

 private:
  struct Ball {
    double time;      ///< of its last impact; unknown at first [s]
    int least, most;  ///< impacts in a row without time to move
  };

  Friction count(int k, double time, const model::ContactLaw<double>& law, double relative) {
    Ball& ball = balls_[k];
    const int enough = mill_.stall.impacts;
    const double flight = time - ball.time, off = 2 * Tolerances::time(time) + relative * std::abs(flight);
    const bool may_have_moved =
        std::isnan(flight) || mill_.stall.has_moved(flight + off, law.least_separation);
    const bool has_moved = !std::isnan(flight) && mill_.stall.has_moved(flight - off, law.least_separation);
    const Friction friction = has_moved || ball.most < enough           ? Friction::acts
                              : !may_have_moved && ball.least >= enough ? Friction::rests
                                                                        : Friction::either;
    ball.time = time;
    ball.most = has_moved ? 0 : std::min(ball.most + 1, enough);
    ball.least = may_have_moved ? 0 : std::min(ball.least + 1, enough);
    return friction;
  }

  const model::Mill<double>& mill_;
  std::vector<Ball> balls_;
};

}  // namespace edmill::audit
