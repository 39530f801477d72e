// Whole comparisons of logs with known statistics: differences are found, without false alarms.
#include "compare/comparison.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "base/errors.hpp"
#include "program.hpp"
#include "synthetic_log.hpp"

namespace edmill::compare {
namespace {

class Comparing : public ProgramTest {
 protected:
  Comparison compare_texts(
      const std::string& a, const std::string& b, ComparisonOptions options = {}) const {
    write("a.csv", a);
    write("b.csv", b);
    options.a = scratch / "a.csv";
    options.b = scratch / "b.csv";
    return compare(options);
  }
  /// A log, and the same after `change` of every event; where it returns false the event is left
  /// out.
  template <class Change>
  Comparison compare_changed(const Change& change, const ComparisonOptions& options = {}) const {
    const auto a = synthetic_events(1);
    std::vector<SyntheticEvent> b;
    for (std::size_t k = 0; k < a.size(); ++k) {
      auto e = a[k];
      if (change(k, e)) b.push_back(e);
    }
    return compare_texts(log_text(a), log_text(b), options);
  }
  static std::vector<std::string> differing(const Comparison& c) {
    std::vector<std::string> names;
    for (const auto& q : c.quantities)
      if (q.verdict == Verdict::differ) names.push_back(q.name);
    return names;
  }
  static const Quantity& quantity(const Comparison& c, std::string_view name) {
    const auto q = std::find_if(c.quantities.begin(), c.quantities.end(),
        [&](const Quantity& q) { return q.name == name; });
    EXPECT_NE(q, c.quantities.end()) << name;
    return *q;
  }
};

TEST_F(Comparing, IdenticalLogsAgreeThroughout) {
  const auto c = compare_changed([](std::size_t, SyntheticEvent&) { return true; });
  EXPECT_EQ(c.verdict, Verdict::agree);
  EXPECT_EQ(c.events.agreeing, c.a.events);
  EXPECT_GT(c.a.events, 3500u);
  EXPECT_FALSE(c.events.first);
  EXPECT_FALSE(c.events.digits_lost_per_event);
  EXPECT_EQ(c.quantities.size(), 10u);
  for (const auto& q : c.quantities) EXPECT_EQ(q.verdict, Verdict::agree) << q.name;
}

TEST_F(Comparing, EveryWallOfTheLogsHasARate) {
  const auto c = compare_changed([](std::size_t, SyntheticEvent& e) {
    if (e.with_wall && e.partner == 1) e.partner = 5;
    return true;
  });
  EXPECT_EQ(c.quantities.size(), 13u);
  EXPECT_GT(*quantity(c, "collision_rate_wall_5").b, 30);
  EXPECT_EQ(*quantity(c, "collision_rate_wall_5").a, 0);
  EXPECT_EQ(quantity(c, "collision_rate_wall_4").reason, "no such collisions");
  EXPECT_EQ(quantity(c, "collision_rate_ball_ball").verdict, Verdict::agree);
}

TEST_F(Comparing, BallsMayComeInEitherOrder) {
  const auto c = compare_changed([](std::size_t, SyntheticEvent& e) {
    if (!e.with_wall) std::swap(e.ball, e.partner);
    return true;
  });
  EXPECT_TRUE(c.events.agree_throughout());
}

TEST_F(Comparing, TheFirstDifferenceOfEachKindIsFound) {
  const auto first = [&](auto&& change) {
    return compare_changed([&](std::size_t k, SyntheticEvent& e) {
      if (k == 700) change(e);
      return true;
    });
  };
  const auto expect = [](const Comparison& c, const std::string& quantity, double relative) {
    ASSERT_TRUE(c.events.first) << quantity;
    EXPECT_EQ(c.events.agreeing, 700u);
    EXPECT_EQ(c.events.first->quantity, quantity);
    EXPECT_EQ(c.events.first->a.line, 702u);
    if (relative > 0) {
      EXPECT_NEAR(c.events.first->relative_difference, relative, 1e-3 * relative);
    }
  };
  expect(first([](SyntheticEvent& e) {
    e.partner = e.with_wall              ? (e.partner + 1) % 3
        : (e.ball + 1) % 10 == e.partner ? (e.ball + 2) % 10
                                         : (e.ball + 1) % 10;
  }),
      "partners", 0);
  expect(first([](SyntheticEvent& e) { e.ball += 100; }), "partners", 0);
  const auto scan = compare_changed([](std::size_t, SyntheticEvent&) { return true; }).a;
  const auto event = synthetic_events(1)[700];
  const auto scale = [&](std::size_t v, double x) {
    return std::max(std::abs(x), scan.mean_magnitude[v]);
  };
  expect(first([](SyntheticEvent& e) { e.time += 1e-7; }), "time",
      1e-7 / scale(model::time, event.time));
  expect(first([](SyntheticEvent& e) { e.approach_speed += 1e-7; }), "approach_speed",
      1e-7 / scale(model::approach_speed, event.approach_speed));
  expect(first([](SyntheticEvent& e) { e.slip_speed += 1e-7; }), "slip_speed",
      1e-7 / scale(model::slip_speed, event.slip_speed));
  expect(first([](SyntheticEvent& e) { e.milling_dose += 1e-9; }), "milling_dose",
      1e-9 / scale(model::milling_dose, event.milling_dose));
  expect(first([](SyntheticEvent& e) { e.wall_work += 1e-9; }), "wall_work",
      1e-9 / scale(model::wall_work, event.wall_work));
}

TEST_F(Comparing, DifferencesWithinTheToleranceAreNone) {
  const auto c = compare_changed([](std::size_t, SyntheticEvent& e) {
    e.milling_dose *= 1 + 1e-10;
    return true;
  });
  EXPECT_TRUE(c.events.agree_throughout());
  EXPECT_EQ(c.verdict, Verdict::agree);
  EXPECT_GT(c.events.largest[model::milling_dose], 5e-11);
}

TEST_F(Comparing, TheGrowthOfRoundingIsFitted) {
  // A difference of 1e-14 that grows by a digit in 200 events passes 1e-9 after 1000.
  const auto c = compare_changed([](std::size_t k, SyntheticEvent& e) {
    const double scale = std::max(e.approach_speed, 1.13);
    e.approach_speed += scale * std::pow(10, -14 + static_cast<double>(k) / 200);
    return k < 1500;
  });
  ASSERT_TRUE(c.events.digits_lost_per_event);
  EXPECT_NEAR(*c.events.digits_lost_per_event, 1.0 / 200, 1e-4);
  EXPECT_NEAR(static_cast<double>(c.events.agreeing), 1000, 20);
  EXPECT_EQ(c.events.same_partners, 1500u);
}

TEST_F(Comparing, ANumberOfEventsCanBeAskedFor) {
  ComparisonOptions options;
  const auto verdict = [&](std::uint64_t events) {
    options.events = events;
    const auto c = compare_changed(
        [](std::size_t k, SyntheticEvent& e) {
          if (k >= 700) e.slip_speed += 1e-6;
          return true;
        },
        options);
    EXPECT_EQ(c.verdict, *c.events_verdict);
    return *c.events_verdict;
  };
  EXPECT_EQ(verdict(700), Verdict::agree);
  EXPECT_EQ(verdict(701), Verdict::differ);
  options.events = 1000000;
  const auto c = compare_changed([](std::size_t, SyntheticEvent&) { return true; }, options);
  EXPECT_EQ(c.verdict, Verdict::too_few);
}

TEST_F(Comparing, EachQuantityThatDiffersIsFound) {
  using Names = std::vector<std::string>;
  const auto found = [&](const auto& change) {
    const auto c = compare_changed([&](std::size_t k, SyntheticEvent& e) { return change(k, e); });
    EXPECT_EQ(c.verdict, Verdict::differ);
    return differing(c);
  };
  const auto has = [](const Names& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  for (int wall = 0; wall < 3; ++wall) {
    const auto names = found([&](std::size_t k, SyntheticEvent& e) {
      return !(e.with_wall && e.partner == wall && k % 5 == 0);
    });
    for (int other = 0; other < 3; ++other)
      EXPECT_EQ(has(names, "collision_rate_wall_" + std::to_string(other)), other == wall);
  }
  EXPECT_TRUE(has(found([](std::size_t k, SyntheticEvent& e) { return e.with_wall || k % 5 != 0; }),
      "collision_rate_ball_ball"));
  EXPECT_EQ(found([](std::size_t, SyntheticEvent& e) { return e.wall_work *= 1.001, true; }),
      Names{"wall_work_rate"});
  EXPECT_TRUE(
      has(found([](std::size_t, SyntheticEvent& e) { return e.milling_dose *= 1.01, true; }),
          "milling_dose_rate"));
  const auto faster =
      found([](std::size_t, SyntheticEvent& e) { return e.approach_speed *= 1.02, true; });
  for (const auto* name :
      {"mean_approach_speed", "wall_approach_speed_spectrum", "ball_approach_speed_spectrum"})
    EXPECT_TRUE(has(faster, name)) << name;
}

TEST_F(Comparing, NoToleranceAtAllStillSeesTheSpectra) {
  ComparisonOptions options;
  options.tolerance = 0;
  const auto c = compare_changed(
      [](std::size_t, SyntheticEvent& e) {
        return e.approach_speed *= 1.05, e.milling_dose *= 1.05, true;
      },
      options);
  EXPECT_EQ(c.events.agreeing, 0u);
  for (const auto* name :
      {"wall_approach_speed_spectrum", "ball_approach_speed_spectrum", "milling_dose_spectrum"})
    EXPECT_EQ(quantity(c, name).verdict, Verdict::differ) << name;
}

TEST_F(Comparing, ASpectrumOfTheSameMeanIsFound) {
  // Dose moved from one half of the impacts to the other, its sum kept within each pair of impacts.
  auto a = synthetic_events(1), b = a;
  for (std::size_t k = 0; k + 1 < b.size(); k += 2) {
    const double sum = a[k].milling_dose + a[k + 1].milling_dose;
    b[k].milling_dose = 0.9 * sum;
    b[k + 1].milling_dose = 0.1 * sum;
  }
  const auto c = compare_texts(log_text(a), log_text(b));
  EXPECT_EQ(quantity(c, "milling_dose_spectrum").verdict, Verdict::differ);
  EXPECT_EQ(quantity(c, "milling_dose_rate").verdict, Verdict::agree);
}

TEST_F(Comparing, MeansAndIntervalsAreThoseOfTheProcess) {
  const auto c =
      compare_texts(log_text(synthetic_events(1, 100)), log_text(synthetic_events(2, 100)));
  EXPECT_EQ(c.verdict, Verdict::agree);
  // 400/s of which a tenth on a cap: 100 s give 40 ± 0.63, and an interval of 2.09 deviations.
  const auto& rate = quantity(c, "collision_rate_wall_0");
  EXPECT_NEAR(*rate.a, 40, 4 * 0.63);
  EXPECT_NEAR(*rate.a_half_width, 2.09 * 0.632, 0.6);
  EXPECT_NEAR(*rate.half_width, 2.09 * 0.632 * std::sqrt(2.0), 0.8);
  // <v> = exp(1/8); neighbours correlate by 0.95, so the mean varies like that of 40 times fewer
  // impacts.
  const auto& speed = quantity(c, "mean_approach_speed");
  const double deviation = 0.5 * std::exp(0.125) * std::sqrt(39.0 / 40000);
  EXPECT_NEAR(*speed.a, std::exp(0.125), 4 * deviation);
  EXPECT_GT(*speed.a_half_width, deviation);
  EXPECT_LT(*speed.a_half_width, 4 * deviation);
}

TEST_F(Comparing, ColumnsThatOneLogLacksAreNotCompared) {
  const auto events = synthetic_events(1);
  std::string text = "approach_speed,partner,partner_kind,ball,time\n";
  for (const auto& e : events)
    text += fmt::format("{},{},{},{},{}\n", e.approach_speed, e.partner,
        e.with_wall ? "wall" : "ball", e.ball, e.time);
  const auto c = compare_texts(log_text(events), text);
  EXPECT_TRUE(c.events.agree_throughout());
  EXPECT_EQ(c.verdict, Verdict::agree);
  EXPECT_EQ(quantity(c, "milling_dose_rate").reason, "no milling_dose in B");
  EXPECT_EQ(quantity(c, "wall_work_rate").verdict, Verdict::not_compared);
  EXPECT_EQ(quantity(c, "collision_rate_wall_0").verdict, Verdict::agree);
}

TEST_F(Comparing, TooFewEventsAreNotJudged) {
  const auto c =
      compare_texts(log_text(synthetic_events(1, 0.05)), log_text(synthetic_events(2, 0.05)));
  EXPECT_EQ(c.verdict, Verdict::too_few);
  EXPECT_EQ(compare_texts(log_text({}), log_text({})).verdict, Verdict::too_few);
}

TEST_F(Comparing, LimitsRestrictBothParts) {
  ComparisonOptions options;
  options.limits.from = 3;
  options.limits.until = 8;
  // B is wrong outside the limits only.
  const auto c = compare_changed(
      [](std::size_t, SyntheticEvent& e) {
        if (e.time < 3 || e.time > 8) e.approach_speed *= 2;
        return true;
      },
      options);
  EXPECT_EQ(c.verdict, Verdict::agree);
  EXPECT_TRUE(c.events.agree_throughout());
  EXPECT_EQ(c.times.from, 3);
  EXPECT_NEAR(c.times.until(), 8, 1e-12);
}

TEST_F(Comparing, OptionsThatDoNotFitAreExplained) {
  const auto text = log_text(synthetic_events(1));
  const auto expect = [&](const std::string& start, auto&& set) {
    ComparisonOptions options;
    set(options);
    try {
      compare_texts(text, text, options);
      ADD_FAILURE() << start;
    } catch (const InputError& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with(start)) << error.what();
    }
  };
  expect("--batch: found 3 s, 3 batches", [](ComparisonOptions& o) { o.batch = 3; });
  expect("--batch: found 0.001 s", [](ComparisonOptions& o) { o.batch = 0.001; });
  expect("--from, --until:", [](ComparisonOptions& o) { o.limits.from = 11; });
  expect("--from, --until:", [](ComparisonOptions& o) { o.limits.from = 5, o.limits.until = 4; });
}

TEST_F(Comparing, TwoGoodRunsRaiseAnAlarmInNoMoreThanFivePercentAndBadOnesDo) {
  constexpr std::uint64_t seed = 1000;
  constexpr int pairs = 150;
  std::cout << "seeds from " << seed << "\n";
  int false_alarms = 0, found = 0;
  for (int k = 0; k < pairs; ++k) {
    const auto a = synthetic_events(seed + 2 * static_cast<std::uint64_t>(k), 5);
    auto b = synthetic_events(seed + 2 * static_cast<std::uint64_t>(k) + 1, 5);
    const auto text = log_text(a);
    false_alarms += compare_texts(text, log_text(b)).verdict == Verdict::differ;
    if (k % 10 != 0) continue;
    // Six deviations of the difference of the means, 0.08 m/s in A and twice that in B.
    for (auto& e : b) e.approach_speed *= 2;
    found += compare_texts(text, log_text(b)).verdict == Verdict::differ;
  }
  std::cout << false_alarms << " false alarms in " << pairs << " pairs, " << found
            << " of 15 found\n";
  EXPECT_LE(false_alarms, 16);  // 7.5 are allowed on the average; the binomial exceeds 16 in 0.1 %
  EXPECT_EQ(found, 15);
}

}  // namespace
}  // namespace edmill::compare
