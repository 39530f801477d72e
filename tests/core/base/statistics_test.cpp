// Intervals of means: of series in time and of several seeds, by how often they hold what is known.
#include "base/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace {

using namespace edmill::numerics;
using Values = std::vector<double>;

constexpr unsigned seed = 20261130;

/// Values whose correlation falls by a factor from one to the next; their mean is 0.
Values correlated(std::size_t count, double factor, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Values values;
  double value = normal(random);
  for (std::size_t k = 0; k < count; ++k) {
    values.push_back(value);
    value = factor * value + std::sqrt(1 - factor * factor) * normal(random);
  }
  return values;
}

double mean_of(const Values& values) { return *estimate(values).mean; }

/// The share of series whose interval holds the mean.
double coverage(double mean, const auto& draw) {
  std::mt19937_64 random(seed);
  constexpr int trials = 3000;  // a standard deviation of 0.4 %
  int held = 0;
  for (int k = 0; k < trials; ++k) {
    const auto e = series_estimate(draw(random));
    held += std::abs(*e.mean - mean) <= *e.half_width;
  }
  return static_cast<double>(held) / trials;
}

TEST(SeriesEstimate, HoldsTheMeanOfSeriesThatDependOnTheirPast) {
  RecordProperty("seed", seed);
  for (const double factor : {-0.5, -0.2, 0.0, 0.3})
    for (const std::size_t count : {10u, 20u, 50u, 100u}) {
      const double share =
          coverage(0, [&](auto& random) { return correlated(count, factor, random); });
      EXPECT_GT(share, 0.925) << factor << " " << count;
      EXPECT_LT(share, factor < -0.3 && count < 50 ? 0.985 : 0.97)
          << factor << " " << count;  // few transforms
    }
  const double long_memory = coverage(0, [](auto& random) { return correlated(120, 0.6, random); });
  EXPECT_GT(long_memory, 0.92);
}

TEST(SeriesEstimate, HoldsTheMeanOfSkewedSeries) {
  const auto skewed = [](auto& random) {
    std::exponential_distribution<double> wait(1);
    Values values;
    for (int k = 0; k < 60; ++k) values.push_back(std::pow(wait(random), 1.5));
    return values;
  };
  const double share = coverage(std::tgamma(2.5), skewed);
  EXPECT_GT(share, 0.92);
  EXPECT_LT(share, 0.97);
}

TEST(SeriesEstimate, HasNoUnitAndNoSmallestSize) {
  std::mt19937_64 random(seed);
  const auto values = correlated(40, 0.2, random);
  const auto e = series_estimate(values);
  for (const double size : {1e-200, 1e-160, 1e150}) {
    auto scaled = values;
    for (double& v : scaled) v *= size;
    EXPECT_NEAR(*series_estimate(scaled).half_width / size, *e.half_width, 1e-12 * *e.half_width);
    EXPECT_EQ(drifts(scaled), drifts(values));
    EXPECT_EQ(differ(scaled, values, 0.01), differ(values, scaled, 0.01));
    EXPECT_FALSE(differ(scaled, scaled, 0.01));
  }
  EXPECT_FALSE(series_estimate({1, 2, 3, 4}).half_width);
  EXPECT_EQ(*series_estimate(Values(30, 2.5)).half_width, 0);
}

TEST(Drifts, IsSaidOfSlowChangesAndSeldomOfOthers) {
  std::mt19937_64 random(seed);
  int falsely = 0, seen = 0;
  for (int k = 0; k < 1000; ++k) {
    auto values = correlated(60, 0.2, random);
    falsely += drifts(values);
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] += 4 * std::exp(-static_cast<double>(i) / 20);
    seen += drifts(values);
  }
  EXPECT_LT(falsely, 30);
  EXPECT_GT(seen, 900);
}

