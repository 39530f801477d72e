#include <gtest/gtest.h>

#include <random>

#include "base/clean_text.hpp"
#include "run/run_statistics.hpp"

namespace {

using namespace edmill::run;
namespace model = edmill::model;
using edmill::io::Facts;
using Rates = std::vector<double>;

Facts good_facts() {
  edmill::io::Summary<double> s;
  s.end_time = 10;
  s.collisions[0] = s.total_impacts = 4000;
  s.milling_dose = 1, s.touched_dose = 0.03, s.supplied_energy = 0.008;
  return facts_of(s);
}

Rates steady() {
  Rates rates;
  std::mt19937 random(1);
  std::normal_distribution<double> noise(5, 0.05);
  for (int k = 0; k < 20; ++k) rates.push_back(noise(random));
  return rates;
}

std::vector<edmill::io::Warning> warnings_of(
    Facts f, const Rates& rates, const std::optional<double>& wanted_precision = {}) {
  if (!rates.empty()) f.set("intervals/milling_dose_rate_of_batches", rates);
  return edmill::run::warnings_of(f, wanted_precision);
}
std::vector<std::string> kinds(
    const Facts& f, const Rates& rates, const std::optional<double>& wanted_precision = {}) {
  std::vector<std::string> list;
  for (const auto& warning : warnings_of(f, rates, wanted_precision)) list.push_back(warning.kind);
  return list;
}

using Kinds = std::vector<std::string>;

TEST(Percent, HasNoExponent) {
  EXPECT_EQ(edmill::percent(1), "100 %");
  EXPECT_EQ(edmill::percent(0.996), "100 %");
  EXPECT_EQ(edmill::percent(0.0714), "7.1 %");
  EXPECT_EQ(edmill::percent(12.3), "1230 %");
}

TEST(Warnings, AGoodRunHasNone) {
  EXPECT_EQ(kinds(good_facts(), steady()), Kinds{});
  EXPECT_EQ(kinds(good_facts(), {}), Kinds{"too_short"});
}

TEST(Warnings, EvidenceOfSeveralStatesIsTold) {
  auto f = good_facts();
  f.set("intervals/several_states", std::string("its impacts repeat"));
  EXPECT_EQ(kinds(f, steady()), Kinds{"several_states"});
  EXPECT_NE(warnings_of(f, steady())[0].text.find("its impacts repeat"), std::string::npos);
}

TEST(Warnings, MoreThanOnePercentOfTheDoseAsSuppliedEnergyIsTold) {
  auto f = good_facts();
  f.set("least_separation/supplied_energy_share", 0.00998);
  EXPECT_EQ(kinds(f, steady()), Kinds{});
  f.set("least_separation/supplied_energy_share", 0.0152);
  EXPECT_EQ(kinds(f, steady()), Kinds{"supplied_energy"});
  EXPECT_NE(warnings_of(f, steady())[0].text.find("1.5 %"), std::string::npos);
}

/// A run without dose, whose balls gain energy.
edmill::io::Summary<double> elastic(std::uint64_t touched, double supplied) {
  edmill::io::Summary<double> s;
  s.end_reason = model::EndReason::end_time, s.end_time = 10;
  s.collisions[0] = 10000, s.touched_impacts = touched;
  s.energy_at_start.kinetic = 1, s.energy_at_end.kinetic = 1 + supplied,
  s.supplied_energy = supplied;
  return s;
}
Kinds kinds(const edmill::io::Summary<double>& s) { return kinds(facts_of(s), steady()); }

TEST(Warnings, EnergyThatIsSuppliedWithoutADoseIsTold) {
  EXPECT_EQ(kinds(elastic(400, 0.009)), Kinds{});
  EXPECT_EQ(kinds(elastic(400, 9.5)), Kinds{"supplied_energy"});
  EXPECT_NE(
      warnings_of(facts_of(elastic(400, 9.5)), steady())[0].text.find("90 % of the kinetic energy"),
      std::string::npos);
}

TEST(Warnings, EnergyThatDoesNotCloseIsToldWithoutADose) {
  auto s = elastic(0, 0);
  s.energy_closure = -1e-8;
  EXPECT_EQ(kinds(s), Kinds{"energy"});
}

TEST(Warnings, ASmallDoseDoesNotEnlargeShares) {
  auto s = elastic(0, 0.009);
  s.milling_dose = 0.1, s.wall_work = 0.1;
  EXPECT_EQ(kinds(s), Kinds{});
}

TEST(Warnings, AFirstBatchThatStandsApartIsATransient) {
  auto b = steady();
  b[0] = 4.5;  // 10 standard deviations below
  EXPECT_EQ(kinds(good_facts(), b), Kinds{"transient"});
}

TEST(Warnings, HalvesThatDifferAreATransient) {
  auto b = steady();
  for (std::size_t k = 0; k < 20; ++k) b[k] += 0.015 * static_cast<double>(k);
  EXPECT_EQ(kinds(good_facts(), b), Kinds{"transient"});
}

TEST(Warnings, SteadyRunsAreCalledTransientAboutAsRarelyAsTheTestsSay) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(5, 0.05);
  int told = 0;
  for (int run = 0; run < 2000; ++run) {
    Rates b;
    for (int k = 0; k < 20; ++k) b.push_back(noise(random));
    told += !kinds(good_facts(), b).empty();
  }
  // Two tests at 1 % each: 20 to 40 expected, with 4 standard deviations around.
  EXPECT_GT(told, 10);
  EXPECT_LT(told, 65);
}

