// Outputs beyond the thesis: each against the collision log, closed sums, and the laws of
// mechanics.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "csv_table.hpp"
#include "program.hpp"

namespace edmill {
namespace {

using Vector = Eigen::Vector3d;

const double pi = std::acos(-1.0);
constexpr double radius = 0.00476, vessel_radius = 0.019, half_height = 0.0285;
const double mass = 8000 * 4 * pi / 3 * std::pow(radius, 3);

const char* const mill_case =
    "[mill]\nspeed = \"1054 rpm\"\n[vessel]\ndiameter = \"38 mm\"\nheight = \"57 mm\"\n"
    "[contact]\nrestitution = 0.53\nfriction = 0.4\n";
const char* const five_balls = "[[balls]]\ncount = 5\ndiameter = \"9.52 mm\"\n";
const char* const flying_balls =
    "[[ball]]\ndiameter = \"9.52 mm\"\nposition = [\"-26 mm\", \"96.5 mm\", \"0 mm\"]\n"
    "velocity = [\"1 m/s\", \"0.5 m/s\", \"-0.3 m/s\"]\nspin = [\"20 rad/s\", \"-50 rad/s\", \"70 "
    "rad/s\"]\n"
    "[[ball]]\ndiameter = \"9.52 mm\"\nposition = [\"-37.5 mm\", \"93.5 mm\", \"2 mm\"]\n"
    "velocity = [\"-1.5 m/s\", \"0.1 m/s\", \"0.2 m/s\"]\n";

/// The vessel's pose by the thesis's figure 2.4, from the drive's closed form.
struct Pose {
  double theta, gamma;

  explicit Pose(double time)
      : theta(pi / 2 + pi / 12 * std::cos(2 * pi * 1054 / 60 * time)),
        gamma(pi / 12 * std::sin(2 * pi * 1054 / 60 * time)) {}
  /// Components along the vessel's axes.
  Vector turned(const Vector& v) const {
    return Eigen::AngleAxisd(-gamma, Vector::UnitX()) *
        (Eigen::AngleAxisd(-theta, Vector::UnitZ()) * v);
  }
  Vector inertial(const Vector& v) const {
    return Eigen::AngleAxisd(theta, Vector::UnitZ()) *
        (Eigen::AngleAxisd(gamma, Vector::UnitX()) * v);
  }
  Vector centre() const { return inertial({0.1, 0, 0}); }
  Vector own(const Vector& place) const { return turned(place - centre()); }
};

class MillOutputs : public ProgramTest {
 protected:
  std::vector<Row> read(const std::string& file) const {
    return table(contents(scratch / "out" / file));
  }
  nlohmann::json summary() const {
    return nlohmann::json::parse(contents(scratch / "out/summary.json"));
  }

  /// Runs for 0.2 s with the log beside the outputs.
  void run(const std::string& outputs, const std::string& balls = five_balls,
      const std::string& keys = "gravity = \"9.8 m/s2\"\n") {
    write("case.toml",
        "[run]\nend_time = \"0.2 s\"\n" + keys + mill_case + balls +
            "[[output]]\ntype = \"collisions\"\nstates = true\n" + outputs);
    const auto outcome = edmill("run case.toml --quiet --out out");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    log = read("collisions.csv");
    ASSERT_GT(log.size(), 30u);
  }

  static std::string partner(const Row& impact) {
    return impact.at("partner_kind") == "ball" ? "ball_ball" : "wall_" + impact.at("partner");
  }
  static Vector vector(const Row& row, const std::string& before, const std::string& after = "",
      const std::string& axes = "xyz") {
    return {number(row, before + axes[0] + after), number(row, before + axes[1] + after),
        number(row, before + axes[2] + after)};
  }
  /// Dissipated along the normal: by the normal velocity, relative to the partner, before and
  /// after. 0 where the least separation speed supplies energy.
  static double normal_dose(const Row& impact) {
    if (impact.at("partner_kind") == "wall") {
      const double before = -number(impact, "approach_speed");
      const double change = -impulse(impact).dot(inward_normal(impact)) / mass;
      return std::max(0.0, mass / 2 * (before * before - (before + change) * (before + change)));
    }
    const Vector normal = (vector(impact, "") - vector(impact, "partner_")).normalized();
    const auto speed = [&](const std::string& when) {
      return (vector(impact, "v", when) - vector(impact, "partner_v", when)).dot(normal);
    };
    return std::max(0.0, mass / 4 * (std::pow(speed("_before"), 2) - std::pow(speed("_after"), 2)));
  }
  static Vector inward_normal(const Row& impact) {
    const Pose pose(number(impact, "time"));
    return (vector(impact, "") - pose.centre() - pose.inertial(contact_point(impact))).normalized();
  }
  /// The contact point in the vessel frame: the foot of the ball's centre on the wall.
  static Vector contact_point(const Row& impact) {
    Vector p = Pose(number(impact, "time")).own(vector(impact, ""));
    if (impact.at("partner") != "2") return {p[0], p[1] < 0 ? -half_height : half_height, p[2]};
    const double distance = std::hypot(p[0], p[2]);
    return {p[0] / distance * vessel_radius, p[1], p[2] / distance * vessel_radius};
  }
  /// Impulse on the vessel, inertial frame.
  static Vector impulse(const Row& impact) {
    return mass * (vector(impact, "v", "_before") - vector(impact, "v", "_after"));
  }

