// The prism that stands for a round wall: what contacts are judged against is what decks have as
// triangles.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "casefile/build_case.hpp"
#include "decks/moving_vessel.hpp"

using namespace edmill;

namespace {

using Place = Vec3<double>;

Place normal_of(const decks::Triangle& t) {
  const Place n = cross<double>(Place(t[1] - t[0]), Place(t[2] - t[0]));
  return n / norm<double>(n);
}

TEST(WallMesh, GapsAreThoseOfTheTrianglesOfTheDeck) {
  constexpr unsigned seed = 20261126;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(-1, 1);
  const auto spec = casefile::parse_case(R"(
[run]
end_time = "1 s"
[mill]
type = "drum"
speed = "60 rpm"
[vessel]
type = "cylinder"
diameter = "40 mm"
height = "50 mm"
[contact]
restitution = 0.6
friction = 0.3
[[balls]]
count = 1
diameter = "8 mm"
)",
      "drum.toml");
  const auto built = casefile::build_case<double>(spec);
  const auto& mill = built.the_case.mill;
  constexpr double radius = 0.004;
  for (const int facets : {8, 24, 128}) {
    const auto meshes = decks::meshes_of(mill.vessel, facets);
    const auto side = std::find_if(
        meshes.begin(), meshes.end(), [](const auto& mesh) { return mesh.name == "side"; });
    ASSERT_NE(side, meshes.end());
    const decks::MovingVessel vessel(mill, built.the_case.balls, facets);
    const auto pose = vessel.at(0.123);
    for (int k = 0; k < 2000; ++k) {
      const Place inside{0.014 * share(random), 0.02 * share(random), 0.014 * share(random)};
      double least = INFINITY;
      Place nearest;
      for (const auto& triangle : side->triangles) {
        const Place n = normal_of(triangle);
        const double apart = std::abs(dot<double>(Place(inside - triangle[0]), n)) - radius;
        if (apart < least) least = apart, nearest = n;
      }
      const Place place = mill.motion.to_inertial(pose.front(), inside);
      int near = 0;
      for (int wall = 0; wall < vessel.walls(); ++wall) {
        if (!std::holds_alternative<model::Tube<double>>(
                mill.vessel.surfaces()[static_cast<std::size_t>(wall)].kind()))
          continue;
        ++near;
        ASSERT_NEAR(vessel.gap(pose, 0, wall, place), least, 1e-15)
            << facets << " facets, seed " << seed << ", place " << k;
        const Place n = mill.motion.direction_to_inertial(pose.front(), nearest);
        ASSERT_NEAR(std::abs(dot<double>(vessel.normal(pose, 0, wall, place), n)), 1, 1e-12);
        ASSERT_LT(dot<double>(vessel.normal(pose, 0, wall, place),
                      Place(place - mill.motion.to_inertial(pose.front(), Place(0, inside[1], 0)))),
            0);
      }
      ASSERT_EQ(near, 1);
    }
  }
}

}  // namespace
