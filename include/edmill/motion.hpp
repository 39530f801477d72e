// A motion of the user's own.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace edmill {

/// A number of turns in a drive period of the case, exact.
struct TurnsPerPeriod {
  std::int64_t turns = 0, of = 1;  ///< turns / of; `of` is positive
};

/// amplitude sin(2 pi (frequency t + phase)), t in drive periods.
template <class Real>
struct Harmonic {
  Real amplitude;  ///< [m], or [turns] of a rotation
  TurnsPerPeriod frequency{1, 1};
  Real phase{0};  ///< [turns]
};

/// Turns what comes behind it about an axis, or shifts it.
template <class Real>
struct Joint {
  bool rotates = true;
  std::array<Real, 3>
      axis;  ///< in the frame of the joint before, of any length; of a translation that of its harmonics
  std::array<Real, 3> shift{};              ///< of a translation [m]
  Real angle{0};                            ///< of a rotation, at t = 0 [turns]
  TurnsPerPeriod speed{};                   ///< of a rotation, constant
  std::vector<Harmonic<Real>> harmonics{};  ///< along the axis, or about it
};

/// From the ground to the vessel, in place of the motion of a case, whose drive period remains: any periodic
/// motion of a rigid body is such a chain, by the Fourier series of its coordinates.
template <class Real>
using Joints = std::vector<Joint<Real>>;

}  // namespace edmill