  std::vector<Row> log;
};

const std::vector<std::string> partners{"wall_0", "wall_1", "wall_2", "ball_ball", "total"};

TEST_F(MillOutputs, SpectraCountTheImpactsOfTheLog) {
  run("[[output]]\ntype = \"spectra\"\nlow = \"1e-6 J\"\nhigh = \"2 mJ\"\nbins_per_decade = 3\n"
      "[[output]]\ntype = \"spectra\"\nof = \"speed\"\nfile = \"speeds.csv\"\n");
  for (const auto& [file, names, unit, bins] :
      {std::tuple{
           "spectra.csv", std::vector<std::string>{"normal", "tangential", "total"}, "J", 10},
          {"speeds.csv", {"approach", "slip"}, "m/s", 40}}) {
    const auto rows = read(file);
    ASSERT_EQ(rows.size(), names.size() * static_cast<std::size_t>(bins + 2));
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const auto& row = rows[r];
      const auto place = r % static_cast<std::size_t>(bins + 2);
      const std::string name = names[r / static_cast<std::size_t>(bins + 2)];
      EXPECT_EQ(row.at("spectrum"), name);
      const bool below = place == 0, above = place == static_cast<std::size_t>(bins + 1);
      EXPECT_EQ(row.at("bin"), below ? "below" : above ? "above" : std::to_string(place));
      const std::string low_title = "low [" + std::string(unit) + "]",
                        high_title = "high [" + std::string(unit) + "]";
      const double low = below ? -INFINITY : number(row, low_title),
                   high = above ? INFINITY : number(row, high_title);
      std::map<std::string, int> impacts;
      std::map<std::string, double> energy;
      for (const auto& impact : log) {
        const double dose = number(impact, "milling_dose"), along = normal_dose(impact);
        const double value = name == "normal" ? along
            : name == "tangential"            ? dose - along
            : name == "total"                 ? dose
            : name == "approach"              ? number(impact, "approach_speed")
                                              : number(impact, "slip_speed");
        if (value < low || value >= high) continue;
        for (const auto& part : {partner(impact), std::string("total")}) {
          ++impacts[part];
          energy[part] += std::string(unit) == "J" ? value : dose;
        }
      }
      for (const auto& part : partners) {
        EXPECT_EQ(number(row, part + " impacts [1]"), impacts[part])
            << file << " " << name << " " << place;
        EXPECT_NEAR(number(row, part + " energy [J]"), energy[part], 1e-13)
            << file << " " << name << " " << place;
      }
    }
  }
}

TEST_F(MillOutputs, BinsOfSpectraHaveEqualRatiosUpToTheLast) {
  run("[[output]]\ntype = \"spectra\"\nlow = \"1e-6 J\"\nhigh = \"2 mJ\"\nbins_per_decade = 3\n"
      "[[output]]\ntype = \"spectra\"\nof = \"speed\"\nfile = \"speeds.csv\"\n");
  const auto rows = read("spectra.csv"), speeds = read("speeds.csv");
  for (int k = 1; k <= 10; ++k) {
    EXPECT_NEAR(number(rows[k], "low [J]") / (1e-6 * std::pow(10, (k - 1) / 3.0)), 1, 1e-14);
    EXPECT_EQ(rows[k].at("high [J]"), rows[k + 1].at("low [J]"));
  }
  EXPECT_EQ(number(rows[10], "high [J]"), 0.002);  // 10^(10/3) = 2154: the last one is cut
  EXPECT_EQ(number(speeds[1], "low [m/s]"), 0.001);
  EXPECT_EQ(number(speeds[40], "high [m/s]"), 10);  // no sliver of a bin
  EXPECT_EQ(number(speeds[30], "high [m/s]"), 1);
}

TEST_F(MillOutputs, BinsOfSpectraHaveTheDigitsOfTheScalar) {
  write("case.toml",
      std::string("[run]\nend_time = \"1 ms\"\nprecision = \"mpfr50\"\n") + mill_case + five_balls +
          "[[output]]\ntype = \"spectra\"\nlow = \"1 J\"\nhigh = \"10 J\"\n");
  ASSERT_EQ(edmill("run case.toml --quiet --out out").code, 0);
  // Python: getcontext().prec = 60; Decimal(10) ** (Decimal(1) / 10)
  EXPECT_EQ(read("spectra.csv")[1].at("high [J]").substr(0, 48),
      "1.2589254117941672104239541063958006060936174094");
}

TEST_F(MillOutputs, NormalAndTangentialEnergyAddUpToTheDose) {
  run("[[output]]\ntype = \"spectra\"\n");
  std::map<std::string, double> sums;
  std::map<std::string, int> impacts;
  for (const auto& row : read("spectra.csv")) {
    sums[row.at("spectrum")] += number(row, "total energy [J]");
    impacts[row.at("spectrum")] += static_cast<int>(number(row, "total impacts [1]"));
  }
  const double dose = summary()["milling_dose"];
  EXPECT_GT(sums["tangential"], 0.01 * dose);
  EXPECT_NEAR(sums["normal"] + sums["tangential"], dose, 1e-12 * dose);
  EXPECT_NEAR(sums["total"], dose, 1e-12 * dose);
  for (const auto* name : {"normal", "tangential", "total"})
    EXPECT_EQ(impacts[name], log.size()) << name;
}

TEST_F(MillOutputs, RatesAboveCutoffsCountTheImpactsOfTheLog) {
  run("[[output]]\ntype = \"rates_above\"\nstart_time = \"50 ms\"\ncutoffs = [\"0.5 m/s\", \"0 "
      "m/s\", \"20 "
      "mm/s\"]\n");
  const auto rows = read("rates_above.csv");
  ASSERT_EQ(rows.size(), 3u);
  const double cutoffs[] = {0, 0.02, 0.5}, duration = 0.15;
  double last = INFINITY;
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(number(rows[k], "cutoff [m/s]"), cutoffs[k]);
    std::map<std::string, double> impacts, dose;
    for (const auto& impact : log)
      if (number(impact, "time") >= 0.05 &&
          (k == 0 || number(impact, "approach_speed") >= cutoffs[k]))
        for (const auto& part : {partner(impact), std::string("total")}) {
          ++impacts[part];
          dose[part] += number(impact, "milling_dose");
        }
    for (const auto& part : partners) {
      EXPECT_NEAR(number(rows[k], part + " rate [1/s]") * duration, impacts[part], 1e-9);
      EXPECT_NEAR(number(rows[k], part + " dose_rate [W]") * duration, dose[part], 1e-13);
    }
    EXPECT_LT(impacts["total"], last);  // the case has impacts between the cutoffs
    last = impacts["total"];
  }
}

