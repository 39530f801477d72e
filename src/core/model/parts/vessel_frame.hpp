// What motions and vessels tell a search about a ball in the vessel frame.
#pragma once

#include "base/majorant.hpp"
#include "base/vector.hpp"

namespace edmill::model {

/// Position and velocity of a body as seen in the vessel frame.
template <class Real>
struct VesselFrameState {
  Vec3<Real> position;  ///< [m]
  Vec3<Real> velocity;  ///< time derivative of `position` [m/s]
};

/// Bounds on the coordinates in the vessel frame of a ball in flight, and on their first four derivatives.
template <class Real>
struct CoordinateBounds {
  numerics::Majorant<Real> x, y, z;
};

/// Bounds on what rounding does to a function of time and to its first two derivatives.
template <class Real>
struct ErrorBounds {
  Real value, rate, second;
};

/// What bounds the rounding of a flight's coordinates.
template <class Real>
struct FlightBounds {
  Real reach;                                    ///< of the flight from the origin at most [m]
  Real gravity;                                  ///< [m/s^2]
  Real speed;                                    ///< inertial, at most [m/s]
  Real elapsed;                                  ///< since the start of the flight at most [s]
  Real lag;                                      ///< from the flight's drive period to the window's [s]
  Real vessel_speed{0}, vessel_acceleration{0};  ///< of the ball in the vessel frame at most [m/s], [m/s^2]
};

/// The box that a vessel sweeps, in inertial coordinates [m].
template <class Real>
struct SweptBox {
  Vec3<Real> low, high;
};

}  // namespace edmill::model
