#include "identify/fit.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <unsupported/Eigen/NonLinearOptimization>
#include <utility>

#include "base/statistics.hpp"

namespace edmill::identify {

namespace {

/// Rows below this share of the tolerance fit perfectly: rounding.
constexpr double perfect = 1e-4;

/// Of a row: that of its doubles over the usual tolerance of 1e-9.
constexpr double rounding_of_rows = 4e-7;

double median_size(std::vector<double> values) {
  for (double& v : values) v = std::abs(v);
  return numerics::quantile(std::move(values), 0.5);
}

/// Scales of the weights, from those of the start down to rounding.
std::vector<double> scales_for(const std::vector<double>& rows) {
  std::vector<double> off;
  for (const double r : rows)
    if (std::abs(r) > 1) off.push_back(r);
  const double largest = std::max(1.0, median_size(off));
  std::vector<double> scales;
  for (double s = 3 * largest; s > 1; s /= 30) scales.push_back(s);
  scales.push_back(1);
  return scales;
}

/// A step of a parameter, in its unit: backwards where a case cannot have a larger value.
double possible_step(const Assumptions& assumed, const Parameter& p, double value, double step) {
  return p.on(assumed, value + step * p.change).built() ? step : -step;
}

/// What Eigen asks for weighted rows and their derivatives through.
struct Problem {
  using Scalar = double;
  using InputType = Eigen::VectorXd;
  using ValueType = Eigen::VectorXd;
  using JacobianType = Eigen::MatrixXd;
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  const Residuals& sample;
  const Hypothesis& tried;
  Eigen::VectorXd roots{};  ///< of the weights

  int inputs() const { return static_cast<int>(tried.numbers.size()); }
  int values() const { return static_cast<int>(sample.count()); }
  std::vector<double> values_at(const Eigen::VectorXd& x) const {
    std::vector<double> values;
    for (std::size_t k = 0; k < tried.numbers.size(); ++k) values.push_back(x[k] * tried.numbers[k].change);
    return values;
  }
  Eigen::VectorXd rows_of(const std::vector<double>& values) const {
    const auto rows = sample.rows(tried.with(values));
    return Eigen::Map<const Eigen::VectorXd>(rows.data(), static_cast<Eigen::Index>(rows.size()));
  }
  int operator()(const Eigen::VectorXd& x, Eigen::VectorXd& out) const {
    out = roots.cwiseProduct(rows_of(values_at(x)));
    return 0;
  }
  int df(const Eigen::VectorXd& x, Eigen::MatrixXd& out) const {
    out = roots.asDiagonal() * derivatives(x);
    return 0;
  }
  /// Differences of a step that neither rounding nor curvature spoils.
  Eigen::MatrixXd derivatives(const Eigen::VectorXd& x) const {
    Eigen::MatrixXd columns(values(), inputs());
    const auto values = values_at(x);
    const auto here = rows_of(values);
    for (std::size_t k = 0; k < values.size(); ++k) {
      const Parameter& free = tried.numbers[k];
      const double step = possible_step(tried.with(values), free, values[k], 1e-7);
      auto moved = values;
      moved[k] += step * free.change;
      columns.col(k) = (rows_of(moved) - here) / step;
    }
    return columns;
  }
};

Eigen::VectorXd weights_of(const std::vector<double>& rows, double scale) {
  Eigen::VectorXd weights(static_cast<Eigen::Index>(rows.size()));
  std::transform(rows.begin(), rows.end(), weights.data(),
                 [&](double r) { return 1 / (1 + r * r / (scale * scale)); });
  return weights;
}

/// What the rounds with weights of scale 1 minimise.
double cauchy_cost(const std::vector<double>& rows) {
  return std::accumulate(rows.begin(), rows.end(), 0.0,
                         [](double sum, double r) { return sum + std::log1p(r * r); });
}

/// Intervals: what noise of the rows' own size leaves open, and what a shift of all rows by that size, each
/// in the worst direction, would do; rounding of a log does shift rows of a kind together.
std::vector<double> half_widths_of(const Eigen::MatrixXd& j, const std::vector<double>& rows,
                                   const Hypothesis& tried) {
  const auto weights = weights_of(rows, 1);
  double sum = 0, total = 0;
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    if (j.row(i).isZero(0)) continue;  // tells nothing of the parameters, nor of their noise
    sum += weights[i] * rows[i] * rows[i];
    total += weights[i];
  }
  // A few rows may fit better than rounding allows.
  const double noise = std::max(total > 0 ? std::sqrt(sum / total) : 0, rounding_of_rows);
  const Eigen::MatrixXd inverse = (j.transpose() * weights.asDiagonal() * j).inverse();
  const Eigen::MatrixXd influence = inverse * j.transpose() * weights.asDiagonal();
  std::vector<double> half;
  for (Eigen::Index c = 0; c < j.cols(); ++c) {
    const auto& parameter = tried.numbers[c];
    const double random = 3 * std::sqrt(std::max(0.0, inverse(c, c))) * noise,
                 shift = influence.row(c).cwiseAbs().sum() * noise;
    const double rounding = 2e-15 * std::max(std::abs(tried.values[c]), std::abs(parameter.value));
    half.push_back((random + shift) * parameter.change + rounding);
  }
  return half;
}

}  // namespace

double Hypothesis::evidence() const {
  double choices = 0;
  for (const auto& p : numbers) choices += p.prior;
  return score - choices;
}

std::set<std::string> Hypothesis::names() const {
  std::set<std::string> all;
  for (const auto* list : {&mistakes, &numbers})
    for (const auto& p : *list) all.insert(p.name());
  return all;
}

