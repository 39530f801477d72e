// What events need of a ball besides its flight.
#pragma once

#include <cstdint>

#include "base/vector.hpp"
#include "engine/cell_grid.hpp"
#include "engine/collapse_watch.hpp"

namespace edmill::engine {

/// In double it is one cache line.
template <class Real>
struct alignas(sizeof(Real) == 8 ? 64 : alignof(Real)) Body {
  Vec3<Real> spin;  ///< [rad/s]
  RecentImpacts<Real> recent;
  std::int16_t unmoved = 0;  ///< impacts in a row that came without time to move, up to where friction rests
  CellOfBall cell;

  void archive(Archive& a) { a(spin, recent, unmoved, cell); }
};
static_assert(sizeof(Body<double>) == 64);

}  // namespace edmill::engine
