// A vessel of the user's own.
#pragma once

#include <array>
#include <vector>

namespace edmill {

/// A flat wall: inside is where the normal's component of a place is below `distance`, in the vessel frame,
/// whose origin is inside.
template <class Real>
struct Plane {
  std::array<Real, 3> normal;  ///< outwards, of any length
  Real distance;               ///< of the plane from the origin [m]
};

/// A convex vessel of 4 to 32 walls, numbered from 0, in place of the one of a case. The case's motion moves
/// it.
template <class Real>
using Planes = std::vector<Plane<Real>>;

}  // namespace edmill
