// Equal sectors of a circle.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "base/trigonometry.hpp"

namespace edmill::output {

/// Finds the sector of a direction by the side of the edges on which it lies: no arc tangent.
template <class Real>
class Sectors {
 public:
  explicit Sectors(std::size_t count) {
    for (std::size_t k = 0; k < count; ++k)
      edges_.push_back(numerics::sin_cos_turns<Real>(Real(k) / Real(count)));
  }

  std::size_t count() const { return edges_.size(); }

  /// @return k when the angle from x to z is in [k, k + 1) of 2 pi / count; any for no direction
  std::size_t holding(const Real& x, const Real& z) const {
    const bool second_half = z < 0 || (z == 0 && x < 0);
    const auto passed = [&](const numerics::SinCos<Real>& edge) {
      const std::size_t k = static_cast<std::size_t>(&edge - edges_.data());
      const bool edge_in_second_half = 2 * k >= edges_.size();
      if (edge_in_second_half != second_half) return second_half;
      return edge.cos * z - edge.sin * x >= 0;
    };
    const auto next = std::partition_point(edges_.begin(), edges_.end(), passed);
    return next == edges_.begin() ? 0 : static_cast<std::size_t>(next - edges_.begin()) - 1;
  }

 private:
  std::vector<numerics::SinCos<Real>> edges_;  ///< of each sector's beginning
};

}  // namespace edmill::output
