// Data of an impact and the state of a ball, as programs receive them.
#pragma once

#include <array>
#include <cstdint>

namespace edmill {

template <class Real> using Vector = std::array<Real, 3>;

/// State of a ball in the inertial frame, whose Z axis is the axis of the fulcrum.
template <class Real> struct BallState {
  Vector<Real> position;  ///< of the centre [m]
  Vector<Real> velocity;  ///< [m/s]
  Vector<Real> spin;      ///< [rad/s]
};

/// One impact as programs receive it. All vectors are in the inertial frame.
template <class Real> struct Impact {
  std::uint64_t index;          ///< counts from 0 since the start of the run
  Real time;                    ///< [s]
  int ball;                     ///< its id
  bool with_wall;               ///< whether the partner is a wall
  int partner;                  ///< ball or wall id
  Vector<Real> normal;          ///< unit, from the partner to the ball
  Real approach_speed;          ///< of the contact points along the normal, before [m/s]
  Real slip_speed;              ///< of the contact points across the normal, before [m/s]
  Real separation_speed;        ///< of the contact points along the normal, after [m/s]
  Real restitution_tangential;  ///< e_t, the slip after the impact over the slip before it
  Real normal_impulse;          ///< [N s]
  Real tangential_impulse;      ///< [N s]
  Real milling_dose;            ///< kinetic energy that the impact dissipates [J]
  Real supplied_energy;         ///< energy added by the least separation speed [J]
  Real wall_work;               ///< work of the moving wall on the ball [J]
};

}  // namespace edmill
