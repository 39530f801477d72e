// Means of a few runs and their intervals.
#pragma once

#include <cmath>
#include <optional>
#include <vector>

namespace edmill::numerics {

/// The value that a share of the others is below; 0 of none.
double quantile(std::vector<double> values, double share);

struct Estimate {
  std::optional<double> mean, half_width;  ///< of the 95 % interval; needs two values
};

/// Mean and Student's 95 % interval of independent values.
Estimate estimate(const std::vector<double>& values);

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

/// Whether the means of two samples differ at `significance` (Welch's test, two-sided). Samples of fewer than
/// two values never differ.
bool differ(const std::vector<double>& a, const std::vector<double>& b, double significance);

/// Whether a value is outside the interval that contains another value of this sample with probability
/// 1 - `significance` (Student's prediction interval). Always false for fewer than two values.
bool stands_apart(double value, const std::vector<double>& sample, double significance);

}  // namespace edmill::numerics
