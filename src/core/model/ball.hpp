// Milling balls: their constant properties, their states, and the two bodies of an impact.
#pragma once

#include "base/vector.hpp"

namespace edmill::model {

template <class Real> struct BallProperties {
  Real radius;           ///< [m]
  Real mass;             ///< [kg]
  Real reduced_inertia;  ///< J / (m R^2) [1]; 2/5 for a solid sphere
  int material = 0;      ///< for the contact law; 0 where the case names none

  friend bool operator==(const BallProperties& a, const BallProperties& b) = default;
};

/// Position, velocity and spin of a ball at one instant, in the inertial frame.
template <class Real> struct BallState {
  Vec3<Real> position;  ///< [m]
  Vec3<Real> velocity;  ///< [m/s]
  Vec3<Real> spin;      ///< [rad/s]
};

/// Data of the two bodies of an impact that a contact law can use: two balls, or a ball and a wall.
template <class Real> struct ContactBodies {
  Real effective_mass;    ///< M = m_i m_j / (m_i + m_j), for a wall m_i [kg]
  Real radius;            ///< of the ball [m]
  Real other_radius{-1};  ///< of the other ball [m]; negative for a wall

  bool with_wall() const { return other_radius < 0; }
  /// 1/R = 1/R_i + 1/R_j; a wall is flat against a ball [m].
  Real effective_radius() const {
    return with_wall() ? radius : Real(radius * other_radius / (radius + other_radius));
  }
  /// Mean of the balls' diameters [m].
  Real mean_diameter() const {
    return with_wall() ? Real(2 * radius) : Real(radius + other_radius);
  }
};

}  // namespace edmill::model
