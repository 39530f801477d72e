// The program of the thesis's chapter 4 with all of its outputs, each against its definition.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <pugixml.hpp>
#include <vector>

#include "cli/list_variables.hpp"
#include "csv_table.hpp"
#include "hdf5_table.hpp"
#include "program.hpp"

namespace edmill {
namespace {

class Outputs : public ProgramTest {
 protected:
  std::vector<Row> read(const std::string& file) const { return table(contents(scratch / "out" / file)); }
};

class Chapter4 : public Outputs {
 protected:
  static constexpr double end = 40;

  void SetUp() override {
    ProgramTest::SetUp();
    std::string text =
        contents(std::filesystem::path(EDMILL_SOURCE_DIR) / "docs/examples/thesis_chapter4.toml");
    text += "\n[[output]]\ntype = \"collisions\"\n";
    write("case.toml", text);
    const auto outcome = edmill(
        "run case.toml --quiet --out out --set run.end_time='\"40 s\"' --set contact.least_separation='\"3 "
        "cm/s\"'");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    for (const auto& row : read("collisions.csv"))
      if (number(row, "time") >= 30) recorded.push_back(row);
    ASSERT_GT(recorded.size(), 100u);
  }

  /// Of the collision log from 30 s on, with one wall or with any.
  double sum(const std::string& column, const std::string& wall = "") const {
    double total = 0;
    for (const auto& row : recorded)
      if (wall.empty() || row.at("partner") == wall) total += column.empty() ? 1 : number(row, column);
    return total;
  }