TEST(Warnings, FewerThanAThousandCollisionsAreTooFew) {
  auto f = good_facts();
  f.set("collisions/total", 999.0);
  EXPECT_EQ(kinds(f, steady()), Kinds{"too_few_collisions"});
  f.set("collisions/total", 1000.0);
  EXPECT_EQ(kinds(f, steady()), Kinds{});
}

TEST(Warnings, AWideIntervalIsTold) {
  Rates b;
  for (int k = 0; k < 20; ++k) b.push_back(k % 2 ? 3 : 7);  // t 2.09 * 2.05 / sqrt(20) = 0.96 of 5
  EXPECT_EQ(kinds(good_facts(), b), Kinds{"wide_interval"});
}

TEST(Warnings, APrecisionThatWasNotReachedIsToldWithTheTimeThatIsLeft) {
  auto f = good_facts();
  EXPECT_EQ(
      kinds(f, steady(), 0.002), Kinds{"precision"});  // t 2.09 * 0.05 / sqrt(20) = 0.5 % of 5
  EXPECT_EQ(kinds(f, steady(), 0.01), Kinds{});
}

TEST(Warnings, EnergyThatDoesNotCloseIsTold) {
  auto f = good_facts();
  f.set("energy/closure_relative", -1e-9 * 2);
  EXPECT_EQ(kinds(f, steady()), Kinds{"energy"});
  f.set("energy/closure_relative", 1e-9);
  EXPECT_EQ(kinds(f, steady()), Kinds{});
}

TEST(Warnings, ARunThatDidNotReachItsEndIsTold) {
  for (const std::string reason : {"interrupted", "inelastic_collapse", "undecided"}) {
    auto f = good_facts();
    f.set("end_reason", reason);
    EXPECT_EQ(kinds(f, steady()), Kinds{"end_reason"}) << reason;
  }
}

TEST(Warnings, ManyContactsInTheOrderOfARuleAreSaid) {
  auto f = good_facts();
  f.set("simultaneous_contacts", 0.009 * 4000);
  EXPECT_EQ(kinds(f, steady()), Kinds{});
  f.set("simultaneous_contacts", 0.011 * 4000);
  EXPECT_EQ(kinds(f, steady()), Kinds{"by_rule"});
}

}  // namespace
