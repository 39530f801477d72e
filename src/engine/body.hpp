// What events need of a ball besides its flight.
#pragma once

#include "base/vector.hpp"
#include "engine/cell_grid.hpp"
#include "engine/collapse_watch.hpp"

namespace edmill::engine {

/// In double it is one cache line.
template <class Real>
struct alignas(sizeof(Real) == 8 ? 64 : alignof(Real)) Body {
  Vec3<Real> spin;  ///< [rad/s]
  RecentImpacts<Real> recent;
  CellOfBall cell;

  void archive(Archive& a) { a(spin, recent, cell); }
};
static_assert(sizeof(Body<double>) == 64);

}  // namespace edmill::engine
