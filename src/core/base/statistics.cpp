#include "base/statistics.hpp"

#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/trigonometry.hpp"

namespace edmill::numerics {

namespace {

// In double throughout: long double is not the same number everywhere.
using InDouble = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
using Student = boost::math::students_t_distribution<double, InDouble>;
using Fisher = boost::math::fisher_f_distribution<double, InDouble>;

double count_of(const auto& values) { return static_cast<double>(values.size()); }

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / count_of(values);
}

std::vector<double> deviations_of(std::vector<double> values) {
  const double mean = mean_of(values);
  for (double& v : values) v -= mean;
  return values;
}

/// Root mean square of the values from `first` on; scaled, so that no small number is squared.
double size_of(const std::vector<double>& values, std::size_t first = 0) {
  double largest = 0, sum = 0;
  for (std::size_t k = first; k < values.size(); ++k)
    largest = std::max(largest, std::abs(values[k]));
  if (!(largest > 0)) return 0;
  for (std::size_t k = first; k < values.size(); ++k)
    sum += values[k] / largest * (values[k] / largest);
  return largest * std::sqrt(sum / static_cast<double>(values.size() - first));
}

double error_of_mean(const std::vector<double>& values) {
  return size_of(deviations_of(values)) / std::sqrt(count_of(values) - 1);
}

/// Two-sided critical value of Student's t with `freedom` degrees of freedom.
double student_limit(double freedom, double significance) {
  const Student distribution(freedom);
  return boost::math::quantile(boost::math::complement(distribution, significance / 2));
}

/// True if one standard deviation is significantly larger than another one (F test).
bool exceeds(double one, double freedom, double other, double other_freedom, double significance) {
  if (!(one > other)) return false;
  if (!(other > 0)) return true;
  const Fisher fisher(freedom, other_freedom);
  const double limit = boost::math::quantile(boost::math::complement(fisher, significance));
  return one / other * (one / other) > limit;
}

/// The indices of the values in ascending order.
std::vector<std::size_t> ascending(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return values[a] < values[b]; });
  return order;
}

}  // namespace

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto place = static_cast<std::size_t>(share * count_of(values));
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::min(place, values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

Median median_of(std::vector<double> values, double alike) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const double normal = boost::math::quantile(Student(1e6), 1 - 0.025 / alike);
  const double n = count_of(values), middle = (n - 1) / 2, apart = normal / 2 * std::sqrt(n);
  const auto at = [&](double place) {
    return values[static_cast<std::size_t>(std::clamp(std::round(place), 0.0, n - 1))];
  };
  return {at(middle), at(middle - apart), at(middle + apart), values.size()};
}

Median median_at_zero(const std::vector<double>& x, std::vector<double> y, double alike) {
  constexpr std::size_t most = 400;  // points: the number of pairs grows with its square
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
  // The uncertainty of the slope, which follows from the scatter of y, widens the interval.
  const double relative = count_of(x) / std::max(spread, 1e-300);
  const double wider = median.half_width() * centre * std::sqrt(relative);
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
  const auto middle = std::find_if(
      ratios.begin(), ratios.end(), [&](const auto& ratio) { return (rest -= ratio.second) <= 0; });
  const double multiple = middle == ratios.end() ? 0 : middle->first;
  double sum = 0;
  for (std::size_t k = 0; k < x.size(); ++k) sum += std::abs(y[k] - multiple * x[k]);
  return sum / count_of(x);
}

Estimate estimate(const std::vector<double>& values) {
  if (values.empty()) return {};
  if (values.size() == 1) return {mean_of(values), std::nullopt};
  return {mean_of(values), student_limit(count_of(values) - 1, 0.05) * error_of_mean(values)};
}

namespace {

/// Cosine transforms of a series at 1/2, 1, 3/2 ... cycles, each with the variance of a single
/// value if these are independent. Twelve cover correlation over a twentieth of the series; few
/// values get fewer.
std::vector<double> cosines_of(const std::vector<double>& values) {
  const auto deviations = deviations_of(values);
  const double n = count_of(values);
  std::vector<double> transforms(std::clamp<std::size_t>(values.size() / 4, 2, 12));
  for (std::size_t j = 0; j < transforms.size(); ++j)
    for (std::size_t k = 0; k < values.size(); ++k) {
      const double cycles = static_cast<double>(j) + 1, place = static_cast<double>(k) + 0.5;
      const double phase = pi<double>() * cycles / n * place;
      transforms[j] += deviations[k] * std::sqrt(2 / n) * sin_cos(phase).cos;
    }
  return transforms;
}

/// Third central moment over the cube of the standard deviation, for a sample.
double skewness_of(const std::vector<double>& values) {
  const auto deviations = deviations_of(values);
  const double n = count_of(values), size = size_of(deviations);
  double cubes = 0;
  for (const double d : deviations) cubes += size > 0 ? d / size * (d / size) * (d / size) : 0;
  return cubes / n * std::sqrt(n * (n - 1)) / (n - 2);
}

}  // namespace

Estimate series_estimate(const std::vector<double>& values) {
  constexpr std::size_t fewest = 5;
  if (values.size() < fewest)
    return {values.empty() ? std::nullopt : std::optional(mean_of(values)), {}};
  const auto transforms = cosines_of(values);
  const double n = count_of(values), skewness = skewness_of(values);
  const double limit = student_limit(count_of(transforms), 0.05);
  const double factor = 1 + 3 * skewness * skewness / n;  // measured: docs/theory.md, section 8
  return {mean_of(values), limit * size_of(transforms) / std::sqrt(n) * factor};
}