bool Hypothesis::allows(const Parameter& more) const {
  const auto is_free = [&](const Parameter& own) { return !own.excludes(more) && !more.excludes(own); };
  return std::all_of(mistakes.begin(), mistakes.end(), is_free) &&
         std::all_of(numbers.begin(), numbers.end(), is_free);
}

Assumptions Hypothesis::with(const std::vector<double>& other_values) const {
  Assumptions result = nominal;
  for (const auto& mistake : mistakes) mistake.set(result, 1);
  for (std::size_t k = 0; k < numbers.size(); ++k) numbers[k].set(result, other_values[k]);
  return result;
}

double misfit(const Residuals& sample, const std::vector<double>& rows) {
  std::array<std::vector<double>, audit::row_kinds> of_kind;
  for (std::size_t k = 0; k < rows.size(); ++k)
    of_kind[static_cast<std::size_t>(sample.of_case()[k].kind)].push_back(rows[k]);
  double cost = 0;
  for (const auto& own : of_kind) {
    const double scale = std::max(median_size(own), perfect);
    for (const double r : own) cost += 2 * std::log1p(r * r / (scale * scale)) + 2 * std::log(scale);
  }
  return cost;
}

double fit(const Residuals& sample, Hypothesis& tried) {
  const auto p = static_cast<Eigen::Index>(tried.numbers.size());
  Problem problem{sample, tried};
  Eigen::VectorXd x(p);
  for (Eigen::Index k = 0; k < p; ++k) x[k] = tried.values[k] / tried.numbers[k].change;
  auto rows = sample.rows(tried.assumed());
  const auto scales = scales_for(rows);
  constexpr std::size_t most_rounds = 25;
  double cost = std::numeric_limits<double>::infinity();
  for (std::size_t round = 0; round < scales.size() + most_rounds; ++round) {
    problem.roots = weights_of(rows, scales[std::min(round, scales.size() - 1)]).cwiseSqrt();
    Eigen::LevenbergMarquardt<Problem> solver(problem);
    solver.parameters.xtol = solver.parameters.ftol = 1e-15;
    Eigen::VectorXd now = x;
    auto status = solver.minimizeInit(now);
    for (int step = 0; step < 3 && status <= Eigen::LevenbergMarquardtSpace::Running; ++step)
      status = solver.minimizeOneStep(now);
    double moved = 0;
    for (Eigen::Index k = 0; k < p; ++k) {
      if (!std::isfinite(now[k])) continue;
      moved = std::max(moved, std::abs(now[k] - x[k]) / std::max(1.0, std::abs(now[k])));
      x[k] = now[k];
    }
    rows = sample.rows(tried.with(problem.values_at(x)));
    if (round < scales.size()) continue;
    // The cost changes by the mean of a row where the numbers change by the noise that is left.
    constexpr double of_noise = 1e-6;
    const double last = std::exchange(cost, cauchy_cost(rows));
    if (moved < 1e-13 || last - cost < of_noise * cost / static_cast<double>(rows.size())) break;
  }
  tried.values = problem.values_at(x);
  tried.half_widths = half_widths_of(problem.derivatives(x), rows, tried);
  return misfit(sample, rows);
}

std::vector<double> sensitivity(const Residuals& sample, const Assumptions& base,
                                const std::vector<double>& rows, const Parameter& number) {
  // A restitution of 0, or no least separation speed, shows nothing until it is large enough for some impact.
  for (const double length : {1e-6, 1.0}) {
    if (!number.is_of_case() || (length == 1 && number.value != 0)) break;
    const double step = possible_step(base, number, number.value, length);
    auto column = sample.rows(number.on(base, number.value + step * number.change));
    for (std::size_t i = 0; i < column.size(); ++i) {
      const double moved = column[i] - rows[i];
      column[i] = std::abs(moved) > rounding_of_rows ? moved / step : 0;
    }
    if (std::any_of(column.begin(), column.end(), [](double slope) { return slope != 0; })) return column;
  }
  return {};
}

double linear_misfit(const Residuals& sample, const std::vector<double>& rows, const Slopes& slopes,
                     std::vector<double>& change) {
  const auto count = static_cast<Eigen::Index>(slopes.size());
  Eigen::MatrixXd j(static_cast<Eigen::Index>(rows.size()), count);
  for (Eigen::Index k = 0; k < count; ++k)
    j.col(k) = Eigen::Map<const Eigen::VectorXd>(slopes[static_cast<std::size_t>(k)]->data(), j.rows());
  const Eigen::VectorXd begin = Eigen::Map<const Eigen::VectorXd>(rows.data(), j.rows());
  std::vector<double> left = rows;
  const auto scales = scales_for(rows);
  change.assign(slopes.size(), 0);
  for (std::size_t round = 0; round < scales.size() + 2; ++round) {
    const Eigen::VectorXd weights = weights_of(left, scales[std::min(round, scales.size() - 1)]);
    const Eigen::MatrixXd weighted = weights.asDiagonal() * j;
    const Eigen::MatrixXd squares = weighted.transpose() * j;
    const Eigen::VectorXd x = squares.ldlt().solve(-(weighted.transpose() * begin));
    if (!x.allFinite()) break;
    Eigen::Map<Eigen::VectorXd>(change.data(), count) = x;
    Eigen::Map<Eigen::VectorXd>(left.data(), j.rows()) = begin + j * x;
  }
  return misfit(sample, left);
}

}  // namespace edmill::identify
