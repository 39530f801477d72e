// Medians and dose rates with their 95 % intervals.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/statistics.hpp"
#include "base/student.hpp"

namespace edmill::dem {

/// A median with its interval by order statistics, which ask nothing of the distribution.
struct Median {
  static constexpr std::uint64_t least = 8;  ///< values that hold the median between them in 99 %

  double value = 0, low = 0, high = 0;
  std::uint64_t count = 0;

  bool known() const { return count >= least; }
  double half_width() const { return (high - low) / 2; }
};

/// The median; of an even number of values the upper one of the two in the middle.
/// @param alike  number of medians whose intervals hold all of them in 95 %
inline Median median_of(std::vector<double> values, double alike = 1) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  const auto at = [&](double place) {
    return values[static_cast<std::size_t>(std::clamp(std::round(place), 0.0, n - 1))];
  };
  const double normal = boost::math::quantile(numerics::Student(1e6), 1 - 0.025 / alike);
  const double middle = (n - 1) / 2, apart = normal / 2 * std::sqrt(n);
  return {at(middle), at(middle - apart), at(middle + apart), values.size()};
}

/// The median of y where x is 0, on the straight line with the median slope (Theil and Sen).
inline Median median_at_zero(const std::vector<double>& x, std::vector<double> y, double alike = 1) {
  constexpr std::size_t most = 400;  // of pairs there are many
  std::vector<double> slopes;
  for (std::size_t i = 0; i < std::min(most, x.size()); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (x[i] != x[j]) slopes.push_back((y[i] - y[j]) / (x[i] - x[j]));
  const double slope = median_of(slopes).value, centre = median_of(x).value;
  double spread = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    y[k] -= slope * x[k];
    spread += (x[k] - centre) * (x[k] - centre);
  }
  auto median = median_of(std::move(y), alike);
  // The slope is known to what the scatter of y leaves of it.
  const double wider =
      median.half_width() * centre * std::sqrt(static_cast<double>(x.size()) / std::max(spread, 1e-300));
  median.low -= wider;
  median.high += wider;
  return median;
}

/// The mean of |y - k x| with the multiple k that makes it least: the median of y/x weighted by |x|.
inline double mean_left_by(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<std::pair<double, double>> ratios;  // with their weights
  double rest = 0;                                // of half the weights
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (x[k] == 0) continue;
    ratios.emplace_back(y[k] / x[k], std::abs(x[k]));
    rest += std::abs(x[k]) / 2;
  }
  std::sort(ratios.begin(), ratios.end());
  const auto middle = std::find_if(ratios.begin(), ratios.end(),
                                   [&](const auto& ratio) { return (rest -= ratio.second) <= 0; });
  const double multiple = middle == ratios.end() ? 0 : middle->first;
  double sum = 0;
  for (std::size_t k = 0; k < x.size(); ++k) sum += std::abs(y[k] - multiple * x[k]);
  return sum / static_cast<double>(x.size());
}

/// The largest deviation from 1 of the ratios of a record's values to the case's; 0 without any, 1
/// where all differ by the rounding of numbers that are written.
inline double factor_of(const std::vector<double>& ratios) {
  if (ratios.empty()) return 0;
  const double factor = std::ranges::max(ratios, {}, [](double ratio) { return std::abs(ratio - 1); });
  return std::abs(factor - 1) < 1e-5 ? 1 : factor;
}

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
