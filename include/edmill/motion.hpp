// A user-defined motion of the vessel.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace edmill {

/// An exact number of turns per drive period of the case.
struct TurnsPerPeriod {
  std::int64_t turns = 0, of = 1;  ///< turns / of; `of` is positive
};

/// amplitude sin(2 pi (frequency t + phase)), t in drive periods.
template <class Real> struct Harmonic {
  Real amplitude;  ///< [m], or [turns] of a rotation
  TurnsPerPeriod frequency{1, 1};
  Real phase{0};  ///< [turns]
};

/// One joint of a chain: it rotates all that follows it about an axis, or translates it.
template <class Real> struct Joint {
  bool rotates = true;
  std::array<Real, 3> axis;     ///< in the frame of the previous joint, of any length; for a
                                ///< translation, of its harmonics
  std::array<Real, 3> shift{};  ///< of a translation [m]
  Real angle{0};                ///< of a rotation, at t = 0 [turns]
  TurnsPerPeriod speed{};       ///< of a rotation, constant
  std::vector<Harmonic<Real>> harmonics{};  ///< along the axis, or about it
};

/// A chain of joints from the ground to the vessel. It replaces the motion of the case but keeps
/// its drive period. Any periodic motion of a rigid body can be written as such a chain, by the
/// Fourier series of its coordinates.
template <class Real> using Joints = std::vector<Joint<Real>>;

}  // namespace edmill