TEST_F(MillOutputs, RatesAboveNothingAreThoseOfTheSummary) {
  run("[[output]]\ntype = \"rates_above\"\n");
  const auto row = read("rates_above.csv").front();
  for (const auto& part : partners)
    EXPECT_NEAR(number(row, part + " rate [1/s]"), summary()["collision_rate"][part], 1e-9);
  EXPECT_NEAR(number(row, "total dose_rate [W]"), summary()["milling_dose_rate"], 1e-12);
}

TEST_F(MillOutputs, EitherBodyOfAnImpactGetsHalfOfItsDose) {
  run("[[output]]\ntype = \"bodies\"\n");
  std::map<std::string, double> doses, impacts;
  for (const auto& impact : log) {
    const double half = number(impact, "milling_dose") / 2;
    for (const auto& body :
        {"ball " + impact.at("ball"), impact.at("partner_kind") + " " + impact.at("partner")})
      doses[body] += half, ++impacts[body];
  }
  double sum = 0, area = 0;
  const auto rows = read("bodies.csv");
  for (const auto& row : rows) {
    const std::string body = row.at("kind") + " " + row.at("body");
    EXPECT_NEAR(number(row, "dose [J]"), doses[body], 1e-13) << body;
    EXPECT_EQ(number(row, "impacts [1]"), impacts[body]) << body;
    EXPECT_NEAR(number(row, "dose_rate [W]") * 0.2, doses[body], 1e-13) << body;
    sum += number(row, "dose [J]");
    if (row.at("kind") == "wall") area += number(row, "area [m2]");
  }
  EXPECT_EQ(rows.size(), doses.size());
  const double expected = summary()["milling_dose"];
  EXPECT_NEAR(sum, expected, 1e-12 * expected);
  // A cylinder of 38 mm by 57 mm.
  EXPECT_NEAR(area, 3.14159265358979323846 * 0.038 * (0.057 + 0.019), 1e-15);
}

