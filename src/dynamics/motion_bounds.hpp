// Bounds on the derivatives of a ball's gap functions while it flies inside the moving vessel.
// They are what makes an exclusion a proof. Derivation: docs/theory.md, section 3.
#pragma once

#include <array>
#include <vector>

#include "model/case.hpp"

namespace edmill::dynamics {

/// Suprema over a window of the 2nd, 3rd and 4th time derivatives of the gaps, by kind of wall.
template <class Real>
using DerivativeBounds = std::array<std::array<Real, 3>, model::CylinderVessel<Real>::wall_kinds>;

/// Bounds for a ball of any size whose speed stays below `speed` [m/s] over a window of `length` [s] that it
/// enters inside the vessel.
template <class Real>
DerivativeBounds<Real> derivative_bounds(const model::Mill<Real>& mill, const Real& speed,
                                         const Real& length) {
  const auto [x, y, z] = mill.motion.coordinate_bounds(mill.vessel.half_sizes(), mill.vessel.reach(),
                                                       norm<Real>(mill.gravity), speed, length);
  const Real margin = Real(1) + Real(1) / 65536;  // over the rounding of all this
  const auto square = [](const numerics::Majorant<Real>& c, int k) {
    return numerics::product_bound(c, 0, c, k);
  };
  DerivativeBounds<Real> bounds;
  for (int k = 2; k <= 4; ++k) {
    const auto of_kinds =
        mill.vessel.derivative_bounds(margin * y[k], margin * (square(x, k) + square(z, k)));
    for (std::size_t kind = 0; kind < of_kinds.size(); ++kind) bounds[kind][k - 2] = of_kinds[kind];
  }
  return bounds;
}

/// The bounds tabulated over speed and window length, rounded up.
template <class Real>
class BoundsTable {
 public:
  explicit BoundsTable(const model::Mill<Real>& mill) : mill_(mill) {
    const Real turning = mill.motion.turning();
    const Real quarter = turning > 0 ? Real(1 / (4 * turning)) : mill.motion.period;
    longest_ = mill.motion.period / 8 < quarter ? Real(mill.motion.period / 8) : quarter;
    const Real wall_speed = turning * (mill.motion.arm + mill.vessel.extent());
    speed_step_ = wall_speed > 0 ? Real(wall_speed / 16) : Real(1) / 4;
    per_speed_ = 1 / speed_step_;
    rows_.reserve(speeds * lengths);
    for (int i = 0; i < speeds; ++i)
      for (int j = 0; j < lengths; ++j)
        rows_.push_back(derivative_bounds<Real>(mill_, (i + 1) * speed_step_, longest_ / (1 << j)));
  }

  /// Longest window [s] that the bounds serve.
  const Real& longest_window() const { return longest_; }

  DerivativeBounds<Real> at(const Real& speed, const Real& length) const {
    const Real place = speed * per_speed_;
    if (!(place < speeds - 1)) return derivative_bounds<Real>(mill_, speed, length);
    const int row = static_cast<int>(place);
    int column = 0;  // counted without branches: windows are of any length
    for (int j = 1; j < lengths; ++j) column += length <= longest_ / (1 << j);
    return rows_[row * lengths + column];
  }

 private:
  static constexpr int speeds = 64;
  static constexpr int lengths = 5;
  model::Mill<Real> mill_;
  Real longest_, speed_step_, per_speed_;
  std::vector<DerivativeBounds<Real>> rows_;
};

}  // namespace edmill::dynamics
