// Where the vessel is and how it moves, enclosed. docs/certificates.md, "Rules for the states"
#pragma once

#include <vector>

#include "prove/enclosure.hpp"
#include "prove/exact_case.hpp"

namespace edmill::prove {

/// At a time, or during a bracket of times.
struct Pose {
  Matrix axes;                            ///< R: its columns are the axes of the vessel frame
  Vector centre, velocity, acceleration;  ///< of its origin [m], [m/s], [m/s^2]
  Vector omega, omega_rate;               ///< [rad/s], [rad/s^2]
};

/// Place, velocity and acceleration of a ball in the vessel frame.
struct InVessel {
  Vector place, velocity, acceleration;
};

/// The joints of a case, at the precision in force when it is made.
class Motion {
 public:
  explicit Motion(const ExactCase& exact);

  /// @param time  [s] after the start of the case
  Pose pose(const Enclosure& time) const;
  /// @param position, velocity, gravity  inertial, of a ball in flight
  static InVessel in_vessel(const Pose& pose, const Vector& position, const Vector& velocity,
                            const Vector& gravity);
  static Vector place_in_vessel(const Pose& pose, const Vector& position);
  static Vector direction_to_inertial(const Pose& pose, const Vector& direction);
  static Vector to_inertial(const Pose& pose, const Vector& place) {
    return pose.centre + direction_to_inertial(pose, place);
  }

 private:
  struct Joint {
    bool rotates;
    Vector axis, shift;
    Enclosure angle, speed;
    std::vector<model::Swing<Enclosure>> swings;
  };

  Enclosure start_, turn_;  ///< [s], 2 pi
  std::vector<Joint> joints_;
};

}  // namespace edmill::prove
