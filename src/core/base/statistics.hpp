// Means, medians, their intervals and tests.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

namespace edmill::numerics {

/// The value that a share of the others is below; 0 of none.
double quantile(std::vector<double> values, double share);

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
Median median_of(std::vector<double> values, double alike = 1);
/// The median of y where x is 0, on the straight line with the median slope (Theil and Sen).
Median median_at_zero(const std::vector<double>& x, std::vector<double> y, double alike = 1);
/// The mean of |y - k x| with the multiple k that makes it least: the median of y/x weighted by |x|.
double mean_left_by(const std::vector<double>& x, const std::vector<double>& y);

struct Estimate {
  std::optional<double> mean, half_width;  ///< of the 95 % interval; needs two values
};

/// Mean and Student's 95 % interval of independent values.
Estimate estimate(const std::vector<double>& values);

/// The mean of values that follow each other in time, and its 95 % interval: Student's over their cosine
/// transforms of the lowest frequencies, which contain the correlation of values near each other (Lazarus,
/// Lewis, Stock and Watson 2018); wider where the values are skewed. No interval of fewer than five values.
Estimate series_estimate(const std::vector<double>& values);

/// Whether such values drift: their lowest frequency exceeds the next ones (Student's t, 1 %).
bool drifts(const std::vector<double>& values);

/// A mean that several runs have, and how many do.
struct SteadyState {
  double mean, half_width;
  std::size_t runs;
};
/// What runs that differ by their seeds say of a mean.
struct OfSeeds : Estimate {
  /// The least first, where the runs differ by more than their own intervals allow: no interval holds them
  /// all.
  std::vector<SteadyState> states = {};
};
/// The mean of runs with their own intervals: the variance within them and that between them pooled. Where
/// the latter is larger (F test, 1 %) and the runs fall into groups whose intervals are apart, these are
/// reported.
/// @param half_widths  of their 95 % intervals; empty where one has none, then by the runs' means alone
OfSeeds pooled(const std::vector<double>& means, const std::vector<double>& half_widths);

/// Whether the means of several series differ by more than the scatter of the series allows (analysis of
/// variance, with this significance). @param series  of the same length, two of them or more
bool means_differ(const std::vector<std::vector<double>>& series, double significance);

/// Least squares of a straight line, point by point, with weights.
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
  /// At x = 0, and its standard deviation where weights are inverse variances.
  double value() const { return mean_y_ - slope() * mean_x_; }
  double deviation() const { return std::sqrt(1 / weights_ + mean_x_ * mean_x_ / xx_); }

 private:
  std::size_t points_ = 0;
  double weights_ = 0, mean_x_ = 0, mean_y_ = 0, xx_ = 0, xy_ = 0;
};

/// Quantiles by weight of values above 0, from bins of 1/32 of an octave: within 3 %.
class WeightedQuantiles {
 public:
  void add(double value, double weight);
  /// What `share` of the weight is below; nothing of no weight.
  std::optional<double> quantile(double share) const;

  void archive(auto& a) { a(weights_); }

 private:
  std::vector<double> weights_;  ///< up to the last bin that has any
};

/// Whether the means of two samples differ at `significance` (Welch's test, two-sided). Samples of fewer than
/// two values never differ.
bool differ(const std::vector<double>& a, const std::vector<double>& b, double significance);

/// Probability that the mean of `differences` is at least as far from 0 when 0 is expected: Student's t,
/// two-sided. @pre at least two values
double paired_t_probability(const std::vector<double>& differences);

/// Holm's adjusted probabilities: rejecting those up to 5 % has a familywise error rate of at most 5 %.
std::vector<double> holm(const std::vector<double>& probabilities);

/// Whether a value is outside the interval that contains another value of this sample with probability
/// 1 - `significance` (Student's prediction interval). Always false for fewer than two values.
bool stands_apart(double value, const std::vector<double>& sample, double significance);

}  // namespace edmill::numerics
