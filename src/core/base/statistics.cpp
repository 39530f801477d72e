#include "base/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

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

Median median_of(std::vector<double> values, double alike) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  const auto at = [&](double place) {
    return values[static_cast<std::size_t>(std::clamp(std::round(place), 0.0, n - 1))];
  };
  const double normal = boost::math::quantile(Student(1e6), 1 - 0.025 / alike);
  const double middle = (n - 1) / 2, apart = normal / 2 * std::sqrt(n);
  return {at(middle), at(middle - apart), at(middle + apart), values.size()};
}

Median median_at_zero(const std::vector<double>& x, std::vector<double> y, double alike) {
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

double mean_left_by(const std::vector<double>& x, const std::vector<double>& y) {
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

double paired_t_probability(const std::vector<double>& differences) {
  const double mean = mean_of(differences), error = std::sqrt(variance_of_mean(differences));
  if (!(error > 0)) return mean == 0 ? 1 : 0;
  const Student student(static_cast<double>(differences.size()) - 1);
  return 2 * boost::math::cdf(boost::math::complement(student, std::abs(mean) / error));
}

std::vector<double> holm(const std::vector<double>& probabilities) {
  std::vector<std::size_t> order(probabilities.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t j) { return probabilities[i] < probabilities[j]; });
  std::vector<double> adjusted(probabilities.size());
  double largest = 0;
  for (std::size_t r = 0; r < order.size(); ++r) {
    largest = std::max(largest, static_cast<double>(order.size() - r) * probabilities[order[r]]);
    adjusted[order[r]] = std::min(1.0, largest);
  }
  return adjusted;
}

bool stands_apart(double value, const std::vector<double>& sample, double significance) {
  if (sample.size() < 2) return false;
  const double n = static_cast<double>(sample.size());
  const double spread = std::sqrt(variance_of_mean(sample) * n * (1 + 1 / n));
  return std::abs(value - mean_of(sample)) > student_limit(n - 1, significance) * spread;
}

}  // namespace edmill::numerics
