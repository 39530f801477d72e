// Finds room for balls where random placement finds none.
#pragma once

#include <vector>

#include "base/vector.hpp"
#include "model/vessel.hpp"

namespace edmill::casefile {

/// A ball of a crowd. All places are in double, whatever the scalar of the run, and so exact in all of them.
struct CrowdBall {
  double radius;                      ///< [m]
  double gap_ball = 0, gap_wall = 0;  ///< to balls before it and to walls [m]
  Vec3<double> place;                 ///< of the centre, vessel frame [m]
  bool fixed = false;                 ///< stays where it is
};

/// Moves balls apart, from places inside the vessel where they may overlap, until none is closer to another
/// or to a wall than `share` of its gaps. The moves are projections: each pair that is too close is parted
/// along the line of its centres, each ball beyond a wall goes back along the normal.
/// @param moved  how far each wall stands inside the vessel, for pistons; empty where none does [m]
/// @return false when they were not apart after a number of sweeps that depends on nothing but their number
bool push_apart(const model::AnyVessel<double>& vessel, const std::vector<double>& moved,
                std::vector<CrowdBall>& balls, double share);

}  // namespace edmill::casefile
