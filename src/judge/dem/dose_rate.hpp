// Dose rates with their 95 % intervals.
#pragma once

#include <algorithm>
#include <vector>

#include "base/statistics.hpp"

namespace edmill::dem {

/// From batches of equal duration, of which neighbours may be correlated.
class DoseRate {
 public:
  static constexpr std::size_t batches = 64;

  /// @param first, last  of the record [s]
  DoseRate(double first, double last) : first_(first), length_((last - first) / batches), rates_(batches) {}

  void add(double time, double dose) {
    const double place = (time - first_) / length_;
    if (place >= 0) rates_[static_cast<std::size_t>(std::min(place, batches - 1.0))] += dose / length_;
  }
  /// [W]
  numerics::Estimate estimate() const { return numerics::series_estimate(rates_); }

 private:
  double first_, length_;
  std::vector<double> rates_;
};

}  // namespace edmill::dem
