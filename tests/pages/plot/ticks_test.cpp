#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "plot/chart.hpp"

namespace {

using edmill::plot::brief;
using edmill::plot::fitting_ticks;
using edmill::plot::linear_ticks;
using edmill::plot::log_ticks;
using edmill::plot::readable;
using edmill::plot::Tick;
using edmill::plot::with_interval;

std::vector<std::string> labels(const std::vector<Tick>& ticks) {
  std::vector<std::string> texts;
  for (const auto& tick : ticks)
    if (!tick.label.empty()) texts.push_back(tick.label);
  return texts;
}

using Texts = std::vector<std::string>;

TEST(Ticks, StandAtRoundNumbersWithAsManyDecimalsAsTheyNeed) {
  EXPECT_EQ(labels(linear_ticks(0, 10)), (Texts{"0", "2", "4", "6", "8", "10"}));
  EXPECT_EQ(labels(linear_ticks(0, 0.31)), (Texts{"0.0", "0.1", "0.2", "0.3"}));
  EXPECT_EQ(labels(linear_ticks(-1, 1)), (Texts{"\u22121.0", "\u22120.5", "0.0", "0.5", "1.0"}));
  EXPECT_EQ(labels(linear_ticks(0, 12400)), (Texts{"0", "5000", "10\u202f000"}));
  EXPECT_EQ(labels(linear_ticks(0, 1.2e6)), (Texts{"0", "5 \u00d7 10\u2075", "1 \u00d7 10\u2076"}));
  EXPECT_EQ(labels(linear_ticks(1000000, 1000000.5)),
      (Texts{"1\u202f000\u202f000.0", "1\u202f000\u202f000.1", "1\u202f000\u202f000.2",
          "1\u202f000\u202f000.3", "1\u202f000\u202f000.4", "1\u202f000\u202f000.5"}));
  EXPECT_EQ(labels(fitting_ticks(1000000, 1000000.5, 6, 380)),
      (Texts{"1\u202f000\u202f000.0", "1\u202f000\u202f000.2", "1\u202f000\u202f000.4"}));
  EXPECT_EQ(labels(fitting_ticks(0, 10, 6, 380)), labels(linear_ticks(0, 10)));
  EXPECT_EQ(linear_ticks(0, 0.31)[3].place, 0.3);  // not 3 * 0.1
}

RC_GTEST_PROP(Ticks, LinearOnesAreEvenFewAndInsideTheRange, ()) {
  const double low = *rc::gen::inRange(-100000, 100000) * std::pow(10.0, *rc::gen::inRange(-8, 6));
  const double range = *rc::gen::inRange(1, 100000) * std::pow(10.0, *rc::gen::inRange(-2, 6));
  const double high = low + std::max(range, 1e-3 * std::abs(low));
  const auto ticks = linear_ticks(low, high);
  RC_ASSERT(ticks.size() >= 2u);
  RC_ASSERT(ticks.size() <= 6u);
  const double slack = 1e-6 * (high - low), step = ticks[1].place - ticks[0].place;
  RC_ASSERT(ticks.front().place >= low - slack);
  RC_ASSERT(ticks.back().place <= high + slack);
  for (std::size_t k = 1; k < ticks.size(); ++k)
    RC_ASSERT(std::abs(ticks[k].place - ticks[k - 1].place - step) < 1e-6 * step);
  // 1, 2 or 5 times a power of ten
  const double mantissa = step / std::pow(10.0, std::floor(std::log10(step) + 1e-9));
  RC_ASSERT(std::abs(mantissa - 1) < 1e-6 || std::abs(mantissa - 2) < 1e-6 ||
      std::abs(mantissa - 5) < 1e-6);
}

TEST(Ticks, LogarithmicOnesArePowersOfTenWithMarksBetween) {
  const auto ticks = log_ticks(1e-3, 10);
  EXPECT_EQ(labels(ticks), (Texts{"10\u207b\u00b3", "0.01", "0.1", "1", "10"}));
  EXPECT_EQ(ticks.size(), 4 * 9u + 1u);
  EXPECT_EQ(labels(log_ticks(2e-9, 0.3)).size(), 4u);  // every second of 8 powers
}

TEST(Readable, NumbersHaveTheAskedDigitsAndRealSigns) {
  EXPECT_EQ(readable(0.180349, 4), "0.1803");
  EXPECT_EQ(readable(-1108.33, 6), "\u22121108.33");
  EXPECT_EQ(readable(163797, 7), "163\u202f797.0");
  EXPECT_EQ(readable(1.25e-7, 2), "1.2 \u00d7 10\u207b\u2077");
  EXPECT_EQ(readable(9.9996, 4), "10.00");
  EXPECT_EQ(readable(0.0), "0");
  EXPECT_EQ(readable(std::nan("")), "\u2013");
}

TEST(Readable, TheHalfWidthSaysHowManyDigitsTheValueHas) {
  using Pair = std::pair<std::string, std::string>;
  EXPECT_EQ(with_interval(5.54164, 0.0312), Pair("5.542", "0.031"));
  EXPECT_EQ(with_interval(0.180452, 0.00087), Pair("0.18045", "0.00087"));
  EXPECT_EQ(with_interval(17241.8, 251.0), Pair("17\u202f242", "251"));
  EXPECT_EQ(with_interval(5.54164, 0), Pair("5.542", "0"));
}

TEST(Readable, BriefNumbersHaveNoZerosAtTheEnd) {
  EXPECT_EQ(brief(38), "38");
  EXPECT_EQ(brief(0.5), "0.5");
  EXPECT_EQ(brief(1053.9999999999998), "1054");
  EXPECT_EQ(brief(163797), "163\u202f797");
  EXPECT_EQ(brief(12345678, 12), "12\u202f345\u202f678");
  EXPECT_EQ(brief(2.5e-9), "2.5 \u00d7 10\u207b\u2079");
}

}  // namespace
