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
  specific_energy,
  speed,
  angular_speed,
  acceleration,
  density,
  pressure
};

}  // namespace edmill
