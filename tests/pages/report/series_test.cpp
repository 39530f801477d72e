#include <gtest/gtest.h>

#include "model/variables.hpp"
#include "report/run_folder.hpp"

namespace {

using namespace edmill;
using report::Series;

/// Intervals of one length, from 0; the rate of each is its number.
Series counting(std::size_t count, double length) {
  Series s;
  for (std::size_t k = 0; k < count; ++k) {
    s.begin.push_back(static_cast<double>(k) * length);
    s.end.push_back(static_cast<double>(k + 1) * length);
    s.rate.push_back(static_cast<double>(k));
  }
  return s;
}

TEST(Series, CoarserIntervalsKeepTheAmount) {
  auto fine = counting(10, 1);
  fine.end.back() = 9.5;
  const auto coarse = report::coarser(fine, 4);
  ASSERT_EQ(coarse.rate.size(), 4u);  // 3, 3, 3, 1
  EXPECT_DOUBLE_EQ(coarse.rate[0], 1);
  EXPECT_DOUBLE_EQ(coarse.rate[3], 9);
  double amount = 0, whole = 0;
  for (std::size_t k = 0; k < 4; ++k) amount += coarse.rate[k] * (coarse.end[k] - coarse.begin[k]);
  for (std::size_t k = 0; k < 10; ++k) whole += fine.rate[k] * (fine.end[k] - fine.begin[k]);
  EXPECT_DOUBLE_EQ(amount, whole);
}

TEST(Series, FindsItsColumnAmongOthers) {
  using casefile::Statistic;
  casefile::OutputSpec output;
  const int dose = *model::find_variable("milling_dose"), work = *model::find_variable("wall_work");
  output.columns.push_back({work, {Statistic::sum, Statistic::rate}, "", "", "", false});
  output.columns.push_back({dose, {Statistic::sum, Statistic::rate}, "", "", "", false});
  report::OutputTable table;
  table.numbers = {{1, 10, 11, 12, 13}, {2, 20, 21, 22, 23}};
  const auto series = report::series_of(output, table, dose, 0.5);
  ASSERT_TRUE(series.has_value());
  EXPECT_EQ(series->rate, (std::vector<double>{13, 23}));
  EXPECT_EQ(series->begin, (std::vector<double>{0.5, 1}));
  EXPECT_FALSE(report::series_of(output, table, *model::find_variable("collision"), 0).has_value());
}

}  // namespace
