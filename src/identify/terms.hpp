// The terms of the equations that are checked: a code may have one of them larger, smaller, reversed or not
// at all.
#pragma once

#include <string>

#include "base/dimension.hpp"

namespace edmill::identify {

/// What each term is multiplied by, 1, or shifted by, 0, where a code has it as docs/theory.md does.
struct Terms {
  // impacts
  double friction = 1, friction_on_velocity = 1, torque = 1, share = 1;
  double compliance_in_limit = 1, compliance_in_impulse = 1;  ///< of c - 1
  double arm = 1;
  enum class EqualBalls {
    no,
    limit_of_sliding,
    friction,
    masses
  } equal_balls = EqualBalls::no;                     ///< formulas for them
  double wall_velocity = 1, wall_velocity_delay = 0;  ///< delay [s]
  int wall_velocity_formula = 0;                      ///< audit::WallVelocity
  double wall_work = 1, dose = 1, spin_in_dose = 1, work_in_dose = 1, supply_in_dose = 1;
  double approach_speed = 1, slip_speed = 1;
  double contact_gap = 0;  ///< at which bodies meet [m]
  // flights
  double gravity = 1, gravity_in_places = 1, gravity_in_velocities = 1, spin_in_flight = 1;
  double time_of_flight = 0, age_of_velocities = 0;  ///< [s]

  bool operator==(const Terms&) const = default;
  /// Whether the states after an impact are others.
  bool change_impulse() const {
    return friction != 1 || friction_on_velocity != 1 || torque != 1 || share != 1 ||
           compliance_in_limit != 1 || compliance_in_impulse != 1 || arm != 1 ||
           equal_balls != EqualBalls::no;
  }
};

/// "reversed", "left out", "doubled", "halved", where an interval holds such a factor and little else; else
/// empty.
std::string word_for(double factor, double half_width);

}  // namespace edmill::identify
