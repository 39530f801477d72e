// Means, medians, their intervals and tests.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <vector>

namespace edmill::numerics {

/// The value below which this share of the values lies; 0 for no values.
double quantile(std::vector<double> values, double share);

/// A median with its interval from order statistics, which is valid for any distribution.
struct Median {
  static constexpr std::uint64_t least = 8;  ///< values that enclose the median with 99 %

  double value = 0, low = 0, high = 0;
  std::uint64_t count = 0;

  bool known() const { return count >= least; }
  double half_width() const { return (high - low) / 2; }
};

/// The median; of an even number of values the upper one of the two in the middle.
/// @param alike  number of medians whose intervals contain all true values at once with 95 %
Median median_of(std::vector<double> values, double alike = 1);
/// The median of y where x is 0, on the straight line with the median slope (Theil and Sen).
Median median_at_zero(const std::vector<double>& x, std::vector<double> y, double alike = 1);
/// The mean of |y - k x| for the k that minimises it, which is the median of y/x weighted by |x|.
double mean_left_by(const std::vector<double>& x, const std::vector<double>& y);

struct Estimate {
  std::optional<double> mean, half_width;  ///< of the 95 % interval; needs two values
};

/// Mean and Student's 95 % interval of independent values.
Estimate estimate(const std::vector<double>& values);

/// Mean of a time series and its 95 % interval, by Student's t for the cosine transforms of the
/// lowest frequencies, which account for correlation (Lazarus, Lewis, Stock and Watson 2018); wider
/// for skewed values. No interval for fewer than five values.
Estimate series_estimate(const std::vector<double>& values);

/// True if a time series drifts: its lowest frequency exceeds the next ones (Student's t, 1 %).
bool drifts(const std::vector<double>& values);

/// A mean shared by several runs, and their number.
struct SteadyState {
  double mean, half_width;
  std::size_t runs;
};
/// Estimate of a mean from runs that differ in their seeds only.
struct OfSeeds : Estimate {
  /// Ascending, if the runs differ by more than their own intervals allow; otherwise empty.
  std::vector<SteadyState> states = {};
};
/// Mean of several runs with an interval from the pooled variance within and between the runs. If
/// that between them is larger (F test, 1 %) and the runs form groups with separate intervals,
/// these are the steady states.
/// @param half_widths  of the runs' 95 % intervals; if empty, only the scatter of the means is used
OfSeeds pooled(const std::vector<double>& means, const std::vector<double>& half_widths);

/// Whether the means of series differ by more than their scatter allows (analysis of variance, with
/// this significance). @param series  two or more, of one length
bool means_differ(const std::vector<std::vector<double>>& series, double significance);

/// Weighted least-squares fit of a straight line to points that are added one by one.
class Line {
 public:
  void add(double x, double y, double weight = 1) {
    ++points_;
    weights_ += weight;
    const double dx = x - mean_x_;
    mean_x_ += weight * dx / weights_;
    mean_y_ += weight * (y - mean_y_) / weights_;
    xx_ += weight * dx * (x - mean_x_);
    xy_ += weight * dx * (y - mean_y_);
  }
  std::size_t points() const { return points_; }
  double slope() const { return xy_ / xx_; }
  /// Value at x = 0; `deviation` is its standard deviation if the weights are inverse variances.
  double value() const { return mean_y_ - slope() * mean_x_; }
  double deviation() const { return std::sqrt(1 / weights_ + mean_x_ * mean_x_ / xx_); }
 private:
  std::size_t points_ = 0;
  double weights_ = 0, mean_x_ = 0, mean_y_ = 0, xx_ = 0, xy_ = 0;
};

/// Weighted quantiles of positive values, from bins of 1/32 of an octave: accurate to 3 %.
class WeightedQuantiles {
 public:
  void add(double value, double weight) {
    if (!(weight > 0)) return;
    const std::size_t bin = bin_of(value);
    if (bin >= weights_.size()) weights_.resize(bin + 1);
    weights_[bin] += weight;
  }
  /// The value below which `share` of the weight lies; empty if there is no weight.
  std::optional<double> quantile(double share) const;

  void archive(auto& a) { a(weights_); }
 private:
  /// Values below 2^least_octave / 2 are in the first bin.
  static constexpr int least_octave = -100, bin_bits = 5, bins_per_octave = 1 << bin_bits;

  /// The bin of a value above 0 is its exponent and the first bits of its fraction.
  static std::size_t bin_of(double value) {
    constexpr int exponent_of_one = 1023, fraction_bits = 52;
    constexpr std::uint64_t least = std::uint64_t{exponent_of_one - 1 + least_octave} << bin_bits;
    if (!(value > 0) || !std::isfinite(value)) return 0;
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);  // some standard libraries have no bit_cast
    const auto bin = bits >> (fraction_bits - bin_bits);
    return static_cast<std::size_t>(bin > least ? bin - least : 0);
  }

  std::vector<double> weights_;  ///< of each bin, up to the last one that is not zero
};

/// Whether the means of two samples differ (Welch's test, two-sided); never for single values.
bool differ(const std::vector<double>& a, const std::vector<double>& b, double significance);

/// p-value of a paired t test: the probability of a mean of `differences` at least this far from 0
/// if 0 is expected (two-sided). @pre at least two values
double paired_t_probability(const std::vector<double>& differences);

/// Holm's adjusted probabilities: rejecting those up to 5 % has a familywise error rate up to 5 %.
std::vector<double> holm(const std::vector<double>& probabilities);

/// Whether a value is outside the interval for a further value of this sample with probability
/// 1 - `significance` (Student's prediction interval). Never for fewer than two values.
bool stands_apart(double value, const std::vector<double>& sample, double significance);

}  // namespace edmill::numerics
