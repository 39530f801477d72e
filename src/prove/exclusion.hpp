// Proofs that bodies do not meet while a flight is flown. docs/certificates.md, rules 4 and 5
#pragma once

#include <map>
#include <string>

#include "prove/flight.hpp"

namespace edmill::prove {

/// A flight between two impacts.
struct Span {
  const Flight& flight;
  Enclosure begin, end;                ///< [s], exact: it is flown within these
  int begin_wall = -1, end_wall = -1;  ///< the wall of the impact at either end; -1 for none
};

/// Proves that one flight meets no wall between its ends.
class WallExclusion {
 public:
  /// @param motion, walls  for the ball; arithmetic is that of the precision in force
  WallExclusion(const Motion& motion, const Walls& walls, const Vector& gravity, const Span& span)
      : motion_(motion), walls_(walls), gravity_(gravity), span_(span) {}

  /// The windows: "r2p2p1". Empty when a bisection this deep does not prove it.
  std::string windows(std::size_t wall);

 private:
  static constexpr int deepest = 14;
  /// In a window: the ball at its middle, and within all of it.
  struct Window {
    Enclosure length_from_middle;
    InVessel middle, all;
  };
  const Window& window(int depth, long index);
  bool bisect(std::size_t wall, int depth, long index, std::string& text);

  const Motion& motion_;
  const Walls& walls_;
  const Vector& gravity_;
  const Span& span_;
  std::map<std::pair<int, long>, Window> windows_;
};

/// Whether two flights are proven not to touch from `begin` to `end`.
bool apart(const Flight& one, const Flight& two, const Enclosure& reach, const Vector& gravity,
           const Enclosure& begin, const Enclosure& end);

/// The gap of two flights at a time. @param reach  R_i + R_j
PairGap pair_gap(const Flight& one, const Flight& two, const Enclosure& reach, const Vector& gravity,
                 const Enclosure& time);

}  // namespace edmill::prove
