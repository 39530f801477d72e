// Physical dimensions of what a case file gives.
#pragma once

namespace edmill {

enum class Dimension {
  none,
  length,
  mass,
  time,
  angle,
  energy,
  speed,
  angular_speed,
  acceleration,
  density,
  pressure
};

}  // namespace edmill
