// Vessels of the user's own.
#pragma once

#include <array>
#include <vector>

#include "edmill/polynomial.hpp"

namespace edmill {

/// A flat wall: inside is where a position's component along the normal is below `distance`, in the vessel
/// frame, whose origin is inside.
template <class Real>
struct Plane {
  std::array<Real, 3> normal;  ///< outwards, of any length
  Real distance;               ///< of the plane from the origin [m]
};

/// A convex vessel of 4 to 32 walls, numbered from 0, in place of the one of a case. The case's motion moves
/// it.
template <class Real>
using Planes = std::vector<Plane<Real>>;

/// A convex vessel of 1 to 32 curved or flat walls, numbered from 0, in place of the one of a case. Its walls
/// have no coordinates: outputs that map walls or draw them are refused.
template <class Real>
struct CurvedVessel {
  /// Of each wall a polynomial of at most degree 8 that is positive where the centre of a ball of radius r is
  /// inside, falls as r grows, and is zero where the ball touches the wall. That of a cone with its apex at y
  /// = a whose radius grows by t with each metre downwards: (t (a - y) - sqrt(1 + t^2) r)^2 - x^2 - z^2. The
  /// gradient of a wall must not vanish where a ball touches it.
  std::vector<Polynomial<Real>> walls;
  /// Half the edges of a box about the origin that has the vessel inside [m], and is not much larger; the
  /// origin need not be in the vessel.
  std::array<Real, 3> half_sizes;
};

}  // namespace edmill
