// Snapshots, animations and frames for ParaView, each against the run that it shows.
#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <pugixml.hpp>
#include <vector>

#include "output/scene.hpp"
#include "report/animation.hpp"
#include "run_with_outputs.hpp"

namespace edmill {
namespace {

/// Numbers of an attribute.
std::vector<double> list(const pugi::xml_node& node, const char* attribute) {
  std::istringstream in(node.attribute(attribute).value());
  std::vector<double> numbers;
  for (double x; in >> x;) numbers.push_back(x);
  return numbers;
}

pugi::xml_node named(const pugi::xml_document& page, const std::string& name) {
  return page.find_node(
      [&](const pugi::xml_node& n) { return n.attribute("DEF").value() == name; });
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
    EXPECT_NEAR(std::hypot(ball[0] - contact[0], ball[1] - contact[1], ball[2] - contact[2]),
        0.00476, 1e-9);
    EXPECT_EQ(list(named(page, "contact_point").child("Shape").child("Sphere"), "radius"),
        std::vector<double>{0.001});
    EXPECT_EQ(list(named(page, "ball_0").child("Shape").child("Appearance").child("Material"),
                  "diffuseColor"),
        (std::vector<double>{0, 0, 1}));
    // Seen in the vessel frame the ball is inside and touches.
    const auto vessel = named(page, "vessel");
    const auto origin = list(vessel, "translation"), turn = list(vessel, "rotation");
    const Eigen::Vector3d d(ball[0] - origin[0], ball[1] - origin[1], ball[2] - origin[2]);
    const Eigen::Vector3d p =
        Eigen::AngleAxisd(-turn[3], Eigen::Vector3d(turn[0], turn[1], turn[2])) * d;
    const double gap =
        std::min(0.0285 - 0.00476 - std::abs(p[1]), 0.019 - 0.00476 - std::hypot(p[0], p[2]));
    EXPECT_NEAR(gap, 0, 1e-9);
  }
}

TEST_F(Chapter4, AnimationPlaysTheFirstImpacts) {
  pugi::xml_document page;
  ASSERT_TRUE(page.load_file((scratch / "out/animation.x3d").c_str()));
  const auto log = read("collisions.csv");
  const double length = number(log[3], "time");  // it ends with the fourth impact
  EXPECT_NEAR(list(named(page, "clock"), "cycleInterval")[0], length / 0.001, 1e-9);
  for (const std::string name :
      {"vessel_path", "vessel_turn", "ball_0_path", "contact_point_path"}) {
    const auto keys = list(named(page, name), "key"), values = list(named(page, name), "keyValue");
    ASSERT_GE(keys.size(), 4u) << name;
    EXPECT_TRUE(std::is_sorted(keys.begin(), keys.end())) << name;
    EXPECT_GE(keys.front(), 0);
    EXPECT_LE(keys.back(), 1 + 1e-12);
    EXPECT_EQ(values.size(), keys.size() * (name == "vessel_turn" ? 4 : 3)) << name;
  }
  const auto keys = list(named(page, "vessel_turn"), "key"),
             turns = list(named(page, "vessel_turn"), "keyValue"),
             places = list(named(page, "vessel_path"), "keyValue");
  EXPECT_GE(keys.size(), 25u);
  EXPECT_EQ(keys.back(), 1);
  // The nested motion: about Z by theta, along the arm, about the arm by gamma.
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const double phase = 2 * std::acos(-1.0) * 1054 / 60 * length * keys[k],
                 degree = std::acos(-1.0) / 180;
    const double theta = (90 + 15 * std::cos(phase)) * degree,
                 gamma = 15 * std::sin(phase) * degree;
    const Eigen::Quaterniond expected = Eigen::AngleAxisd(theta, Eigen::Vector3d::UnitZ()) *
        Eigen::AngleAxisd(gamma, Eigen::Vector3d::UnitX());
    const Eigen::Quaterniond found(Eigen::AngleAxisd(
        turns[4 * k + 3], Eigen::Vector3d(turns[4 * k], turns[4 * k + 1], turns[4 * k + 2])));
    EXPECT_LT(found.angularDistance(expected), 1e-7) << k;
    EXPECT_NEAR(places[3 * k], 0.1 * std::cos(theta), 1e-12);
    EXPECT_NEAR(places[3 * k + 1], 0.1 * std::sin(theta), 1e-12);
    EXPECT_NEAR(places[3 * k + 2], 0, 1e-12);
  }
  // The ball has a key at each impact.
  const auto ball_keys = list(named(page, "ball_0_path"), "key");
  for (int k = 0; k < 4; ++k)
    EXPECT_TRUE(std::any_of(ball_keys.begin(), ball_keys.end(),
        [&](double key) { return std::abs(key * length - number(log[k], "time")) < 1e-12; }));
  int routes = 0;
  for (const auto& node : page.child("X3D").child("Scene").children("ROUTE")) {
    EXPECT_TRUE(named(page, node.attribute("fromNode").value()));
    EXPECT_TRUE(named(page, node.attribute("toNode").value()));
    ++routes;
  }
  EXPECT_EQ(routes, 8);
}

