#include <gtest/gtest.h>

#include "model/variables.hpp"
#include "report/sections.hpp"

namespace {

using namespace edmill;
using report::Series;

/// Intervals of one length, from 0; the rate of each is its number.
Series counting(std::size_t count, double length) {
  Series s;
  for (std::size_t k = 0; k < count; ++k) {
    const auto number = static_cast<double>(k);
    s.push_back({number * length, (number + 1) * length, number});
  }
  return s;
}

double amount_of(const Series& series) {
  double amount = 0;
  for (const auto& [begin, end, rate] : series) amount += rate * (end - begin);
  return amount;
}

TEST(Series, CoarserIntervalsKeepTheAmount) {
  auto fine = counting(10, 1);
  fine.back().end = 9.5;
  const auto coarse = report::coarser(fine, 4);
  ASSERT_EQ(coarse.size(), 4u);  // 3, 3, 3, 1
  EXPECT_DOUBLE_EQ(coarse[0].rate, 1);
  EXPECT_DOUBLE_EQ(coarse[3].rate, 9);
  EXPECT_DOUBLE_EQ(amount_of(coarse), amount_of(fine));
}

TEST(Series, FindsItsColumnAmongOthers) {
  using casefile::Statistic;
  casefile::OutputSpec output;
  const int dose = *model::find_variable("milling_dose"), work = *model::find_variable("wall_work");
  output.columns.push_back({work, {Statistic::sum, Statistic::rate}, "", "", "", false});
  output.columns.push_back({dose, {Statistic::sum, Statistic::rate}, "", "", "", false});
  report::OutputTable table;
  table.numbers = {{1, 10, 11, 12, 13}, {2, 20, 21, 22, 23}};
  const auto place = report::place_of_rate(output, dose);
  ASSERT_TRUE(place.has_value());
  const auto series = report::intervals_of(output, table, *place, 0.5);
  ASSERT_EQ(series.size(), 2u);
  EXPECT_EQ(series[0].rate, 13);
  EXPECT_EQ(series[1].rate, 23);
  EXPECT_EQ(series[0].begin, 0.5);
  EXPECT_EQ(series[1].begin, 1);
  EXPECT_FALSE(report::place_of_rate(output, *model::find_variable("collision")).has_value());
}

}  // namespace
