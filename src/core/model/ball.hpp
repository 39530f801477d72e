// A milling ball: what does not change during a run.
#pragma once

#include "base/vector.hpp"

namespace edmill::model {

template <class Real>
struct BallProperties {
  Real radius;           ///< [m]
  Real mass;             ///< [kg]
  Real reduced_inertia;  ///< J / (m R^2) [1]; 2/5 for a solid sphere
  int material = 0;      ///< for the contact law; 0 where the case names none

  friend bool operator==(const BallProperties& a, const BallProperties& b) = default;
};

/// Position, velocity and spin of a ball at one instant, in the inertial frame.
template <class Real>
struct BallState {
  Vec3<Real> position;  ///< [m]
  Vec3<Real> velocity;  ///< [m/s]
  Vec3<Real> spin;      ///< [rad/s]
};

}  // namespace edmill::model
