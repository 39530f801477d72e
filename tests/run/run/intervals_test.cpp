// Intervals of the rates of one run, the end of a run by its precision, and the milling time.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "base/statistics.hpp"
#include "core.hpp"
#include "io/summary.hpp"
#include "simulated.hpp"

namespace {

using namespace edmill;
using numerics::Batches;

using Periods = std::int64_t;

/// Batches of a quantity that has in each period its number.
Batches<double> counted(Periods periods) {
  Batches<double> batches;
  batches.begin({7, 0.25});
  double total = 0;
  for (Periods k = 0; k < periods; ++k) {
    total += static_cast<double>(k);
    while (!(Instant<double>{7 + k + 1, 0.25} < batches.next())) batches.close({total});
  }
  return batches;
}

TEST(Batches, AreWholePeriodsJoinedInPairs) {
  for (const Periods periods : {1, 5, 127, 128, 129, 255, 256, 257, 1000, 12345}) {
    const auto batches = counted(periods);
    const auto amounts = batches.amounts(0);
    ASSERT_EQ(amounts.size(), batches.count());
    EXPECT_LT(batches.count(), Batches<double>::most);
    EXPECT_GE(batches.count(),
        std::min<std::size_t>(static_cast<std::size_t>(periods), Batches<double>::most / 2));
    const auto length = batches.periods();
    EXPECT_EQ(static_cast<Periods>(batches.count()), periods / length);
    for (std::size_t b = 0; b < amounts.size(); ++b) {
      const auto first = static_cast<double>(static_cast<Periods>(b) * length),
                 n = static_cast<double>(length);
      EXPECT_EQ(amounts[b], n * first + n * (n - 1) / 2)
          << b << " of " << periods;  // an arithmetic series
    }
  }
}

casefile::CaseSpec case_with(const std::string& more, const std::string& powder = "") {
  return casefile::parse_case("[run]\nend_time = \"3 s\"\nstart_time = \"0.5 s\"\n" + more +
          "[mill]\ntype = \"spex8000\"\n[vessel]\ndiameter = \"38 mm\"\nheight = \"57 mm\"\n"
          "[contact]\nrestitution = 0.53\nfriction = 0.4\n[powder]\nmass = \"5 g\"\n" +
          powder + "[[balls]]\ncount = 7\ndiameter = \"6.35 mm\"\n",
      "test.toml");
}
casefile::CaseSpec ending_at(double time, casefile::CaseSpec spec) {
  spec.end_time = casefile::Quantity::exactly(time);
  return spec;
}
io::Summary<double> summary_of(const casefile::CaseSpec& spec) {
  return simulated(spec, casefile::build_case<double>(spec));
}

TEST(Intervals, AreThoseOfTheDosesBetweenTheEndsOfBatches) {
  const auto s = summary_of(case_with("", "target_dose = \"10 kJ/g\"\n"));
  ASSERT_TRUE(s.intervals.any());
  // By runs that end where a batch does.
  double before = 0;
  std::vector<double> rates;
  for (std::size_t b = 1; b <= s.intervals.batches; ++b) {
    const double end = 0.5 + static_cast<double>(b) * s.intervals.batch_length;
    const auto part = summary_of(ending_at(end, case_with("")));
    rates.push_back((part.milling_dose - before) / s.intervals.batch_length);
    before = part.milling_dose;
  }
  const auto e = numerics::series_estimate(rates);
  const double rate = s.milling_dose / s.duration(), period = s.period;
  const double whole = std::floor(s.duration() / period + 1e-9) * period;
  const auto part = summary_of(ending_at(0.5 + whole, case_with("")));
  const double end_effect = std::abs(rate - part.milling_dose / whole);
  EXPECT_GT(end_effect, 0);
  EXPECT_NEAR(s.intervals.dose_rate.half_width / (*e.half_width + end_effect), 1, 1e-3);
  EXPECT_NEAR(*s.milling_time(), 10e6 * 0.005 / rate, 1e-6);
  EXPECT_NEAR(*s.milling_time_half_width() / *s.milling_time(),
      s.intervals.dose_rate.half_width / rate, 1e-12);
}

TEST(Intervals, WhatCountsTowardTheTargetIsSummedByImpact) {
  struct Sum : engine::Observer<double> {
    double start, least, normal = 0, large = 0;
    Sum(double from, double limit) : start(from), least(limit) {}
    void on_impact(const engine::Impact<double>& i, engine::Simulation<double>& s) override {
      if (s.seconds() < start) return;
      normal += i.outcome.normal_dose;
      if (i.outcome.milling_dose >= least) large += i.outcome.milling_dose;
    }
  };
  for (const std::string rule : {"counts = \"normal\"\n", "counts_above = \"1 mJ\"\n"}) {
    const auto spec = case_with("", "target_dose = \"10 kJ/g\"\n" + rule);
    Sum sum(0.5, 1e-3);
    const auto s = simulated(spec, casefile::build_case<double>(spec), &sum);
    const double expected = rule.find("normal") != rule.npos ? sum.normal : sum.large;
    EXPECT_NEAR(s.target->counted_dose_rate * s.duration() / expected, 1, 1e-12) << rule;
    EXPECT_LT(s.target->counted_dose_rate, s.milling_dose / s.duration());
    EXPECT_GT(s.target->counted_dose_rate, 0);
  }
}

TEST(Intervals, NothingThatCountsGivesNoMillingTime) {
  const auto s = summary_of(case_with("", "target_dose = \"1 J/kg\"\ncounts_above = \"1 kJ\"\n"));
  EXPECT_FALSE(s.milling_time().has_value());
  EXPECT_NE(io::summary_json(s).find("\"milling_time\": null"), std::string::npos);
}

/// The evidence of several states in 24 periods after the first 10. @param vessel  diameter and
/// height [mm]
std::string states_of(const std::string& mill, double period, std::array<double, 2> vessel,
    int balls, double diameter, int seed) {
  const auto text = fmt::format(
      "[run]\nstart_time = \"{} s\"\nend_time = \"{} s\"\ngravity = \"9.81 m/s2\"\nseed = "
      "{}\n[mill]\n{}\n"
      "[vessel]\ndiameter = \"{} mm\"\nheight = \"{} mm\"\n[contact]\nrestitution = 0.8\nfriction "
      "= 0.4\n"
      "[[balls]]\ncount = {}\ndiameter = \"{} mm\"\n",
      10 * period, 34 * period, seed, mill, vessel[0], vessel[1], balls, diameter);
  return summary_of(casefile::parse_case(text, "test.toml")).intervals.several_states;
}

TEST(Intervals, ChargesThatDoNotMixAreOfSeveralStates) {
  const auto in_spex = [](int balls, int seed) {
    return states_of(
        "type = \"spex8000\"\nspeed = \"1054 rpm\"", 60.0 / 1054, {38, 57}, balls, 6, seed);
  };
  for (const int seed : {1, 2, 3}) {
    for (const int balls : {3, 7, 28}) EXPECT_EQ(in_spex(balls, seed), "") << balls << " " << seed;
    EXPECT_NE(in_spex(1, seed).find("one or two balls"), std::string::npos) << seed;
    // Large balls in a slow drum lie side by side, each in its place.
    const auto in_drum =
        states_of("type = \"drum\"\nspeed = \"100 rpm\"", 0.6, {100, 60}, 14, 12.7, seed);
    EXPECT_NE(in_drum, "") << seed;
  }
}

TEST(Intervals, StandInTheSummaryWithTheWarnings) {
  const auto short_run =
      nlohmann::json::parse(io::summary_json(summary_of(ending_at(0.6, case_with("")))));
  EXPECT_TRUE(short_run.at("warnings").contains("too_short"));
  EXPECT_FALSE(short_run.at("intervals").contains("milling_dose_rate"));
  const auto long_run = nlohmann::json::parse(io::summary_json(summary_of(case_with(""))));
  const auto& widths = long_run.at("intervals");
  for (const char* rate : {"milling_dose_rate", "inverse_milling_dose_rate", "wall_work_rate"})
    EXPECT_GT(widths.at(rate).get<double>(), 0) << rate;
  EXPECT_GT(widths.at("impact_rate").at("wall_2").get<double>(), 0);
  EXPECT_EQ(
      widths.at("milling_dose_rate_of_batches").size(), widths.at("batches").get<std::size_t>());
}

TEST(Precision, ARunEndsWhenItsDoseRateIsKnownSoWell) {
  const auto spec = case_with("dose_rate_precision = 0.03\n");
  const auto s = summary_of(ending_at(1000, spec));
  EXPECT_EQ(model::name(s.end_reason), "dose_rate_precision");
  EXPECT_LE(s.intervals.dose_rate.half_width, 0.031 * s.milling_dose / s.duration());
  EXPECT_LT(s.end_time, 500);
  // The limit that is not reached is told.
  const auto early = summary_of(ending_at(1, spec));
  EXPECT_EQ(early.end_reason, model::EndReason::end_time);
  EXPECT_EQ(std::ranges::count(early.warnings, "precision", &io::Warning::kind), 1);
}

}  // namespace
