// Dose rates with their 95 % intervals.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/statistics.hpp"

namespace edmill::dem {

/// From batches of equal duration.
class DoseRate {
 public:
  static constexpr std::size_t batches = 24;

  /// @param first, last  of the record [s]
  DoseRate(double first, double last) : first_(first), length_((last - first) / batches), rates_(batches) {}

  void add(double time, double dose) {
    const double place = (time - first_) / length_;
    if (place >= 0) rates_[static_cast<std::size_t>(std::min(place, batches - 1.0))] += dose / length_;
  }
  /// [W]
  double mean() const { return *numerics::estimate(rates_).mean; }
  /// Half of the width of the 95 % interval [W].
  double half_width() const { return *numerics::estimate(rates_).half_width; }

 private:
  double first_, length_;
  std::vector<double> rates_;
};

}  // namespace edmill::dem
