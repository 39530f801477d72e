// Means and intervals against independent computations.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/statistics.hpp"
#include "program.hpp"

namespace edmill {
namespace {

/// P(|T| <= t) by Simpson's rule on the density.
double student_probability(double t, double freedom) {
  const double norm = std::exp(std::lgamma((freedom + 1) / 2) - std::lgamma(freedom / 2)) /
      std::sqrt(freedom * std::numbers::pi);
  const auto density = [&](double x) {
    return norm * std::pow(1 + x * x / freedom, -(freedom + 1) / 2);
  };
  const int n = 200000;
  double sum = density(0) + density(t);
  for (int k = 1; k < n; ++k) sum += (k % 2 ? 4 : 2) * density(t * k / n);
  return 2 * sum * t / n / 3;
}

TEST(SweepStatistics, TheIntervalHolds95PercentOfStudentsDistribution) {
  for (const auto& values : std::vector<std::vector<double>>{{1.0, 2.0}, {5.1, 4.9, 5.3},
           {-1, 0.5, 3, 8, 2}, {1, 1.1, 0.9, 1.05, 0.95, 1, 1.2, 0.8, 1, 1.01}}) {
    const auto e = numerics::estimate(values);
    const double n = static_cast<double>(values.size());
    double sum = 0, squares = 0;
    for (const double v : values) sum += v, squares += v * v;
    EXPECT_NEAR(*e.mean, sum / n, 1e-14);
    const double error = std::sqrt((squares - sum * sum / n) / (n - 1) / n);
    EXPECT_NEAR(student_probability(*e.half_width / error, n - 1), 0.95, 1e-8);
  }
}

TEST(SweepStatistics, OneValueHasNoInterval) {
  EXPECT_FALSE(numerics::estimate({}).mean);
  EXPECT_EQ(*numerics::estimate({3}).mean, 3);
  EXPECT_FALSE(numerics::estimate({3}).half_width);
}

TEST(SweepStatistics, OnlyDistantMeansDiffer) {
  EXPECT_TRUE(numerics::differ({1, 1.1, 0.9}, {2, 2.1, 1.9}, 0.05));
  EXPECT_FALSE(numerics::differ({1, 1.1, 0.9}, {1.05, 1.15, 0.95}, 0.05));
  EXPECT_FALSE(numerics::differ({1}, {2, 2.1}, 0.05));
  EXPECT_TRUE(numerics::differ({1, 1}, {2, 2}, 0.05));
  // Equal sizes and variances: Welch's test is Student's with 4 degrees, whose limit at 5 %
  // is 2.7764.
  const double error = std::sqrt(2 * 0.01 / 3);
  const auto shifted = [&](double t) {
    return std::vector<double>{1 + t * error, 1.1 + t * error, 0.9 + t * error};
  };
  EXPECT_FALSE(numerics::differ({1, 1.1, 0.9}, shifted(2.776), 0.05));
  EXPECT_TRUE(numerics::differ({1, 1.1, 0.9}, shifted(2.777), 0.05));
}

class SweepIntervals : public ProgramTest {};

TEST_F(SweepIntervals, TheTableHoldsWhatTheRunsGive) {
  std::filesystem::copy_file(
      std::filesystem::path(EDMILL_SOURCE_DIR) / "docs/examples/demo.toml", scratch / "demo.toml");
  write("a.toml",
      "[sweep]\ncase = \"demo.toml\"\nreplicas = 3\ngrid = { \"run.end_time\" = [\"1 s\"] }\n");
  ASSERT_EQ(edmill("sweep a.toml --out out").code, 0);
  const auto rows = [&](const std::string& name) {
    std::istringstream lines(contents(scratch / "out" / name));
    std::vector<std::vector<std::string>> rows;
    for (std::string line; std::getline(lines, line);) {
      rows.emplace_back();
      std::istringstream fields(line);
      for (std::string field; std::getline(fields, field, ',');)
        rows.back().push_back(field.substr(0, field.find(" [")));  // titles without units
    }
    return rows;
  };
  const auto column = [](const auto& table, const std::string& name) {
    return static_cast<std::size_t>(
        std::find(table[0].begin(), table[0].end(), name) - table[0].begin());
  };
  const auto runs = rows("runs.csv"), points = rows("sweep.csv");
  ASSERT_EQ(runs.size(), 4u);
  ASSERT_EQ(points.size(), 2u);
  // The intervals of the runs and their scatter, pooled: 12 degrees of freedom of each run, and 2
  // of the runs.
  const double of_run = 2.178812829667228,
               of_all = 2.024394164575136;  // Student's limits of 12 and 38
  const std::string name = "milling_dose_rate";
  double sum = 0, squares = 0, own = 0;
  for (std::size_t k = 1; k < 4; ++k) {
    sum += std::stod(runs[k][column(runs, name)]);
    own += std::pow(std::stod(runs[k][column(runs, name + "_ci95")]) / of_run, 2) / 3;
  }
  const double mean = sum / 3;
  for (std::size_t k = 1; k < 4; ++k)
    squares += std::pow(std::stod(runs[k][column(runs, name)]) - mean, 2);
  EXPECT_NEAR(std::stod(points[1][column(points, name)]), mean, 1e-12 * mean);
  EXPECT_NEAR(std::stod(points[1][column(points, name + "_ci95")]),
      of_all * std::sqrt((36 * own + squares) / 38 / 3), 1e-9 * mean);
  EXPECT_EQ(points[1][column(points, "states")], "1");
  EXPECT_EQ(
      column(points, "collision_rate_total_ci95"), points[0].size());  // contacts at rest have none
}

}  // namespace
}  // namespace edmill