TEST(Pooled, SeedsOfOneStateHaveAnIntervalThatHoldsTheirMean) {
  std::mt19937_64 random(seed);
  for (const int runs : {1, 2, 3, 8, 30}) {
    int held = 0, split = 0;
    constexpr int trials = 1000;
    for (int k = 0; k < trials; ++k) {
      Values means, half_widths;
      for (int r = 0; r < runs; ++r) {
        const auto e = series_estimate(correlated(60, 0.2, random));
        means.push_back(*e.mean);
        half_widths.push_back(*e.half_width);
      }
      const auto found = pooled(means, half_widths);
      split += !found.states.empty();
      held += found.half_width && std::abs(*found.mean) <= *found.half_width;
      if (found.half_width && runs == 2) {  // never narrower than both allow
        const double within = std::hypot(half_widths[0], half_widths[1]) / 2;
        EXPECT_GT(*found.half_width, 0.9 * std::min(within, *estimate(means).half_width));
      }
    }
    EXPECT_GT(held + split, 925) << runs;
    EXPECT_LT(held, 972) << runs;
    EXPECT_LT(split, 20) << runs;
  }
}

TEST(Pooled, StatesThatAreApartAreReportedWithTheirRuns) {
  const auto found = pooled({1.09, 1.36, 1.091, 1.089, 1.361}, {0.002, 0.003, 0.002, 0.002, 0.003});
  ASSERT_EQ(found.states.size(), 2u);
  EXPECT_FALSE(found.half_width);
  EXPECT_NEAR(found.states[0].mean, 1.09, 1e-12);
  EXPECT_EQ(found.states[0].runs, 3u);
  EXPECT_NEAR(found.states[1].mean, 1.3605, 1e-12);
  EXPECT_EQ(found.states[1].runs, 2u);
  EXPECT_LT(found.states[1].half_width, 0.01);
}

TEST(Pooled, RunsWithoutIntervalsAreJudgedByTheirScatter) {
  const auto found = pooled({1, 2, 3}, {});
  EXPECT_EQ(*found.half_width, *estimate({1, 2, 3}).half_width);
  EXPECT_FALSE(pooled({1}, {}).half_width);
  EXPECT_FALSE(pooled({}, {}).mean);
}

TEST(WeightedQuantiles, AreWithinThreePercent) {
  std::mt19937_64 random(seed);
  for (int k = 0; k < 200; ++k) {
    const double scale = std::pow(10.0, std::uniform_real_distribution<>(-25, 5)(random));
    const double spread = std::uniform_real_distribution<>(0, 5)(random);
    std::vector<std::pair<double, double>> values;
    WeightedQuantiles quantiles;
    double all = 0;
    const int count = std::uniform_int_distribution<>(1, 300)(random);
    for (int j = 0; j < count; ++j) {
      const double value = scale * std::exp(spread * std::normal_distribution<>()(random));
      const double weight = std::uniform_real_distribution<>(0.1, 1)(random);
      values.emplace_back(value, weight);
      quantiles.add(value, weight);
      all += weight;
    }
    std::sort(values.begin(), values.end());
    for (const double share : {0.1, 0.5, 0.9}) {
      double below = 0;
      std::size_t place = 0;
      while (place + 1 < values.size() && (below += values[place].second) < share * all) ++place;
      const double found = *quantiles.quantile(share);
      EXPECT_NEAR(found, values[place].first, 0.035 * values[place].first) << k << ' ' << share;
    }
  }
  WeightedQuantiles none;
  EXPECT_FALSE(none.quantile(0.5));
  none.add(1, 0);
  EXPECT_FALSE(none.quantile(0.5));
  none.add(0, 1);
  EXPECT_LT(*none.quantile(0.9), 1e-30);
}

TEST(MeansDiffer, OfSeriesWithOtherMeansAlone) {
  std::mt19937_64 random(seed);
  int falsely = 0, seen = 0;
  for (int k = 0; k < 500; ++k) {
    std::vector<Values> series;
    for (int ball = 0; ball < 6; ++ball) series.push_back(correlated(8, 0, random));
    falsely += means_differ(series, 0.01);
    for (double& v : series[2]) v += 3;
    seen += means_differ(series, 0.01);
  }
  EXPECT_LT(falsely, 20);
  EXPECT_GT(seen, 490);
  EXPECT_NEAR(mean_of({1, 2, 3}), 2, 0);
}

}  // namespace
