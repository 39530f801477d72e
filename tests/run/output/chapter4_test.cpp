// The tables of the thesis's chapter 4, each against its definition.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "run_with_outputs.hpp"

namespace edmill {
namespace {

TEST_F(Chapter4, MillingDose) {
  const auto rows = read("milling_dose.csv");
  ASSERT_EQ(rows.size(), 1u);
  const double dose = sum("milling_dose"), rate = dose / (end - 30);
  EXPECT_NEAR(number(rows[0], "milling_dose [J]"), dose, 1e-12 * dose);
  EXPECT_NEAR(number(rows[0], "milling_dose_rate [W]"), rate, 1e-12 * rate);
  EXPECT_NEAR(number(rows[0], "inverse_milling_dose_rate [s/J]"), 1 / rate, 1e-12 / rate);
  EXPECT_NEAR(number(rows[0], "specific_milling_dose [J/kg]"), dose / 0.002, 1e-9 * dose);
  EXPECT_NEAR(number(rows[0], "specific_milling_dose_rate [W/kg]"), rate / 0.002, 1e-9 * rate);
  EXPECT_EQ(number(rows[0], "powder_mass [kg]"), 0.002);
  const double mass = 8000 * std::acos(-1.0) / 6 * std::pow(0.00952, 3);
  EXPECT_NEAR(number(rows[0], "charge_ratio [1]"), mass / 0.002, 1e-12);
}

TEST_F(Chapter4, FrequenciesAreThoseOfTheLog) {
  const auto rows = read("NVFrequencies.csv");
  ASSERT_EQ(rows.size(), 12u);
  double total = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto& row = rows[k];
    const double lower = k == 0 ? -INFINITY : number(row, "lower"),
                 upper = k == 11 ? INFINITY : number(row, "upper");
    double walls = 0;
    for (const std::string wall : {"0", "1", "2"}) {
      int expected = 0;
      for (const auto& impact : recorded) {
        const double speed = number(impact, "approach_speed");
        expected += impact.at("partner") == wall && speed >= lower && speed < upper;
      }
      EXPECT_EQ(number(row, "wall_" + wall), expected) << "interval " << k;
      walls += expected;
    }
    EXPECT_EQ(number(row, "walls"), walls);
    EXPECT_EQ(number(row, "ball_ball"), 0);
    EXPECT_EQ(number(row, "total"), walls);
    EXPECT_NEAR(
        number(row, "total_percentage"), 100 * walls / static_cast<double>(recorded.size()), 1e-12);
    EXPECT_EQ(row.at("interval"), k == 0 ? "below" : k == 11 ? "above" : std::to_string(k));
    if (k > 0 && k < 11) {
      EXPECT_NEAR(lower, 0.025 + 0.7 * static_cast<double>(k - 1), 1e-14);
      EXPECT_NEAR(number(row, "mean"), (lower + upper) / 2, 1e-14);
    }
    total += walls;
  }
  EXPECT_EQ(total, static_cast<double>(recorded.size()));
  EXPECT_TRUE(contents(scratch / "out/NVFrequencies.csv").starts_with("# Impact speeds\n"));
}

TEST_F(Chapter4, StatisticsOfWallsAddUp) {
  const auto rows = read("statistics.csv");
  ASSERT_EQ(rows.size(), 6u);
  std::map<std::string, Row> by_name;
  for (const auto& row : rows) by_name[row.at("variable") + " " + row.at("statistic")] = row;
  for (const auto& [name, column, unit] :
      {std::tuple{"COL. sum", "", "1"}, {"MIL. DOSE sum", "milling_dose", "J"}}) {
    const auto& row = by_name.at(name);
    EXPECT_EQ(row.at("unit"), unit);
    double walls = 0;
    for (const std::string wall : {"0", "1", "2"}) {
      EXPECT_NEAR(number(row, "wall_" + wall), sum(column, wall), 1e-12 * sum(column));
      walls += number(row, "wall_" + wall);
    }
    EXPECT_NEAR(number(row, "walls"), walls, 1e-12 * walls);
    EXPECT_NEAR(number(row, "total"), walls + number(row, "ball_ball"), 1e-12 * walls);
  }
  const auto& rate = by_name.at("COL. rate");
  EXPECT_EQ(rate.at("unit"), "1/s");
  EXPECT_NEAR(number(rate, "total"), sum("") / (end - 30), 1e-9);
  const auto& share = by_name.at("COL. percentage");
  EXPECT_NEAR(
      number(share, "wall_0") + number(share, "wall_1") + number(share, "wall_2"), 100, 1e-9);
  EXPECT_EQ(number(share, "total"), 100);
  double largest = 0;
  for (const auto& impact : recorded) largest = std::max(largest, number(impact, "milling_dose"));
  EXPECT_EQ(number(by_name.at("MIL. DOSE maximum"), "total"), largest);
  EXPECT_NEAR(
      number(by_name.at("MIL. DOSE average"), "total"), sum("milling_dose") / sum(""), 1e-15);
}

TEST_F(Chapter4, TrendsOfIntervalsAndFromTheStart) {
  const auto rows = read("trends.csv"), all = read("trends_accumulated.csv"),
             log = read("collisions.csv");
  ASSERT_EQ(rows.size(), 80u);
  ASSERT_EQ(all.size(), 80u);
  double collisions = 0, dose = 0, work = 0, supplied = 0;
  const double mass = 8000 * std::numbers::pi / 6 * std::pow(9.52e-3, 3), least = 0.03;
  std::size_t next = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const double upto = 0.5 * static_cast<double>(k + 1);
    EXPECT_EQ(number(rows[k], "time [s]"), upto);
    double here = 0, dose_here = 0, work_here = 0;
    for (; next < log.size() && (number(log[next], "time") < upto || k + 1 == rows.size());
         ++next) {
      ++here;
      dose_here += number(log[next], "milling_dose");
      work_here += number(log[next], "wall_work");
      // A ball slower than the least separation speed leaves with it.
      supplied += mass / 2 *
          std::max(0.0, least * least - std::pow(number(log[next], "approach_speed"), 2));
    }
    EXPECT_EQ(number(rows[k], "COL SUM [1]"), here);
    EXPECT_EQ(number(rows[k], "COL RATE [1/s]"), here / 0.5);
    EXPECT_NEAR(number(rows[k], "MD RATE [W]"), dose_here / 0.5, 1e-12);
    EXPECT_NEAR(number(rows[k], "WE RATE [W]"), work_here / 0.5, 1e-12);
    collisions += here, dose += dose_here, work += work_here;
    EXPECT_EQ(number(all[k], "COL [1]"), collisions);
    EXPECT_NEAR(number(all[k], "MD [J]"), dose, 1e-11);
    EXPECT_NEAR(number(all[k], "WE [J]"), work, 1e-11);
    EXPECT_NEAR(number(all[k], "E. BAL [J]"), work - dose + supplied, 1e-11);
  }
  EXPECT_GT(supplied, 1e-6);  // far more than the bounds
  EXPECT_EQ(collisions, static_cast<double>(log.size()));
}