bool drifts(const std::vector<double>& values) {
  const auto transforms = cosines_of(values);
  if (transforms.size() < 4) return false;
  const double limit = student_limit(count_of(transforms) - 1, 0.01);
  return std::abs(transforms[0]) > limit * size_of(transforms, 1);
}

namespace {

constexpr double of_own_interval = 12;  ///< degrees of freedom
/// Standard error of a mean, from the half-width of its interval by `series_estimate`.
double error_of(double half_width) { return half_width / student_limit(of_own_interval, 0.05); }

/// Mean and interval of runs that share one steady state.
Estimate pooled_estimate(const std::vector<double>& means, const std::vector<double>& errors) {
  const double n = count_of(means), own = of_own_interval * n, others = n - 1;
  const double between = means.size() > 1 ? error_of_mean(means) : 0;
  const double within = size_of(errors) / std::sqrt(n), largest = std::max(between, within);
  if (!(largest > 0)) return {mean_of(means), 0};
  const double b = between / largest, w = within / largest;
  const double size = std::sqrt((own * w * w + others * b * b) / (own + others));
  return {mean_of(means), student_limit(own + others, 0.05) * largest * size};
}

}  // namespace

OfSeeds pooled(const std::vector<double>& means, const std::vector<double>& half_widths) {
  if (means.empty() || half_widths.size() != means.size()) return {estimate(means)};
  std::vector<double> sorted, widths, errors;
  std::vector<std::size_t> first;  // of each group
  for (const auto run : ascending(means)) {
    if (sorted.empty() || means[run] - sorted.back() > std::hypot(half_widths[run], widths.back()))
      first.push_back(sorted.size());
    sorted.push_back(means[run]);
    widths.push_back(half_widths[run]);
    errors.push_back(error_of(half_widths[run]));
  }
  const double n = count_of(means), within = size_of(errors) / std::sqrt(n);
  if (means.size() < 2 || !exceeds(error_of_mean(means), n - 1, within, of_own_interval * n, 0.01))
    return {pooled_estimate(sorted, errors)};
  if (first.size() == 1) return {estimate(means)};
  OfSeeds result{{mean_of(means), std::nullopt}};
  first.push_back(means.size());
  for (std::size_t g = 0; g + 1 < first.size(); ++g) {
    const std::size_t begin = first[g], runs = first[g + 1] - begin;
    const auto part = [&](const std::vector<double>& all) {
      return std::vector<double>(&all[begin], &all[begin] + runs);
    };
    const auto e = pooled_estimate(part(sorted), part(errors));
    result.states.push_back({*e.mean, *e.half_width, runs});
  }
  return result;
}

bool means_differ(const std::vector<std::vector<double>>& series, double significance) {
  const double n = count_of(series.front()), count = count_of(series);
  std::vector<double> means, errors;
  for (const auto& values : series) {
    means.push_back(mean_of(values));
    errors.push_back(error_of_mean(values));
  }
  const double between = error_of_mean(means) * std::sqrt(count), within = size_of(errors);
  return exceeds(between, count - 1, within, count * (n - 1), significance);
}

bool differ(const std::vector<double>& a, const std::vector<double>& b, double significance) {
  if (a.size() < 2 || b.size() < 2) return false;
  const double ea = error_of_mean(a), eb = error_of_mean(b), error = std::hypot(ea, eb);
  const double distance = std::abs(mean_of(a) - mean_of(b));
  if (!(error > 0)) return distance > 0;
  const double na = count_of(a) - 1, nb = count_of(b) - 1;
  const double freedom = 1 / (std::pow(ea / error, 4) / na + std::pow(eb / error, 4) / nb);
  return distance > student_limit(freedom, significance) * error;
}

double paired_t_probability(const std::vector<double>& differences) {
  const double mean = mean_of(differences), error = error_of_mean(differences);
  if (!(error > 0)) return mean == 0 ? 1 : 0;
  const Student student(count_of(differences) - 1);
  return 2 * boost::math::cdf(boost::math::complement(student, std::abs(mean) / error));
}

std::vector<double> holm(const std::vector<double>& probabilities) {
  std::vector<double> adjusted(probabilities.size());
  double largest = 0, left = count_of(probabilities);
  for (const auto k : ascending(probabilities)) {
    largest = std::max(largest, left-- * probabilities[k]);
    adjusted[k] = std::min(1.0, largest);
  }
  return adjusted;
}

bool stands_apart(double value, const std::vector<double>& sample, double significance) {
  if (sample.size() < 2) return false;
  const double n = count_of(sample);
  const double spread = error_of_mean(sample) * std::sqrt(n + 1);
  return std::abs(value - mean_of(sample)) > student_limit(n - 1, significance) * spread;
}

std::optional<double> WeightedQuantiles::quantile(double share) const {
  double below = share * std::accumulate(weights_.begin(), weights_.end(), 0.0);
  if (!(below > 0)) return std::nullopt;
  const auto edge = [](std::size_t bin) {
    const int k = static_cast<int>(bin);
    return std::ldexp(1 + static_cast<double>(k % bins_per_octave) / bins_per_octave,
        k / bins_per_octave + least_octave - 1);
  };
  std::size_t bin = 0;
  while (bin + 1 < weights_.size() && below > weights_[bin]) below -= weights_[bin++];
  const double within = weights_[bin] > 0 ? std::min(below / weights_[bin], 1.0) : 0;
  return edge(bin) + within * (edge(bin + 1) - edge(bin));
}

}  // namespace edmill::numerics
