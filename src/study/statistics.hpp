// Means of a few runs and how far they can be trusted.
#pragma once

#include <optional>
#include <vector>

namespace edmill::study {

struct Estimate {
  std::optional<double> mean, half_width;  ///< of the 95 % interval; needs two values
};

/// Mean and Student's 95 % interval of independent values.
Estimate estimate(const std::vector<double>& values);

/// Whether the means of two samples differ at `significance` (Welch's test, two-sided). Samples of fewer than
/// two values cannot be told apart.
bool differ(const std::vector<double>& a, const std::vector<double>& b, double significance);

/// Whether a value lies outside of where another value of this sample would lie with probability
/// 1 - `significance` (Student's prediction interval). Of fewer than two values nothing stands apart.
bool stands_apart(double value, const std::vector<double>& sample, double significance);

}  // namespace edmill::study