TEST_F(MillOutputs, PowerTimesIntervalsIsTheWallWork) {
  run("[[output]]\ntype = \"vessel_load\"\ninterval = \"7 ms\"\n");
  double work = 0, time = 0;
  const auto rows = read("vessel_load.csv");
  ASSERT_EQ(rows.size(), 29u);
  for (const auto& row : rows) {
    const double duration = number(row, "duration [s]");
    work += number(row, "power [W]") * duration;
    EXPECT_NEAR(number(row, "work [J]"), number(row, "power [W]") * duration, 1e-15);
    time += duration;
    EXPECT_NEAR(number(row, "time [s]"), time, 1e-15);
  }
  const double expected = summary()["wall_work"];
  EXPECT_NEAR(work, expected, 1e-12 * std::abs(expected));
  EXPECT_NEAR(time, 0.2, 1e-15);
}

TEST_F(MillOutputs, ImpulsesAreTheMomentumThatTheBallsLose) {
  run("[[output]]\ntype = \"vessel_load\"\n", flying_balls);
  Vector given = Vector::Zero();
  for (const auto& row : read("vessel_load.csv")) {
    const Vector impulse{number(row, "impulse_x [N s]"), number(row, "impulse_y [N s]"),
        number(row, "impulse_z [N s]")};
    const Vector force{
        number(row, "force_x [N]"), number(row, "force_y [N]"), number(row, "force_z [N]")};
    EXPECT_LT((force * number(row, "duration [s]") - impulse).norm(), 1e-16);
    given += impulse;
  }
  Vector change = -mass * (Vector{1, 0.5, -0.3} + Vector{-1.5, 0.1, 0.2});
  for (const auto& ball : read("final_state.csv")) change += mass * vector(ball, "velocity_");
  EXPECT_LT((given + change - 2 * mass * Vector{0, -9.8, 0} * 0.2).norm(), 1e-13);
  EXPECT_GT(change.norm(), 1e-3);
}

TEST_F(MillOutputs, TorqueIsTheAngularMomentumThatTheBallsLose) {
  run("[[output]]\ntype = \"vessel_load\"\n", flying_balls, "");
  Vector given = Vector::Zero();
  for (const auto& row : read("vessel_load.csv"))
    given += number(row, "duration [s]") *
        Vector{number(row, "torque_x [N m]"), number(row, "torque_y [N m]"),
            number(row, "torque_z [N m]")};
  const double inertia = 0.4 * mass * radius * radius;
  const auto angular_momentum = [&](const Vector& place, const Vector& velocity,
                                    const Vector& spin) -> Vector {
    return mass * place.cross(velocity) + inertia * spin;
  };
  Vector change = -angular_momentum({-0.026, 0.0965, 0}, {1, 0.5, -0.3}, {20, -50, 70}) -
      angular_momentum({-0.0375, 0.0935, 0.002}, {-1.5, 0.1, 0.2}, {0, 0, 0});
  for (const auto& ball : read("final_state.csv"))
    change += angular_momentum(
        vector(ball, "position_"), vector(ball, "velocity_"), vector(ball, "spin_"));
  EXPECT_LT((given + change).norm(), 1e-14);
  EXPECT_GT(change.norm(), 1e-4);
}

