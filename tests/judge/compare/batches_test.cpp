// Tests on batches against closed forms, and their rate of false alarms.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <numbers>
#include <random>

#include "base/statistics.hpp"
#include "compare/comparison.hpp"

namespace edmill::compare {
namespace {

using numerics::holm, numerics::paired_t_probability;

TEST(Batches, ProbabilitiesAreStudents) {
  // With one degree of freedom it is Cauchy's distribution; with two, t / sqrt(2 + t^2).
  const double t1 = 3 / 1.0;  // mean 3, error 1
  EXPECT_NEAR(paired_t_probability({2, 4}), 1 - 2 / std::numbers::pi * std::atan(t1), 1e-12);
  const double t2 = 2 / (1 / std::sqrt(3.0));  // mean 2, deviation 1
  EXPECT_NEAR(paired_t_probability({1, 2, 3}), 1 - t2 / std::sqrt(2 + t2 * t2), 1e-12);
  EXPECT_NEAR(paired_t_probability({-1, -2, -3}), 1 - t2 / std::sqrt(2 + t2 * t2), 1e-12);
  EXPECT_EQ(paired_t_probability({0, 0, 0}), 1);
  EXPECT_EQ(paired_t_probability({1, 1, 1}), 0);
}

TEST(Batches, HolmsProbabilitiesAreThoseOfTheTextbook) {
  const auto adjusted = holm({0.01, 0.04, 0.03, 0.005});
  const std::vector<double> expected = {0.03, 0.06, 0.06, 0.02};
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(adjusted[k], expected[k], 1e-15);
  EXPECT_EQ(holm({0.6, 0.7}), (std::vector<double>{1, 1}));
  EXPECT_TRUE(holm({}).empty());
}

TEST(Batches, TheMeanOfRatioValuesIsTheRatioOfTheSums) {
  const auto values = ratio_values({1, 5, 2}, {1, 2, 4});
  EXPECT_NEAR((values[0] + values[1] + values[2]) / 3, 8.0 / 7, 1e-15);
  // Sums in proportion to the numbers: no scatter.
  for (const double r : ratio_values({3, 6, 12}, {1, 2, 4})) EXPECT_NEAR(r, 3, 1e-15);
}

TEST(Batches, AnOctaveHas16Classes) {
  const SpectrumClasses classes(1e-6);
  EXPECT_EQ(classes.of(0), 0u);
  EXPECT_EQ(classes.of(-1), 0u);
  EXPECT_EQ(classes.of(1e-6), 0u);
  EXPECT_EQ(classes.of(1.01e-6), 1u);
  EXPECT_EQ(classes.of(0.02) - classes.of(0.01), 16u);
  EXPECT_EQ(classes.of(1e300), SpectrumClasses::count - 1);
  EXPECT_EQ(SpectrumClasses(0).of(1), SpectrumClasses::count - 1);
}

TEST(Batches, SpectraThatShareNothingAreAsUnlikelyAsTheSignsOfAllBatches) {
  std::vector<Batch> a(10), b(10);
  for (auto& batch : a) batch.spectra[ball_speeds][7] = 3;
  for (auto& batch : b) batch.spectra[ball_speeds][9] = 3;
  const auto test = test_spectra(a, b, ball_speeds);
  EXPECT_DOUBLE_EQ(test.distance, 1);
  // Two of 2^10 permutations; five standard deviations of 9999 draws.
  EXPECT_NEAR(test.probability, 2.0 / 1024, 5 * std::sqrt(2.0 / 1024 / 9999) + 1e-4);
  const auto same = test_spectra(a, a, ball_speeds);
  EXPECT_EQ(same.distance, 0);
  EXPECT_EQ(same.probability, 1);
}

/// Batches whose speed drifts from batch to batch, alike in both runs, and varies within: far from
/// independent events. @param shift  of the speeds, in classes
std::vector<Batch> drifting_batches(std::mt19937_64& random, double shift) {
  std::vector<Batch> batches(20);
  std::normal_distribution<double> normal;
  for (std::size_t k = 0; k < batches.size(); ++k) {
    const double centre = 100 + 0.5 * static_cast<double>(k) + 4 * normal(random) + shift;
    for (int i = 0; i < 50; ++i)
      batches[k].spectra[wall_speeds][static_cast<std::size_t>(centre + 3 * normal(random))] += 1;
  }
  return batches;
}

TEST(Batches, CorrelatedSpectraRaiseNoMoreFalseAlarmsThanNominal) {
  constexpr std::uint64_t seed = 20110101;
  std::cout << "seed " << seed << "\n";
  std::mt19937_64 random(seed);
  constexpr int pairs = 300;
  int false_alarms = 0, found = 0;
  for (int k = 0; k < pairs; ++k) {
    const auto a = drifting_batches(random, 0), b = drifting_batches(random, 0);
    false_alarms += test_spectra(a, b, wall_speeds).probability <= 0.05;
    if (k % 10 == 0)
      found += test_spectra(a, drifting_batches(random, 8), wall_speeds).probability <= 0.05;
  }
  std::cout << false_alarms << " false alarms in " << pairs << " pairs, " << found
            << " of 30 shifts found\n";
  // 15 are nominal; 99.9 % of binomial draws are from 5 to 28.
  EXPECT_LE(false_alarms, 28);
  EXPECT_GE(false_alarms, 5);
  EXPECT_EQ(found, 30);
}

}  // namespace
}  // namespace edmill::compare
