// What outputs record and where it goes; the event log in HDF5; the page of the variables.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "cli/commands/cases.hpp"
#include "hdf5_table.hpp"
#include "run_with_outputs.hpp"

namespace edmill {
namespace {

TEST_F(Outputs, AreRestrictedByFlagsAndCounts) {
  write("case.toml",
      std::string(small_case) +
          "[[output]]\ntype = \"collisions\"\n"
          "[[output]]\ntype = \"collisions\"\nfile = \"cap.csv\"\nonly = { ball_ball = false, "
          "partner = 1 }\n"
          "[[output]]\ntype = \"collisions\"\nfile = \"three.csv\"\nonly = { ball = 3 }\n"
          "[[output]]\ntype = \"collisions\"\nfile = \"off.csv\"\non = false\n");
  ASSERT_EQ(edmill("run case.toml --quiet --out out").code, 0);
  std::string cap, three;
  std::istringstream all(contents(scratch / "out/collisions.csv"));
  for (std::string line; std::getline(all, line);) {
    const bool header = line.starts_with("index");
    if (header || line.find(",wall,1,") != std::string::npos) cap += line + "\n";
    if (header || line.find(",3,wall,") != std::string::npos ||
        line.find(",3,ball,") != std::string::npos)
      three += line + "\n";
  }
  EXPECT_EQ(contents(scratch / "out/cap.csv"), cap);
  EXPECT_EQ(contents(scratch / "out/three.csv"), three);
  EXPECT_EQ(read("off.csv").size(), 0u);
  EXPECT_GT(std::count(cap.begin(), cap.end(), '\n'), 3);
}

TEST_F(Outputs, GoToFoldersAndAreAppended) {
  write("case.toml",
      std::string(small_case) +
          "[[output]]\ntype = \"trends\"\nfolder = \"tables/first\"\ninterval = \"0.1 s\"\nappend "
          "= true\n"
          "columns = [{ variable = \"collision\", statistics = [\"sum\"] }]\n");
  ASSERT_EQ(edmill("run case.toml --quiet --out out").code, 0);
  const auto once = contents(scratch / "out/tables/first/trends.csv");
  EXPECT_EQ(std::count(once.begin(), once.end(), '\n'), 3);
  ASSERT_EQ(edmill("run case.toml --quiet --out out").code, 0);
  EXPECT_EQ(contents(scratch / "out/tables/first/trends.csv"), once + once);
}

/// Several balls: their states at the end of an interval between two impacts.
TEST_F(Outputs, BallsBetweenImpactsKeepTheirTotalMass) {
  write("case.toml",
      std::string(small_case) +
          "[[output]]\ntype = \"trends_balls\"\ninterval = \"0.7 ms\"\n"
          "columns = [{ variable = \"mass\", statistics = [\"sum\"] }, { variable = "
          "\"energy\", statistics = [\"sum\"] },"
          "{ variable = \"translational_energy\", statistics = [\"sum\"] }, { variable = "
          "\"spin_energy\", statistics = [\"sum\"] }]\n"
          "[[output]]\ntype = \"trace\"\nball = 2\ninterval = \"0.7 ms\"\n"
          "[[output]]\ntype = \"trace\"\nball = 2\nfile = \"impacts.csv\"\n");
  ASSERT_EQ(edmill("run case.toml --quiet --out out").code, 0);
  const double mass = 8000 * std::acos(-1.0) / 6 * std::pow(0.00952, 3);
  const auto rows = read("trends_balls.csv");
  ASSERT_EQ(rows.size(), 286u);
  for (const auto& row : rows) {
    EXPECT_NEAR(number(row, "mass sum [kg]"), 5 * mass, 1e-15);
    EXPECT_NEAR(number(row, "energy sum [J]"),
        number(row, "translational_energy sum [J]") + number(row, "spin_energy sum [J]"), 1e-15);
  }
  // Between two of its impacts the ball falls: second differences of its places are g t^2.
  const auto trace = read("trace.csv"), impacts = read("impacts.csv");
  int falls = 0;
  for (std::size_t k = 2; k + 1 < trace.size(); ++k) {
    const double first = number(trace[k - 2], "time [s]"), last = number(trace[k], "time [s]");
    bool free = true;
    for (const auto& impact : impacts) {
      const double t = number(impact, "time [s]");
      free = free && (t < first || t > last);
    }
    if (!free) continue;
    ++falls;
    for (const auto& [axis, g] : {std::pair{"x [m]", 0.0}, {"y [m]", -9.8}, {"z [m]", 0.0}})
      EXPECT_NEAR(
          number(trace[k], axis) - 2 * number(trace[k - 1], axis) + number(trace[k - 2], axis),
          g * 0.7e-3 * 0.7e-3, 1e-14);
  }
  EXPECT_GT(falls, 100);
}

TEST_F(Outputs, EventsInHdf5AreThoseOfTheLog) {
  write("case.toml",
      std::string(small_case) +
          "[[output]]\ntype = \"collisions\"\nstates = true\n"
          "[[output]]\ntype = \"events\"\nstates = true\n"
          "[[output]]\ntype = \"events\"\nfile = \"small.h5\"\n");
  ASSERT_EQ(edmill("run case.toml --quiet --out out").code, 0);
  const auto bytes = contents(scratch / "out/small.h5"),
             all_bytes = contents(scratch / "out/events.h5");
  ASSERT_EQ(edmill("run case.toml --quiet --out out").code, 0);
  EXPECT_EQ(contents(scratch / "out/small.h5"), bytes);
  EXPECT_EQ(contents(scratch / "out/events.h5"), all_bytes);

  const auto log = read("collisions.csv");
  const io::Handle file(
      H5Fopen((scratch / "out/events.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  for (const std::string column : {"index", "time", "ball", "partner", "approach_speed",
           "slip_speed", "milling_dose", "wall_work"}) {
    const auto values = dataset(file, "events/" + column);
    ASSERT_EQ(values.size(), log.size());
    for (std::size_t k = 0; k < log.size(); ++k)
      EXPECT_EQ(values[k], number(log[k], column)) << column << " of row " << k;
  }
  for (const std::string body : {"", "partner_"})
    for (const auto& [name, letter, when] : {std::tuple{"position", "", ""},
             {"velocity_before", "v", "_before"}, {"spin_before", "w", "_before"},
             {"velocity_after", "v", "_after"}, {"spin_after", "w", "_after"}}) {
      const auto values = dataset(file, "events/" + (body.empty() ? "ball_" : body) + name);
      ASSERT_EQ(values.size(), 3 * log.size());
      for (std::size_t k = 0; k < log.size(); ++k)
        for (std::size_t axis = 0; axis < 3; ++axis) {
          if (!body.empty() && log[k].at("partner_kind") == "wall") {
            EXPECT_TRUE(std::isnan(values[3 * k + axis]));
            continue;
          }
          const std::string column = body + letter + "xyz"[axis] + when;
          EXPECT_EQ(values[3 * k + axis], number(log[k], column)) << column << " of row " << k;
        }
    }
  const auto places = dataset(file, "final_position"), state = dataset(file, "final_spin");
  const auto final_state = read("final_state.csv");
  ASSERT_EQ(places.size(), 15u);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(places[3 * i], number(final_state[i], "position_x"));
    EXPECT_EQ(state[3 * i + 2], number(final_state[i], "spin_z"));
  }
}

/// Growth of directions adds up over intervals, whatever their lengths and wherever the record
/// ends.
TEST_F(Outputs, FiniteTimeExponentsAddUpToThoseOfTheRecord) {
  const std::string lyapunov =
      "[[output]]\ntype = \"lyapunov\"\nexponents = 3\nstart_time = \"0.1 s\"\n";
  write("case.toml",
      std::string(small_case) + lyapunov + lyapunov +
          "interval = \"50 ms\"\nfile = \"fine.csv\"\n" + lyapunov +
          "interval = \"250 ms\"\nfile = \"coarse.csv\"\n" + lyapunov +
          "interval = \"50 ms\"\nfile = \"part.csv\"\nend_time = \"0.3 s\"\n");
  const auto outcome = edmill(
      "run case.toml --quiet --out out --set run.end_time='\"0.6 s\"' --set mill.speed='\"1200 "
      "rpm\"'");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto whole = read("lyapunov.csv"), fine = read("fine.csv"), coarse = read("coarse.csv"),
             part = read("part.csv");
  ASSERT_EQ(whole.size(), 3u);
  ASSERT_EQ(fine.size(), 10u);
  ASSERT_EQ(coarse.size(), 2u);
  ASSERT_EQ(part.size(), 4u);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto column = "exponent_" + std::to_string(k + 1) + " [1/s]";
    double sum = 0;
    for (std::size_t row = 0; row < 10; ++row) {
      sum += 0.05 * number(fine[row], column);
      if (row % 5 == 4) {
        EXPECT_NEAR(0.25 * (number(coarse[0], column) + (row > 5 ? number(coarse[1], column) : 0)),
            sum, 1e-8 * std::abs(sum));
      }
      if (row < 4) {
        EXPECT_NEAR(number(part[row], column), number(fine[row], column), 1e-6) << row;
      }
    }
    // Ten drive periods of 50 ms.
    EXPECT_NEAR(0.5 * number(whole[k], "per_second [1/s]"), sum, 1e-8 * std::abs(sum));
  }
  EXPECT_GT(number(whole[0], "per_second [1/s]"), 0);
}

TEST(VariablesPage, IsWhatTheProgramLists) {
  std::ifstream in(EDMILL_SOURCE_DIR "/docs/variables.md");
  std::stringstream page;
  page << in.rdbuf();
  const auto text = page.str();
  const auto tables = text.find("## Flags");
  ASSERT_NE(tables, std::string::npos);
  EXPECT_EQ(text.substr(tables), cli::list_variables());
}

}  // namespace
}  // namespace edmill