TEST_F(MillOutputs, TheVesselFeelsNothingBetweenWallImpacts) {
  run("[[output]]\ntype = \"vessel_load\"\ninterval = \"0.2 ms\"\n", flying_balls);
  std::set<int> with_wall, with_balls;
  for (const auto& impact : log)
    (impact.at("partner_kind") == "wall" ? with_wall : with_balls)
        .insert(static_cast<int>(number(impact, "time") / 0.2e-3));
  int free = 0, balls_only = 0;
  const auto rows = read("vessel_load.csv");
  for (int k = 0; k < static_cast<int>(rows.size()); ++k) {
    bool nothing = true;
    for (const auto& [column, cell] : rows[k])
      nothing = nothing &&
          (column.starts_with("time") || column.starts_with("duration") || std::stod(cell) == 0);
    EXPECT_EQ(nothing, !with_wall.count(k)) << "interval " << k;
    free += nothing;
    balls_only += nothing && with_balls.count(k);
  }
  EXPECT_GT(free, 100);
  EXPECT_GT(balls_only, 0);
}

TEST_F(MillOutputs, LoadInTheVesselFrameIsThatOfTheLog) {
  run("[[output]]\ntype = \"vessel_load\"\ninterval = \"0.2 s\"\n");
  const auto row = read("vessel_load.csv").front();
  Vector force = Vector::Zero(), torque = Vector::Zero();
  for (const auto& impact : log) {
    if (impact.at("partner_kind") == "ball") continue;
    const Vector own = Pose(number(impact, "time")).turned(impulse(impact));
    force += own / 0.2;
    torque += contact_point(impact).cross(own) / 0.2;
  }
  for (const std::string axis : {"x", "y", "z"}) {
    const auto k = axis[0] - 'x';
    EXPECT_NEAR(number(row, "vessel_force_" + axis + " [N]"), force[k], 1e-11);
    EXPECT_NEAR(number(row, "vessel_torque_" + axis + " [N m]"), torque[k], 1e-12);
  }
}

TEST_F(MillOutputs, CoverageHoldsTheWallDoseAndEveryContactPoint) {
  run("[[output]]\ntype = \"coverage\"\nangles = 10\nheights = 7\nrings = 3\n");
  const auto cells = read("coverage.csv");
  ASSERT_EQ(cells.size(), 10u * (7 + 3 + 3));
  double area[3] = {0, 0, 0}, dose[3] = {0, 0, 0}, impacts = 0;
  for (const auto& cell : cells) {
    const auto wall = static_cast<std::size_t>(number(cell, "wall"));
    const std::string band = wall == 2 ? "height" : "radius",
                      other = wall == 2 ? "radius" : "height";
    EXPECT_EQ(cell.at(other + "_low [m]") + cell.at(other + "_high [m]"), "");
    double expected = 0, count = 0;
    for (const auto& impact : log) {
      if (partner(impact) != "wall_" + std::to_string(wall)) continue;
      const Vector p = contact_point(impact);
      const double angle = std::atan2(p[2], p[0]), turned = angle < 0 ? angle + 2 * pi : angle;
      const double place = wall == 2 ? p[1] : std::hypot(p[0], p[2]);
      if (turned < number(cell, "angle_low [rad]") || turned >= number(cell, "angle_high [rad]") ||
          place < number(cell, band + "_low [m]") || place >= number(cell, band + "_high [m]"))
        continue;
      ++count;
      expected += number(impact, "milling_dose");
    }
    EXPECT_EQ(number(cell, "impacts [1]"), count);
    EXPECT_NEAR(number(cell, "dose [J]"), expected, 1e-14);
    EXPECT_NEAR(number(cell, "dose_per_area [J/m2]") * number(cell, "area [m2]"), expected, 1e-14);
    area[wall] += number(cell, "area [m2]");
    dose[wall] += number(cell, "dose [J]");
    impacts += count;
  }
  EXPECT_NEAR(area[0], pi * vessel_radius * vessel_radius, 1e-15);
  EXPECT_NEAR(area[1], pi * vessel_radius * vessel_radius, 1e-15);
  EXPECT_NEAR(area[2], 2 * pi * vessel_radius * 2 * half_height, 1e-15);
  for (std::size_t wall = 0; wall < 3; ++wall)
    EXPECT_NEAR(
        dose[wall], summary()["milling_dose_by_partner"]["wall_" + std::to_string(wall)], 1e-14);
  EXPECT_GT(impacts, 30);
}

}  // namespace
}  // namespace edmill