  std::vector<Row> recorded;
};

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
    EXPECT_NEAR(number(row, "total_percentage"), 100 * walls / static_cast<double>(recorded.size()), 1e-12);
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
  EXPECT_NEAR(number(share, "wall_0") + number(share, "wall_1") + number(share, "wall_2"), 100, 1e-9);
  EXPECT_EQ(number(share, "total"), 100);
  double largest = 0;
  for (const auto& impact : recorded) largest = std::max(largest, number(impact, "milling_dose"));
  EXPECT_EQ(number(by_name.at("MIL. DOSE maximum"), "total"), largest);
  EXPECT_NEAR(number(by_name.at("MIL. DOSE average"), "total"), sum("milling_dose") / sum(""), 1e-15);
}

TEST_F(Chapter4, TrendsOfIntervalsAndFromTheStart) {
  const auto rows = read("trends.csv"), all = read("trends_accumulated.csv"), log = read("collisions.csv");
  ASSERT_EQ(rows.size(), 80u);
  ASSERT_EQ(all.size(), 80u);
  double collisions = 0, dose = 0, work = 0, supplied = 0;
  const double mass = 8000 * std::numbers::pi / 6 * std::pow(9.52e-3, 3), least = 0.03;
  std::size_t next = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const double upto = 0.5 * static_cast<double>(k + 1);
    EXPECT_EQ(number(rows[k], "time [s]"), upto);
    double here = 0, dose_here = 0, work_here = 0;
    for (; next < log.size() && (number(log[next], "time") < upto || k + 1 == rows.size()); ++next) {
      ++here;
      dose_here += number(log[next], "milling_dose");
      work_here += number(log[next], "wall_work");
      // A ball slower than the least separation speed leaves with it.
      supplied += mass / 2 * std::max(0.0, least * least - std::pow(number(log[next], "approach_speed"), 2));
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
  const double speed = std::hypot(number(final_state[0], "velocity_x"), number(final_state[0], "velocity_y"),
                                  number(final_state[0], "velocity_z"));
  EXPECT_NEAR(number(last, "Ave Speed [m/s]"), speed, 1e-12);
  EXPECT_NEAR(number(last, "Max Speed [m/s]"), speed, 1e-12);
  EXPECT_EQ(number(last, "Max Speed ball [1]"), 0);
  for (const std::string axis : {"x", "y", "z"})
    EXPECT_NEAR(number(trace.back(), axis + " [m]"), number(final_state[0], "position_" + axis), 1e-12);
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
    EXPECT_NEAR(number(details[k], "contact_tangential_speed_before [m/s]"), number(impact, "slip_speed"),
                1e-12);
  }
}

/// Numbers of an attribute.
std::vector<double> list(const pugi::xml_node& node, const char* attribute) {
  std::istringstream in(node.attribute(attribute).value());
  std::vector<double> numbers;
  for (double x; in >> x;) numbers.push_back(x);
  return numbers;
}

pugi::xml_node named(const pugi::xml_document& page, const std::string& name) {
  return page.find_node([&](const pugi::xml_node& n) { return n.attribute("DEF").value() == name; });
}

TEST_F(Chapter4, SnapshotShowsTheBallWhereItTouches) {
  EXPECT_FALSE(std::filesystem::exists(scratch / "out/snapshot_0.x3d"));
  EXPECT_FALSE(std::filesystem::exists(scratch / "out/snapshot_3.x3d"));
  for (const std::string index : {"1", "2"}) {
    pugi::xml_document page;
    ASSERT_TRUE(page.load_file((scratch / "out" / ("snapshot_" + index + ".x3d")).c_str()));
    const auto ball = list(named(page, "ball_0"), "translation"),
               contact = list(named(page, "contact_point"), "translation");
    ASSERT_EQ(ball.size(), 3u);
    ASSERT_EQ(contact.size(), 3u);
    EXPECT_NEAR(std::hypot(ball[0] - contact[0], ball[1] - contact[1], ball[2] - contact[2]), 0.00476, 1e-9);
    EXPECT_EQ(list(named(page, "contact_point").child("Shape").child("Sphere"), "radius"),
              std::vector<double>{0.001});
    EXPECT_EQ(
        list(named(page, "ball_0").child("Shape").child("Appearance").child("Material"), "diffuseColor"),
        (std::vector<double>{0, 0, 1}));
    // The vessel's frame: back by theta, the arm, and gamma; the ball is inside and touches.
    const double theta = list(named(page, "theta"), "rotation")[3],
                 gamma = list(named(page, "gamma"), "rotation")[3];
    const double a = ball[0] * std::cos(theta) + ball[1] * std::sin(theta) - 0.1;
    const double b = ball[1] * std::cos(theta) - ball[0] * std::sin(theta);
    const double y = b * std::cos(gamma) + ball[2] * std::sin(gamma),
                 z = ball[2] * std::cos(gamma) - b * std::sin(gamma);
    const double gap = std::min(0.0285 - 0.00476 - std::abs(y), 0.019 - 0.00476 - std::hypot(a, z));
    EXPECT_NEAR(gap, 0, 1e-9);
  }
}

TEST_F(Chapter4, AnimationPlaysTheFirstImpacts) {
  pugi::xml_document page;
  ASSERT_TRUE(page.load_file((scratch / "out/animation.x3d").c_str()));
  const auto log = read("collisions.csv");
  const double length = number(log[3], "time");  // it ends with the fourth impact
  EXPECT_NEAR(list(named(page, "clock"), "cycleInterval")[0], length / 0.001, 1e-9);
  for (const std::string name : {"theta_path", "gamma_path", "ball_0_path", "contact_point_path"}) {
    const auto keys = list(named(page, name), "key"), values = list(named(page, name), "keyValue");
    ASSERT_GE(keys.size(), 4u) << name;
    EXPECT_TRUE(std::is_sorted(keys.begin(), keys.end())) << name;
    EXPECT_GE(keys.front(), 0);
    EXPECT_LE(keys.back(), 1 + 1e-12);
    EXPECT_EQ(values.size(), keys.size() * (name.starts_with("theta") || name.starts_with("gamma") ? 4 : 3))
        << name;
  }
  const auto keys = list(named(page, "theta_path"), "key"),
             angles = list(named(page, "theta_path"), "keyValue");
  EXPECT_GE(keys.size(), 25u);
  EXPECT_EQ(keys.back(), 1);
  const double turn = 2 * std::acos(-1.0) * 1054 / 60 * length;
  EXPECT_NEAR(angles[3], std::acos(-1.0) * 105 / 180, 1e-12);
  EXPECT_NEAR(angles.back(), std::acos(-1.0) * (90 + 15 * std::cos(turn)) / 180, 1e-9);
  // The ball has a key at each impact.
  const auto ball_keys = list(named(page, "ball_0_path"), "key");
  for (int k = 0; k < 4; ++k)
    EXPECT_TRUE(std::any_of(ball_keys.begin(), ball_keys.end(), [&](double key) {
      return std::abs(key * length - number(log[k], "time")) < 1e-12;
    }));
  int routes = 0;
  for (const auto& node : page.child("X3D").child("Scene").children("ROUTE")) {
    EXPECT_TRUE(named(page, node.attribute("fromNode").value()));
    EXPECT_TRUE(named(page, node.attribute("toNode").value()));
    ++routes;
  }
  EXPECT_EQ(routes, 8);
}

const char* const small_case =
    "[run]\nend_time = \"0.2 s\"\ngravity = \"9.8 m/s2\"\n[mill]\nspeed = \"1054 rpm\"\n"
    "[vessel]\ndiameter = \"38 mm\"\nheight = \"57 mm\"\n[contact]\nrestitution = 0.53\nfriction = 0.4\n"
    "[[balls]]\ncount = 5\ndiameter = \"9.52 mm\"\n";

TEST_F(Outputs, AreRestrictedByFlagsAndCounts) {
  write(
      "case.toml",
      std::string(small_case) +
          "[[output]]\ntype = \"collisions\"\n"
          "[[output]]\ntype = \"collisions\"\nfile = \"cap.csv\"\nonly = { ball_ball = false, partner = 1 }\n"
          "[[output]]\ntype = \"collisions\"\nfile = \"three.csv\"\nonly = { ball = 3 }\n"
          "[[output]]\ntype = \"collisions\"\nfile = \"off.csv\"\non = false\n");
  ASSERT_EQ(edmill("run case.toml --quiet --out out").code, 0);
  std::string cap, three;
  std::istringstream all(contents(scratch / "out/collisions.csv"));
  for (std::string line; std::getline(all, line);) {
    const bool header = line.starts_with("index");
    if (header || line.find(",wall,1,") != std::string::npos) cap += line + "\n";
    if (header || line.find(",3,wall,") != std::string::npos || line.find(",3,ball,") != std::string::npos)
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
            "[[output]]\ntype = \"trends\"\nfolder = \"tables/first\"\ninterval = \"0.1 s\"\nappend = true\n"
            "columns = [{ variable = \"collision\", statistics = [\"sum\"] }]\n");
  ASSERT_EQ(edmill("run case.toml --quiet --out out").code, 0);
  const auto once = contents(scratch / "out/tables/first/trends.csv");
  EXPECT_EQ(std::count(once.begin(), once.end(), '\n'), 3);
  ASSERT_EQ(edmill("run case.toml --quiet --out out").code, 0);
  EXPECT_EQ(contents(scratch / "out/tables/first/trends.csv"), once + once);
}

/// Several balls: their states at the end of an interval between two impacts.
TEST_F(Outputs, BallsBetweenImpactsKeepTheirTotalMass) {
  write("case.toml", std::string(small_case) +
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
      EXPECT_NEAR(number(trace[k], axis) - 2 * number(trace[k - 1], axis) + number(trace[k - 2], axis),
                  g * 0.7e-3 * 0.7e-3, 1e-14);
  }
  EXPECT_GT(falls, 100);
}

TEST_F(Outputs, ParaviewFramesHoldBallsAndVessel) {
  write("case.toml", std::string(small_case) +
                         "[[output]]\ntype = \"paraview\"\nfolder = \"movie\"\ninterval = \"30 ms\"\n");
  for (int repeat = 0; repeat < 2; ++repeat)  // the second replaces the first
    ASSERT_EQ(edmill("run case.toml --quiet --out out").code, 0);
  pugi::xml_document index;
  ASSERT_TRUE(index.load_file((scratch / "out/movie/paraview.pvd").c_str()));
  std::vector<double> times;
  for (const auto& set : index.child("VTKFile").child("Collection").children("DataSet")) {
    const std::string file = set.attribute("file").value();
    pugi::xml_document part;
    ASSERT_TRUE(part.load_file((scratch / "out/movie" / file).c_str())) << file;
    const auto piece = part.child("VTKFile").child("PolyData").child("Piece");
    const auto count = [](const pugi::xml_node& array) {
      std::istringstream in(array.text().get());
      std::size_t n = 0;
      for (std::string word; in >> word;) ++n;
      return n;
    };
    const auto points = piece.attribute("NumberOfPoints").as_ullong();
    EXPECT_EQ(count(piece.child("Points").child("DataArray")), 3 * points);
    for (const auto& array : piece.child("PointData").children())
      EXPECT_EQ(count(array), points * array.attribute("NumberOfComponents").as_ullong())
          << array.attribute("Name").value();
    if (set.attribute("part").as_int() == 0) {
      EXPECT_EQ(points, 5u);
      times.push_back(set.attribute("timestep").as_double());
    }
  }
  ASSERT_EQ(times.size(), 8u);  // 0, 30, ... 180 ms and the end
  for (std::size_t k = 0; k < 7; ++k) EXPECT_NEAR(times[k], 0.03 * static_cast<double>(k), 1e-15);
  EXPECT_EQ(times.back(), 0.2);
  std::size_t entries = 0;
  for (const auto& entry : std::filesystem::directory_iterator(scratch / "out/movie"))
    entries += entry.exists();
  EXPECT_EQ(entries, 2u);  // nothing partial is left
}

TEST_F(Outputs, EventsInHdf5AreThoseOfTheLog) {
  write("case.toml", std::string(small_case) +
                         "[[output]]\ntype = \"collisions\"\nstates = true\n"
                         "[[output]]\ntype = \"events\"\nstates = true\n"
                         "[[output]]\ntype = \"events\"\nfile = \"small.h5\"\n");
  ASSERT_EQ(edmill("run case.toml --quiet --out out").code, 0);
  const auto bytes = contents(scratch / "out/small.h5"), all_bytes = contents(scratch / "out/events.h5");
  ASSERT_EQ(edmill("run case.toml --quiet --out out").code, 0);
  EXPECT_EQ(contents(scratch / "out/small.h5"), bytes);
  EXPECT_EQ(contents(scratch / "out/events.h5"), all_bytes);

  const auto log = read("collisions.csv");
  const io::Hdf5Handle file(H5Fopen((scratch / "out/events.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT),
                            H5Fclose);
  for (const std::string column :
       {"index", "time", "ball", "partner", "approach_speed", "slip_speed", "milling_dose", "wall_work"}) {
    const auto values = dataset(file, "events/" + column);
    ASSERT_EQ(values.size(), log.size());
    for (std::size_t k = 0; k < log.size(); ++k)
      EXPECT_EQ(values[k], number(log[k], column)) << column << " of row " << k;
  }
  for (const std::string body : {"", "partner_"})
    for (const auto& [name, letter, when] : {std::tuple{"position", "", ""},
                                             {"velocity_before", "v", "_before"},
                                             {"spin_before", "w", "_before"},
                                             {"velocity_after", "v", "_after"},
                                             {"spin_after", "w", "_after"}}) {
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
