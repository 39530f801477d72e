// Bounds on the derivatives of a ball's gap functions while it flies inside the moving vessel.
// They are what makes an exclusion a proof. Derivation: docs/theory.md, section 3.
#pragma once

#include <array>
#include <optional>
#include <type_traits>
#include <vector>

#include "dynamics/gap_functions.hpp"

namespace edmill::dynamics {

/// Suprema over a window of the 2nd, 3rd and 4th time derivatives of the gaps, by kind of wall.
template <class V>
using DerivativeBounds = typename V::template PerKind<std::array<typename V::Scalar, 3>>;

/// Bounds for a ball of any size whose speed stays below `speed` [m/s] over a window of `length` [s] that it
/// enters inside the vessel.
template <class M, class V, class Real = typename M::Scalar>
DerivativeBounds<V> derivative_bounds(const MovingVessel<M, V>& mill, const Real& speed, const Real& length) {
  const auto coordinates = mill.motion.coordinate_bounds(mill.vessel.half_sizes(), mill.vessel_reach,
                                                         mill.gravity_size, speed, length);
  const Real margin = Real(1) + Real(1) / 65536;  // over the rounding of all this
  DerivativeBounds<V> bounds{};
  for (int k = 2; k <= 4; ++k) {
    const auto of_kinds = mill.vessel.derivative_bounds(coordinates, k);
    if constexpr (requires { bounds.resize(of_kinds.size()); }) bounds.resize(of_kinds.size());
    Real of_pistons(0);
    if constexpr (model::HasPistons<V>)
      if (const auto* pistons = mill.vessel.pistons()) of_pistons = pistons->bound(k);
    for (std::size_t kind = 0; kind < of_kinds.size(); ++kind)
      bounds[kind][k - 2] = margin * (of_kinds[kind] + of_pistons);
  }
  return bounds;
}

/// The bounds tabulated over speed and window length, rounded up.
template <class M, class V>
class BoundsTable {
 public:
  using Real = typename M::Scalar;
  using Row = std::conditional_t<std::is_same_v<Real, double>, DerivativeBounds<V>,
                                 std::optional<DerivativeBounds<V>>>;

  explicit BoundsTable(const MovingVessel<M, V>& mill) : mill_(mill), longest_(mill.motion.longest_window()) {
    if constexpr (model::HasPistons<V>)
      if (const auto* pistons = mill.vessel.pistons())
        if (const Real longest = pistons->longest_window(); longest < longest_) longest_ = longest;
    const Real wall_speed = mill.motion.speed_within(mill.motion.reach(mill.vessel.extent()));
    speed_step_ = wall_speed > 0 ? Real(wall_speed / 16) : Real(1) / 4;
    per_speed_ = 1 / speed_step_;
    rows_.resize(speeds * lengths);
    if constexpr (std::is_same_v<Real, double>)
      for (int row = 0; row < speeds * lengths; ++row) rows_[row] = made(row);
  }

  /// Longest window [s] that the bounds serve.
  const Real& longest_window() const { return longest_; }

  DerivativeBounds<V> at(const Real& speed, const Real& length) const {
    const Real place = speed * per_speed_;
    if (!(place < speeds - 1)) return derivative_bounds(mill_, speed, length);
    const int row = static_cast<int>(place);
    int column = 0;  // counted without branches: windows are of any length
    for (int j = 1; j < lengths; ++j) column += length <= longest_ / (1 << j);
    auto& bounds = rows_[row * lengths + column];
    // Wide scalars, which decide seldom, need few of them.
    if constexpr (!std::is_same_v<Real, double>)
      if (!bounds) bounds = made(row * lengths + column);
    return value_of(bounds);
  }

 private:
  static constexpr int speeds = 64;
  static constexpr int lengths = 5;

  static const DerivativeBounds<V>& value_of(const DerivativeBounds<V>& row) { return row; }
  static const DerivativeBounds<V>& value_of(const std::optional<DerivativeBounds<V>>& row) { return *row; }
  DerivativeBounds<V> made(int row) const {
    return derivative_bounds(mill_, Real((row / lengths + 1) * speed_step_),
                             Real(longest_ / (1 << row % lengths)));
  }

  MovingVessel<M, V> mill_;
  Real longest_, speed_step_, per_speed_;
  mutable std::vector<Row> rows_;
};

}  // namespace edmill::dynamics