TEST_F(Chapter4, TrendsOfBallsAndTraceAgreeWithTheFinalState) {
  const auto balls = read("trends_balls.csv"), trace = read("trace.csv"),
             final_state = read("final_state.csv");
  ASSERT_EQ(balls.size(), 20u);
  ASSERT_EQ(trace.size(), 80u);
  ASSERT_EQ(final_state.size(), 1u);
  const auto& last = balls.back();
  EXPECT_EQ(number(last, "time [s]"), end);
  const double speed = std::hypot(number(final_state[0], "velocity_x"),
      number(final_state[0], "velocity_y"), number(final_state[0], "velocity_z"));
  EXPECT_NEAR(number(last, "Ave Speed [m/s]"), speed, 1e-12);
  EXPECT_NEAR(number(last, "Max Speed [m/s]"), speed, 1e-12);
  EXPECT_EQ(number(last, "Max Speed ball [1]"), 0);
  for (const std::string axis : {"x", "y", "z"})
    EXPECT_NEAR(
        number(trace.back(), axis + " [m]"), number(final_state[0], "position_" + axis), 1e-12);
}

TEST_F(Chapter4, InstantTrendsAndIterationsAreImpactsOfTheLog) {
  std::map<std::string, Row> log;
  for (const auto& row : read("collisions.csv")) log[row.at("index")] = row;
  const auto rows = read("trends_instant.csv");
  ASSERT_GE(rows.size(), 15u);
  ASSERT_LE(rows.size(), 21u);
  double due = 30;
  for (const auto& row : rows) {
    const auto& impact = log.at(row.at("It [1]"));
    EXPECT_EQ(row.at("Time [s]"), impact.at("time"));
    EXPECT_GE(number(row, "Time [s]"), due);
    due = 30 + 0.5 * (std::floor((number(row, "Time [s]") - 30) / 0.5) + 1);
    EXPECT_EQ(row.at("B/V [1]"), "V");
    EXPECT_EQ(row.at("Id2 [1]"), impact.at("partner"));
    EXPECT_EQ(row.at("MD [J]"), impact.at("milling_dose"));
    EXPECT_EQ(row.at("ENER. WALL [J]"), impact.at("wall_work"));
  }
  const auto details = read("iterations.csv");
  ASSERT_EQ(details.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(details[k].at("index [1]"), std::to_string(1000 + k));
    const auto& impact = log.at(details[k].at("index [1]"));
    EXPECT_EQ(details[k].at("time [s]"), impact.at("time"));
    EXPECT_EQ(details[k].at("milling_dose [J]"), impact.at("milling_dose"));
    EXPECT_NEAR(number(details[k], "contact_tangential_speed_before [m/s]"),
        number(impact, "slip_speed"), 1e-12);
  }
}

}  // namespace
}  // namespace edmill
