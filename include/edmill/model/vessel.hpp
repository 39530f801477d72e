// The vessel: a closed cylinder about the y axis of the vessel frame.
#pragma once

#include <array>

namespace edmill::model {

/// Wall ids follow the thesis: 0 is the cap at y = -h/2, 1 the cap at y = +h/2, 2 the cylinder.
inline constexpr int wall_count = 3;

template <class Real>
struct CylinderVessel {
  Real radius;       ///< inner radius R_v [m]
  Real half_height;  ///< h/2 [m]
};

}  // namespace edmill::model
