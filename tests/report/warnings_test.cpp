#include "report/warnings.hpp"

#include <gtest/gtest.h>

#include <random>

namespace {

using namespace edmill::report;
namespace model = edmill::model;

RunFacts good_facts() {
  RunFacts f;
  f.end_reason = model::EndReason::end_time;
  f.start_time = 1, f.end_time = 11;
  f.collisions = {1000, 1000, 1000, 1000};
  f.milling_dose = 50, f.wall_work = 50;
  f.touched_dose_share = 0.03, f.supplied_energy = 0.4;
  return f;
}

Batches steady() {
  Batches b{{}, 0.5};
  std::mt19937 random(1);
  std::normal_distribution<double> noise(5, 0.05);
  for (int k = 0; k < 20; ++k) b.means.push_back(noise(random));
  return b;
}

std::vector<std::string> kinds(const RunFacts& f, const Batches& b) {
  std::vector<std::string> list;
  for (const auto& warning : warnings_of(f, b)) list.push_back(warning.kind);
  return list;
}

using Kinds = std::vector<std::string>;

TEST(Warnings, AGoodRunHasNone) {
  EXPECT_EQ(kinds(good_facts(), steady()), Kinds{});
  EXPECT_EQ(kinds(good_facts(), {}), Kinds{});
}

TEST(Warnings, ALargeShareOfTheDoseByTheLeastSeparationSpeedIsTold) {
  auto f = good_facts();
  f.touched_dose_share = 0.0501;
  EXPECT_EQ(kinds(f, steady()), Kinds{"separation_share"});
  EXPECT_NE(warnings_of(f, steady())[0].text.find("5.0 %"), std::string::npos);
}

TEST(Warnings, MoreThanOnePercentOfTheDoseAsSuppliedEnergyIsTold) {
  auto f = good_facts();
  f.supplied_energy = 0.499;  // the dose is 50 J
  EXPECT_EQ(kinds(f, steady()), Kinds{});
  f.supplied_energy = 0.76;
  EXPECT_EQ(kinds(f, steady()), Kinds{"supplied_energy"});
  EXPECT_NE(warnings_of(f, steady())[0].text.find("1.5 %"), std::string::npos);
}

TEST(Warnings, AFirstBatchThatStandsApartIsATransient) {
  auto b = steady();
  b.means[0] = 4.5;  // 10 standard deviations below
  EXPECT_EQ(kinds(good_facts(), b), Kinds{"transient"});
}

TEST(Warnings, HalvesThatDifferAreATransient) {
  auto b = steady();
  for (std::size_t k = 0; k < 20; ++k) b.means[k] += 0.015 * static_cast<double>(k);
  EXPECT_EQ(kinds(good_facts(), b), Kinds{"transient"});
}

TEST(Warnings, SteadyRunsAreCalledTransientAboutAsRarelyAsTheTestsSay) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(5, 0.05);
  int told = 0;
  for (int run = 0; run < 2000; ++run) {
    Batches b{{}, 0.5};
    for (int k = 0; k < 20; ++k) b.means.push_back(noise(random));
    told += !kinds(good_facts(), b).empty();
  }
  // Two tests at 1 % each: 20 to 40 expected, with 4 standard deviations around.
  EXPECT_GT(told, 10);
  EXPECT_LT(told, 65);
}

TEST(Warnings, FewerThanAThousandCollisionsAreTooFew) {
  auto f = good_facts();
  f.collisions = {0, 0, 999, 0};
  EXPECT_EQ(kinds(f, steady()), Kinds{"too_few_collisions"});
  f.collisions[2] = 1000;
  EXPECT_EQ(kinds(f, steady()), Kinds{});
}

TEST(Warnings, AWideIntervalIsTold) {
  Batches b{{}, 0.5};
  for (int k = 0; k < 20; ++k) b.means.push_back(k % 2 ? 3 : 7);  // t 2.09 * 2.05 / sqrt(20) = 0.96 of 5
  EXPECT_EQ(kinds(good_facts(), b), Kinds{"wide_interval"});
}

TEST(Warnings, EnergyThatDoesNotCloseIsTold) {
  auto f = good_facts();
  f.closure = -1e-7;
  EXPECT_EQ(kinds(f, steady()), Kinds{"energy"});
  f.closure = 1e-9;
  EXPECT_EQ(kinds(f, steady()), Kinds{});
}

TEST(Warnings, ARunThatDidNotReachItsEndIsTold) {
  for (const std::string reason : {"interrupted", "inelastic_collapse", "undecided"}) {
    auto f = good_facts();
    f.end_reason = *model::end_reason_named(reason);
    EXPECT_EQ(kinds(f, steady()), Kinds{"end_reason"}) << reason;
  }
}

}  // namespace
