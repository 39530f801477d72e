// Where the vessel and the solids in it are, how they move, and how far their surfaces are:
// docs/certificates.md, "Rules for the states".
#pragma once

#include <array>

#include "mill.hpp"

namespace checker {

/// The vessel or a solid at a time, or at all times of a bracket. Its frame is meant by "vessel
/// frame".
struct Pose {
  std::array<Vec, 3> rows{Vec{1, 0, 0}, Vec{0, 1, 0}, Vec{0, 0, 1}};  ///< of the rotation R
  Vec origin{};                                                       ///< C
  Vec origin_velocity{};                                              ///< V
  Vec angular_velocity{};                                             ///< w

  /// R x, of a vector in the vessel frame
  Vec to_inertial(const Vec& x) const {
    return {dot(rows[0], x), dot(rows[1], x), dot(rows[2], x)};
  }

  /// R^T x, of an inertial vector
  Vec to_vessel(const Vec& x) const { return rows[0] * x[0] + rows[1] * x[1] + rows[2] * x[2]; }

  /// p = R^T (r - C), the place in the vessel frame of what is at r
  Vec place(const Vec& r) const { return to_vessel(r - origin); }

  /// u = R^T (v - (V + w x (r - C))), the velocity in the vessel frame of what moves with v at r
  Vec velocity(const Vec& r, const Vec& v) const {
    return to_vessel(v - (origin_velocity + cross(angular_velocity, r - origin)));
  }
};

/// Of the vessel.
Pose pose_of(const Mill& mill, const Real& time);

/// Of the vessel, or of the wall that is a solid.
Pose pose_of(const Mill& mill, const Wall& wall, const Real& time);

/// The gap f between a wall and a ball at the place p in the vessel frame (rule 2).
Real gap(const Wall& wall, const Ball& ball, const Vec& p);

/// f' where the ball moves with the velocity u in the vessel frame.
Real gap_rate(const Wall& wall, const Vec& p, const Vec& u);

/// The normal N from the wall to the ball, a unit vector, where the ball touches the wall.
Vec normal(const Wall& wall, const Ball& ball, const Vec& p);

}  // namespace checker
