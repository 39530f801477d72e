// Rule 3: what an impact does to the balls. docs/certificates.md, "Rules for the states"
#pragma once

#include <array>

#include "motion.hpp"

namespace checker {

// The functions here throw Violation where the enclosures do not decide which case of a law holds.

/// "Stalls": counts the impacts in a row before which each ball has not moved.
class Stalls {
 public:
  explicit Stalls(Index balls) : unmoved_(balls) {}

  /// Counts an impact of a ball, this long after its last event.
  /// @return whether this ball has not moved before it and 32 or more impacts before
  bool stalled(Index ball, const Law& law, const Real& elapsed);
 private:
  std::vector<int> unmoved_;
};

/// "Wall": the state after an impact in this bracket, at its middle.
State after_wall_impact(
    const Motion& motion, Index ball, Index wall, const Real& bracket, bool in_stall);

/// "Pair": the states of both balls.
std::array<State, 2> after_pair_impact(
    const Motion& motion, Index i, Index j, const Real& bracket, bool in_stall);

}  // namespace checker
