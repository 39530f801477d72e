// Medians and dose rates with their 95 % intervals.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "base/student.hpp"

namespace edmill::dem {

/// A median with its 95 % interval by order statistics, which ask nothing of the distribution.
struct Median {
  double value = 0, low = 0, high = 0;
  std::uint64_t count = 0;

  bool known() const { return count >= 20; }
  double half_width() const { return (high - low) / 2; }
};

/// Of an even number of values the upper one of the middle.
inline Median median_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  const auto at = [&](double place) {
    return values[static_cast<std::size_t>(std::clamp(std::round(place), 0.0, n - 1))];
  };
  const double middle = (n - 1) / 2, apart = 0.98 * std::sqrt(n);
  return {at(middle), at(middle - apart), at(middle + apart), values.size()};
}

/// The median of what a record says over what the case says; 1 where it says nothing, or differs by the
/// rounding of numbers that are written.
inline double factor_of(std::vector<double> ratios) {
  const double factor = ratios.empty() ? 1 : median_of(std::move(ratios)).value;
  return std::abs(factor - 1) < 1e-5 ? 1 : factor;
}

/// From batches of equal duration.
class DoseRate {
 public:
  static constexpr std::size_t batches = 24;

  /// @param first, last  of the record [s]
  DoseRate(double first, double last) : first_(first), length_((last - first) / batches), doses_(batches) {}

  void add(double time, double dose) {
    const double place = (time - first_) / length_;
    if (place >= 0) doses_[static_cast<std::size_t>(std::min(place, batches - 1.0))] += dose;
  }
  /// [W]
  double mean() const { return std::accumulate(doses_.begin(), doses_.end(), 0.0) / (length_ * batches); }
  /// Of the 95 % interval [W].
  double half_width() const {
    const double middle = mean();
    double squares = 0;
    for (const double dose : doses_) squares += (dose / length_ - middle) * (dose / length_ - middle);
    const double t = boost::math::quantile(numerics::Student(batches - 1), 0.975);
    return t * std::sqrt(squares / (batches * (batches - 1)));
  }

 private:
  double first_, length_;
  std::vector<double> doses_;
};

}  // namespace edmill::dem