/// The piston of the animation stands where the case says, in the page and as the report reads it.
TEST_F(Outputs, AnimationMovesPistons) {
  write("case.toml",
      std::string(small_case) +
          "[[vessel.piston]]\nwall = \"cap +y\"\ndistance = \"4 mm\"\n"
          "swing = [{amplitude = \"3 mm\", speed = \"1500 rpm\"}]\n[[output]]\ntype = "
          "\"animation\"\n");
  ASSERT_EQ(edmill("run case.toml --quiet --out out").code, 0);
  const auto animation = report::read_animation(scratch / "out/animation.x3d");
  const auto& vessel = animation.vessel;
  ASSERT_EQ(vessel.walls.size(), 3u);
  int moving = 0;
  for (std::size_t wall = 0; wall < 3; ++wall) {
    const auto& shift = vessel.shifts[wall];
    if (shift.keys.size() == 1) {
      EXPECT_EQ(shift.values.norm(), 0);
      continue;
    }
    ++moving;
    for (const double key : shift.keys) {
      const double inward = 0.004 + 0.003 * std::sin(2 * std::acos(-1.0) * 25 * 0.2 * key);
      for (const auto& point : vessel.walls[wall].points)
        ASSERT_NEAR(point[1] + shift.at(key)[1], 0.0285 - inward, 1e-9) << "at " << key;
    }
  }
  EXPECT_EQ(moving, 1);
}

TEST_F(Outputs, ParaviewFramesHoldBallsAndVessel) {
  write("case.toml",
      std::string(small_case) +
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

/// A box about the origin, turned about y by an angle in degrees, at a height.
Frame<double> turned(double angle, double height) {
  const Eigen::Matrix3d axes =
      Eigen::AngleAxisd(angle * std::acos(-1.0) / 180, Eigen::Vector3d::UnitY()).toRotationMatrix();
  return {{0, height, 0}, axes.col(0), axes.col(1), axes.col(2)};
}
output::Scene box_scene() {
  output::Scene scene{};
  for (const auto& wall : model::box_surfaces<double>({0.01, 0.02, 0.03}))
    scene.vessel.walls.push_back(model::mesh_of(wall));
  scene.vessel.frame = turned(90, 1);
  return scene;
}

TEST(BoxScene, HasSixWallsInTheVesselFrame) {
  pugi::xml_document page;
  ASSERT_TRUE(page.load_string(output::vtp_vessel(box_scene()).c_str()));
  const auto piece = page.child("VTKFile").child("PolyData").child("Piece");
  EXPECT_EQ(piece.attribute("NumberOfPolys").as_int(), 6);
  EXPECT_EQ(std::string(piece.child("CellData").child("DataArray").text().get()), "0 1 2 3 4 5 ");
  std::istringstream numbers(piece.child("Points").child("DataArray").text().get());
  int points = 0;
  for (double x, y, z; numbers >> x >> y >> z; ++points) {
    EXPECT_NEAR(std::abs(x), 0.03, 1e-15);  // z of the box, which is turned by a right angle
    EXPECT_NEAR(std::abs(y - 1), 0.02, 1e-15);
    EXPECT_NEAR(std::abs(z), 0.01, 1e-15);
  }
  EXPECT_EQ(points, 24);
}

TEST(BoxScene, HasItsBodies) {
  const auto file =
      std::filesystem::temp_directory_path() / ("body_" + std::to_string(::getpid()) + ".x3d");
  auto scene = box_scene();
  const model::RoundedBody<double> plate(false, {0.01, 0, 0.02}, 0.003);
  scene.bodies.push_back({{model::mesh_of(plate)}, {1, 0, 0}, turned(0, 0)});
  const output::SceneMotion motion{1, {{0, turned(0, 0)}, {1, turned(0, 0)}},
      {{{0, turned(0, 0)}, {1, turned(90, 2)}}}, {}, {}, {}};
  std::ofstream(file) << output::x3d_text(scene, &motion);
  const auto bodies = report::read_animation(file).bodies;
  std::filesystem::remove(file);
  ASSERT_EQ(bodies.size(), 1u);
  EXPECT_EQ(bodies[0].colour, "#ff0000");
  EXPECT_EQ(bodies[0].opacity, 1);
  // Every corner is on the surface, and the outermost are where the sizes are.
  Vec3<double> most = Vec3<double>::Zero();
  for (const auto& point : bodies[0].walls[0].points) {
    EXPECT_NEAR(plate.overlap(0, point), 0, 1e-9);
    most = most.cwiseMax(point.cwiseAbs());
  }
  EXPECT_NEAR((most - Vec3<double>(0.013, 0.003, 0.023)).norm(), 0, 1e-9);
  const Vec3<double> there = bodies[0].pose(1) * Vec3<double>(1, 0, 0);
  EXPECT_NEAR((there - turned(90, 2).outside({1, 0, 0})).norm(), 0, 1e-9);
}

TEST(BoxScene, IsReadBackAndTurnsTheShortWay) {
  const auto file =
      std::filesystem::temp_directory_path() / ("box_" + std::to_string(::getpid()) + ".x3d");
  const output::SceneMotion motion{1, {{0, turned(170, 1)}, {1, turned(-170, 3)}}, {}, {}, {}, {}};
  std::ofstream(file) << output::x3d_text(box_scene(), &motion);
  const auto vessel = report::read_animation(file).vessel;
  std::filesystem::remove(file);
  ASSERT_EQ(vessel.walls.size(), 6u);
  for (const auto& wall : vessel.walls)
    EXPECT_EQ(wall.faces, (std::vector<std::vector<int>>{{0, 1, 2, 3}}));
  const auto half_way = vessel.pose(0.5);
  EXPECT_TRUE((half_way * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(-1, 2, 0), 1e-12));
  EXPECT_TRUE((half_way * Eigen::Vector3d(0, 0, 1)).isApprox(Eigen::Vector3d(0, 2, -1), 1e-12));
}

}  // namespace
}  // namespace edmill
