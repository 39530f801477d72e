// User-defined vessels.
#pragma once

#include <array>
#include <vector>

#include "edmill/polynomial.hpp"

namespace edmill {

/// A flat wall in the vessel frame. Inside, where the origin is, the component of a position along
/// the normal is less than `distance`.
template <class Real> struct Plane {
  std::array<Real, 3> normal;  ///< outwards, of any length
  Real distance;               ///< of the plane from the origin [m]
};

/// A convex vessel of 4 to 32 walls, numbered from 0, in place of the one of a case. The case's
/// motion moves it.
template <class Real> using Planes = std::vector<Plane<Real>>;

/// A convex vessel of 1 to 32 curved or flat walls, numbered from 0, in place of the one of a case.
/// Its walls have no coordinates: outputs that map walls or draw them are refused.
template <class Real> struct CurvedVessel {
  /// One polynomial per wall, of degree 8 at most. It is positive if the centre of a ball of radius
  /// r is inside, decreases as r grows, and is zero where the ball touches the wall; its gradient
  /// must not vanish there. For a cone with its apex at y = a whose radius grows by t with each
  /// metre downwards it is (t (a - y) - sqrt(1 + t^2) r)^2 - x^2 - z^2.
  std::vector<Polynomial<Real>> walls;
  /// Half-edges of a box around the origin that contains the vessel and is not much larger [m]. The
  /// origin need not be in the vessel.
  std::array<Real, 3> half_sizes;
};

}  // namespace edmill
