// The vessel: a closed cylinder about the y axis of the vessel frame.
#pragma once

#include <array>

namespace edmill::model {

/// Wall ids follow the thesis: 0 is the cap at y = -h/2, 1 the cap at y = +h/2, 2 the cylinder.
inline constexpr int wall_count = 3;

/// What a ball can collide with, as tables count it: the walls by id, then other balls.
inline constexpr int partner_kinds = wall_count + 1;
inline constexpr int ball_ball = wall_count;

/// The name of a partner, everywhere.
struct PartnerInfo {
  const char* key;      ///< in files
  const char* label;    ///< for readers
  const char* meaning;  ///< of what counts its impacts
};
/// By place: the walls by id, then other balls.
inline constexpr std::array<PartnerInfo, partner_kinds> partners = {{
    {"wall_0", "cap -y", "with wall 0, the cap at -y"},
    {"wall_1", "cap +y", "with wall 1, the cap at +y"},
    {"wall_2", "cylinder", "with wall 2, the cylinder"},
    {"ball_ball", "ball-ball", "between balls"},
}};

template <class Real>
struct CylinderVessel {
  Real radius;       ///< inner radius R_v [m]
  Real half_height;  ///< h/2 [m]
};

}  // namespace edmill::model
