// Means of a few runs and their intervals.
#pragma once

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

/// Whether the means of two samples differ at `significance` (Welch's test, two-sided). Samples of fewer than
/// two values never differ.
bool differ(const std::vector<double>& a, const std::vector<double>& b, double significance);

/// Whether a value is outside the interval that contains another value of this sample with probability
/// 1 - `significance` (Student's prediction interval). Always false for fewer than two values.
bool stands_apart(double value, const std::vector<double>& sample, double significance);

}  // namespace edmill::numerics
