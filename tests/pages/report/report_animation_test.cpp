// The animation of a report, and its frames in the page.
#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "report_run.hpp"

namespace {

using edmill::testing::Report;

std::vector<double> numbers(const pugi::xml_node& node, const char* attribute) {
  std::istringstream text(node.attribute(attribute).as_string());
  return {std::istream_iterator<double>(text), std::istream_iterator<double>()};
}

TEST_F(Report, TheAnimationBeginsWithTheStatisticsAndHasEveryBallInTheVessel) {
  run("--report");
  pugi::xml_document animation;
  ASSERT_TRUE(animation.load_file((folder / "report/animation.x3d").c_str()));
  const auto scene = animation.child("X3D").child("Scene");
  const double period = 60.0 / 1054, degree = std::acos(-1.0) / 180;
  for (int ball = 0; ball < 28; ++ball) {
    const auto path =
        scene.find_child_by_attribute("DEF", ("ball_" + std::to_string(ball) + "_path").c_str());
    const auto keys = numbers(path, "key"), places = numbers(path, "keyValue");
    ASSERT_EQ(places.size(), 3 * keys.size());
    EXPECT_EQ(keys.front(), 0);
    EXPECT_EQ(keys.back(), 1);
    EXPECT_TRUE(std::is_sorted(keys.begin(), keys.end()));
    for (std::size_t k = 0; k < keys.size(); ++k) {
      const double phase =
          2 * std::acos(-1.0) * (0.5 / period + 2 * keys[k]);  // two turns from 0.5 s on
      const double theta = (90 + 15 * std::cos(phase)) * degree,
                   gamma = 15 * std::sin(phase) * degree;
      const double *place = &places[3 * k], x = place[0], y = place[1], z = place[2];
      const double along = std::cos(theta) * x + std::sin(theta) * y - 0.1;
      const double across = -std::sin(theta) * x + std::cos(theta) * y;
      const double axial = across * std::cos(gamma) + z * std::sin(gamma);
      const double side = -across * std::sin(gamma) + z * std::cos(gamma);
      ASSERT_LT(std::abs(axial), 0.0285 - 0.00238 + 1e-9) << "ball " << ball << ", key " << keys[k];
      ASSERT_LT(std::hypot(along, side), 0.019 - 0.00238 + 1e-9)
          << "ball " << ball << ", key " << keys[k];
    }
  }
}

/// Where ball `ball` is at a fraction of the animation: straight between the keys of its path.
std::array<double, 3> place_at(const pugi::xml_node& scene, std::size_t ball, double fraction) {
  const auto path =
      scene.find_child_by_attribute("DEF", ("ball_" + std::to_string(ball) + "_path").c_str());
  const auto keys = numbers(path, "key"), values = numbers(path, "keyValue");
  std::size_t k = 1;
  while (k + 1 < keys.size() && keys[k] < fraction) ++k;
  const double share = (fraction - keys[k - 1]) / (keys[k] - keys[k - 1]);
  std::array<double, 3> place;
  for (std::size_t c = 0; c < 3; ++c)
    place[c] = values[3 * (k - 1) + c] + share * (values[3 * k + c] - values[3 * (k - 1) + c]);
  return place;
}

TEST_F(Report, TheFramesOfThePageShowTheAnimation) {
  run("--report");
  pugi::xml_document animation;
  ASSERT_TRUE(animation.load_file((folder / "report/animation.x3d").c_str()));
  const auto scene = animation.child("X3D").child("Scene");
  const auto main = body();
  const auto frames =
      nlohmann::json::parse(main.select_node("//script[@id='frames']").node().text().get());
  const auto slider = main.select_node("//input[@id='time']").node();
  EXPECT_NEAR(slider.attribute("max").as_double(), 1000 * 2 * 60.0 / 1054, 1e-3);
  EXPECT_NEAR(frames["duration"], 8, 1e-9);
  // From the front onto the middle of what the vessel sweeps.
  const std::vector<double> eye = frames["eye"], target = frames["target"];
  EXPECT_NEAR(target[0], 0, 0.1);
  EXPECT_EQ((std::vector<double>{eye[0], eye[1]}), (std::vector<double>{target[0], target[1]}));
  EXPECT_NEAR(target[2], 0, 0.1);
  EXPECT_GT(eye[2], 100);
  const auto& walls = frames["vessel"]["walls"];
  ASSERT_EQ(walls.size(), 3u);
  for (std::size_t wall = 0; wall < 3; ++wall) {
    EXPECT_EQ(walls[wall]["flat"], wall < 2);  // two caps and the cylinder
    EXPECT_EQ(walls[wall]["points"].size(), wall < 2 ? 48u : 96u);
    EXPECT_FALSE(walls[wall].contains("shifts"));
    for (const std::vector<double> corner : walls[wall]["points"]) {
      EXPECT_NEAR(std::hypot(corner[0], corner[2]), 19, 1e-3);
      EXPECT_NEAR(std::abs(corner[1]), 28.5, 1e-9);
    }
  }
  EXPECT_NEAR(frames["vessel"]["opacity"], 0.3, 1e-9);
  EXPECT_EQ(frames["vessel"]["colour"], "#ffff00");
  EXPECT_EQ(frames["spheres"]["colours"], std::vector<std::string>(28, "#0000ff"));
  for (const double radius : frames["spheres"]["radii"]) EXPECT_NEAR(radius, 2.38, 1e-9);
  const std::vector<double> poses = frames["vessel"]["poses"], places = frames["spheres"]["places"];
  const std::size_t count = poses.size() / 7;
  ASSERT_GT(count, 100u);
  ASSERT_EQ(poses.size(), 7 * count);
  ASSERT_EQ(places.size(), 3 * 28 * count);
  const double turn = 2 * std::acos(-1.0), degree = turn / 360;
  for (std::size_t frame = 0; frame < count; frame += 20) {
    const double fraction = static_cast<double>(frame) / static_cast<double>(count - 1);
    for (std::size_t ball = 0; ball < 28; ++ball) {
      const auto place = place_at(scene, ball, fraction);
      for (std::size_t c = 0; c < 3; ++c)
        ASSERT_NEAR(places[3 * (28 * frame + ball) + c], 1000 * place[c], 0.0051)
            << ball << " " << frame;
    }
    // Places are straight between keys, 80 each turn, and turns uniform: up to 0.02 mm and 0.2 mrad
    // off.
    const double phase = turn * (0.5 * 1054 / 60 + 2 * fraction);
    const double theta = (90 + 15 * std::cos(phase)) * degree,
                 gamma = 15 * std::sin(phase) * degree;
    const double* pose = &poses[7 * frame];
    EXPECT_NEAR(pose[0], 100 * std::cos(theta), 0.03);
    EXPECT_NEAR(pose[1], 100 * std::sin(theta), 0.03);
    EXPECT_NEAR(pose[2], 0, 0.005);
    EXPECT_NEAR(pose[3], std::cos(theta / 2) * std::sin(gamma / 2), 2e-4);
    EXPECT_NEAR(pose[4], std::sin(theta / 2) * std::sin(gamma / 2), 2e-4);
    EXPECT_NEAR(pose[5], std::sin(theta / 2) * std::cos(gamma / 2), 2e-4);
    EXPECT_NEAR(pose[6], std::cos(theta / 2) * std::cos(gamma / 2), 2e-4);
  }
}

}  // namespace
