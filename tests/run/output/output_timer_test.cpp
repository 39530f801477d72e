// When outputs record, and where their intervals end.
#include <gtest/gtest.h>

#include <vector>

#include "core.hpp"
#include "output/output.hpp"
#include "output/table_output.hpp"

namespace edmill::output {
namespace {

using casefile::Quantity;
using casefile::TimerSpec;

/// Which of impacts at 1, 2, ... 9 s, with indices 10 to 18, are recorded.
std::vector<int> recorded(const TimerSpec& spec, double run_start = 0) {
  OutputTimer<double> timer(spec, run_start);
  std::vector<int> times;
  for (int t = 1; t < 10; ++t)
    if (timer.admits(t, static_cast<std::uint64_t>(9 + t))) times.push_back(t);
  return times;
}

TEST(OutputTimer, RecordsEverythingUnlessTold) {
  EXPECT_EQ(recorded({}), (std::vector<int>{1, 2, 3, 4, 5, 6, 7, 8, 9}));
  TimerSpec off;
  off.on = false;
  EXPECT_TRUE(recorded(off).empty());
}

TEST(OutputTimer, FirstStartAndFirstEndCount) {
  TimerSpec spec;
  spec.start_time = Quantity{4};
  EXPECT_EQ(recorded(spec), (std::vector<int>{4, 5, 6, 7, 8, 9}));
  spec.start_collision = 11;  // at 2 s: earlier
  EXPECT_EQ(recorded(spec), (std::vector<int>{2, 3, 4, 5, 6, 7, 8, 9}));
  spec.start_collision = 17;  // at 8 s: later
  EXPECT_EQ(recorded(spec), (std::vector<int>{4, 5, 6, 7, 8, 9}));
  spec.duration = Quantity{3};
  EXPECT_EQ(recorded(spec), (std::vector<int>{4, 5, 6, 7}));
  spec.collisions = 2;
  EXPECT_EQ(recorded(spec), (std::vector<int>{4, 5}));
  spec.collisions = 8;
  spec.end_time = Quantity{6};
  EXPECT_EQ(recorded(spec), (std::vector<int>{4, 5, 6}));
}

TEST(OutputTimer, DurationCountsFromWhereTheRecordBegan) {
  TimerSpec spec;
  spec.start_collision = 14;  // 5 s
  spec.duration = Quantity{2};
  EXPECT_EQ(recorded(spec), (std::vector<int>{5, 6, 7}));
  OutputTimer<double> timer(spec, 0);
  EXPECT_FALSE(timer.is_open());
  EXPECT_FALSE(timer.recorded(100));
  timer.admits(5, 14);
  EXPECT_EQ(timer.from(), 5);
  EXPECT_EQ(timer.until(100), 7);
  EXPECT_EQ(timer.until(6), 6);
}

TEST(OutputTimer, RunThatBeginsLaterThanTheRecord) {
  TimerSpec spec;
  spec.start_time = Quantity{1};
  spec.duration = Quantity{2};
  OutputTimer<double> timer(spec, 5);
  EXPECT_EQ(timer.from(), 5);
  EXPECT_EQ(timer.until(100), 7);
}

/// Ends of the rows for impacts at these times and a record that ends at `until`.
std::vector<std::pair<double, double>> rows(
    const TimerSpec& spec, const std::vector<double>& impacts, double until) {
  OutputTimer<double> timer(spec, 0);
  IntervalClock<double> clock(spec);
  std::vector<std::pair<double, double>> list;
  const auto row = [&](double begin, double end) { list.emplace_back(begin, end); };
  std::uint64_t index = 0;
  for (const double t : impacts) {
    timer.admits(t, index++);
    clock.pass(timer, t, row);
  }
  clock.finish(timer.from(), timer.until(until), row);
  return list;
}

TEST(IntervalClock, RowsCoverTheRecordWithoutGaps) {
  TimerSpec spec;
  spec.interval = Quantity{2};
  using Rows = std::vector<std::pair<double, double>>;
  EXPECT_EQ(rows(spec, {0.5, 7}, 7.5), (Rows{{0, 2}, {2, 4}, {4, 6}, {6, 7.5}}));
  EXPECT_EQ(rows(spec, {}, 4), (Rows{{0, 2}, {2, 4}}));
  EXPECT_EQ(rows(spec, {4}, 4), (Rows{{0, 2}, {2, 4}}));
  spec.end_time = Quantity{3};
  EXPECT_EQ(rows(spec, {0.5, 2.5, 9}, 10), (Rows{{0, 2}, {2, 3}}));
  spec.max_rows = 1;
  EXPECT_EQ(rows(spec, {0.5, 2.5, 9}, 10), (Rows{{0, 2}}));
}

/// An impact at the very end of the record belongs to the last row, so that row must still be open.
TEST(IntervalClock, LastRowStaysOpenForAnImpactAtTheEnd) {
  TimerSpec spec;
  spec.interval = Quantity{2};
  spec.end_time = Quantity{4};
  OutputTimer<double> timer(spec, 0);
  IntervalClock<double> clock(spec);
  int count = 0;
  ASSERT_TRUE(timer.admits(4, 0));
  clock.pass(timer, 4, [&](double, double) { ++count; });
  EXPECT_EQ(count, 1);
}

/// A tenth is no double: rows must neither vanish nor appear by its rounding.
TEST(IntervalClock, TenthsOfASecond) {
  TimerSpec spec;
  spec.interval = Quantity{1, 10};
  EXPECT_EQ(rows(spec, {}, 30.0).size(), 300u);
  EXPECT_EQ(rows(spec, {0.3, 17.7, 29.9}, 30.0).size(), 300u);
}

TEST(Accumulator, OfNothingHasNoAverage) {
  const Accumulator<double> nothing;
  EXPECT_EQ(nothing.value(Statistic::sum, 1, 0), 0);
  for (const auto s :
      {Statistic::average, Statistic::minimum, Statistic::maximum, Statistic::percentage})
    EXPECT_FALSE(nothing.value(s, 1, 0));
  EXPECT_FALSE(nothing.value(Statistic::rate, 0, 0));
}

TEST(Accumulator, AddsToOthers) {
  Accumulator<double> a, b;
  a.add(3), a.add(-1), b.add(10);
  Accumulator<double> all = a;
  all.add(b);
  EXPECT_EQ(all.value(Statistic::sum, 4, 24), 12);
  EXPECT_EQ(all.value(Statistic::average, 4, 24), 4);
  EXPECT_EQ(all.value(Statistic::minimum, 4, 24), -1);
  EXPECT_EQ(all.value(Statistic::maximum, 4, 24), 10);
  EXPECT_EQ(all.value(Statistic::rate, 4, 24), 3);
  EXPECT_EQ(all.value(Statistic::percentage, 4, 24), 50);
}

}  // namespace
}  // namespace edmill::output
