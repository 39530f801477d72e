// What is known of an impact and of a ball.
#pragma once

#include <array>
#include <cstdint>

namespace edmill {

template <class Real>
using Vector = std::array<Real, 3>;

/// In the inertial frame: Z is the fulcrum's axis.
template <class Real>
struct BallState {
  Vector<Real> position;  ///< of the centre [m]
  Vector<Real> velocity;  ///< [m/s]
  Vector<Real> spin;      ///< [rad/s]
};

/// One impact as programs see it: plain numbers, vectors inertial.
template <class Real>
struct Impact {
  std::uint64_t index;          ///< counts from 0 since the start of the run
  Real time;                    ///< [s]
  int ball;                     ///< its id
  bool with_wall;               ///< whether the partner is a wall
  int partner;                  ///< ball or wall id
  Vector<Real> normal;          ///< unit, from the partner to the ball
  Real approach_speed;          ///< of the contact points along the normal, before [m/s]
  Real slip_speed;              ///< of the contact points across the normal, before [m/s]
  Real separation_speed;        ///< of the contact points along the normal, after [m/s]
  Real restitution_tangential;  ///< e_t, the part of the slip that is left
  Real normal_impulse;          ///< [N s]
  Real tangential_impulse;      ///< [N s]
  Real milling_dose;            ///< kinetic energy that the impact takes away [J]
  Real supplied_energy;         ///< by the least separation speed [J]
  Real wall_work;               ///< of the moving wall on the ball [J]
};

}  // namespace edmill
