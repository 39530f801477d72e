#include "base/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/student.hpp"

namespace edmill::numerics {

namespace {

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Variance of the mean.
double variance_of_mean(const std::vector<double>& values) {
  const double mean = mean_of(values), n = static_cast<double>(values.size());
  double sum = 0;
  for (const double v : values) sum += (v - mean) * (v - mean);
  return sum / (n - 1) / n;
}

/// The value that a |t| of `freedom` degrees exceeds with probability `significance`.
double student_limit(double freedom, double significance) {
  const Student distribution(freedom);
  return boost::math::quantile(boost::math::complement(distribution, significance / 2));
}

}  // namespace

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto place =
      std::min(static_cast<std::size_t>(share * static_cast<double>(values.size())), values.size() - 1);
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(place);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

Estimate estimate(const std::vector<double>& values) {
  Estimate e;
  if (values.empty()) return e;
  e.mean = mean_of(values);
  if (values.size() > 1)
    e.half_width =
        student_limit(static_cast<double>(values.size()) - 1, 0.05) * std::sqrt(variance_of_mean(values));
  return e;
}

bool differ(const std::vector<double>& a, const std::vector<double>& b, double significance) {
  if (a.size() < 2 || b.size() < 2) return false;
  const double va = variance_of_mean(a), vb = variance_of_mean(b);
  const double distance = std::abs(mean_of(a) - mean_of(b));
  if (va + vb <= 0) return distance > 0;
  const double na = static_cast<double>(a.size()) - 1, nb = static_cast<double>(b.size()) - 1;
  const double freedom = (va + vb) * (va + vb) / (va * va / na + vb * vb / nb);
  return distance > student_limit(freedom, significance) * std::sqrt(va + vb);
}

bool stands_apart(double value, const std::vector<double>& sample, double significance) {
  if (sample.size() < 2) return false;
  const double n = static_cast<double>(sample.size());
  const double spread = std::sqrt(variance_of_mean(sample) * n * (1 + 1 / n));
  return std::abs(value - mean_of(sample)) > student_limit(n - 1, significance) * spread;
}

}  // namespace edmill::numerics
