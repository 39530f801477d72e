// Physical dimensions of the quantities in a case file.
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
