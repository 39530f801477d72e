// Spheres, capsules and rounded cylinders: sizes in closed form, true distances, regions.
#include "model/vessels/rounded.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core.hpp"
#include "model/vessel.hpp"
#include "random_physics.hpp"

namespace edmill::model {
namespace {

using testing::draw;

const SphereVessel<double> sphere{0.02};
const RoundedVessel<double> capsule(0, 0.01, 0.02), jar(0.01, 0.02, 0.009);

TEST(Rounded, VolumesOfClosedForms) {
  const double pi = M_PI;
  EXPECT_NEAR(sphere.volume(), 4 * pi * 8e-6 / 3, 1e-20);
  EXPECT_NEAR(capsule.volume(), 4 * pi * 8e-6 / 3 + pi * 4e-4 * 0.02, 1e-20);
  // Pappus: a rectangle, and two quarter discs whose centroids are 4 r / (3 pi) from their straight
  // sides.
  const double a = 0.01, b = 0.02, r = 0.009;
  const double quarter = pi * r * r / 4 * 2 * pi * (a + 4 * r / (3 * pi));
  const double expected = pi * (a + r) * (a + r) * 2 * b + 2 * (pi * a * a * r + quarter);
  EXPECT_NEAR(jar.volume(), expected, 1e-18);
  // The areas of the surfaces are those of the solids.
  const auto area = [](const auto& vessel) {
    double sum = 0;
    for (const auto& wall : vessel.surfaces()) sum += wall.area();
    return sum;
  };
  EXPECT_NEAR(area(sphere), 4 * pi * 4e-4, 1e-17);
  EXPECT_NEAR(area(capsule), 4 * pi * 4e-4 + 2 * pi * 0.02 * 0.02, 1e-17);
  const double arc = pi * r / 2 * 2 * pi * (a + 2 * r / pi);
  EXPECT_NEAR(area(jar), 2 * pi * (a + r) * 2 * b + 2 * pi * a * a + 2 * arc, 1e-17);
}

TEST(Rounded, TheGapOfTheRegionHasTheSignOfTheTrueDistance) {
  for (const auto* vessel : {&capsule, &jar})
    EXPECT_TRUE(rc::check([&] {
      const double by = draw(0.0, 0.008);
      const auto room = vessel->inset(by);
      const double a = vessel->core_radius(), b = vessel->core_half();
      const Vec3<double> p{draw(-0.03, 0.03), draw(-0.04, 0.04), draw(-0.03, 0.03)};
      const double r = std::hypot(p[0], p[2]);
      const double away = std::hypot(std::max(0.0, r - a), std::max(0.0, std::abs(p[1]) - b));
      const double expected = vessel->rounding() - by - away;  // the distance to the wall
      RC_ASSERT(std::abs(room.overlap(2, p) + expected) < 1e-16);
      RC_PRE(std::abs(expected) > 1e-12);
      RC_ASSERT(room.contains(p) == (expected > 0));
      const auto active = room.active(p);
      const auto gaps = room.gaps(p);
      int walls = 0;
      for (int wall = 0; wall < room.wall_count(); ++wall) {
        if (!active[static_cast<std::size_t>(wall)]) continue;
        ++walls;
        RC_ASSERT((gaps[static_cast<std::size_t>(wall)] > 0) == (expected > 0));
        RC_ASSERT(room.is_valid(wall, p));
      }
      RC_ASSERT(walls == (away > 0 ? 1 : 0));
      // Inside of its region a ball is inside of all borders that are watched.
      for (int f = room.wall_count(); f < room.function_count(); ++f)
        RC_ASSERT(!active[static_cast<std::size_t>(f)] || gaps[static_cast<std::size_t>(f)] > 0);
    }));
}

TEST(Rounded, NormalsPointInwardsAlongTheGradient) {
  EXPECT_TRUE(rc::check([&] {
    const double tilt = draw(0.0, M_PI / 2), angle = draw(0.0, 2 * M_PI),
                 r = jar.core_radius() + 0.009 * std::sin(tilt);
    const Vec3<double> p{
        r * std::cos(angle), jar.core_half() + 0.009 * std::cos(tilt), r * std::sin(angle)};
    const Vec3<double> n{
        -std::sin(tilt) * std::cos(angle), -std::cos(tilt), -std::sin(tilt) * std::sin(angle)};
    for (const int wall : {1, 2, 4}) RC_ASSERT((jar.normal(wall, p) - n).norm() < 1e-13);
  }));
}

/// A ball larger than the rounding touches the caps and the cylinder only.
TEST(Rounded, LargeBallsSeeASharpCylinder) {
  const auto room = jar.inset(0.012);
  const CylinderVessel<double> expected{0.019 - 0.012, 0.029 - 0.012};
  EXPECT_TRUE(rc::check([&] {
    const Vec3<double> p{draw(-0.01, 0.01), draw(-0.02, 0.02), draw(-0.01, 0.01)};
    RC_ASSERT(std::abs(room.gap(2, p) - expected.gap(2, p)) < 1e-18);
    RC_ASSERT(std::abs(room.gap(3, p) - expected.gap(0, p)) < 1e-17);
    RC_ASSERT(std::abs(room.gap(4, p) - expected.gap(1, p)) < 1e-17);
    const auto active = room.active(p);
    RC_ASSERT(!active[0] && !active[1] && active[2] && active[3] && active[4]);
    const std::array<int, 3> of_cylinder{2, 0, 1};
    for (int wall = 2; wall < 5; ++wall)
      RC_ASSERT((room.normal(wall, p) -
                    expected.normal(of_cylinder[static_cast<std::size_t>(wall - 2)], p))
                    .norm() < 1e-15);
  }));
  EXPECT_FALSE(jar.inset(0.0189).is_empty());
  EXPECT_TRUE(jar.inset(0.0191).is_empty());
  EXPECT_TRUE(jar.inset(0.019).is_empty());
  EXPECT_TRUE(capsule.inset(capsule.rounding()).is_empty());
  EXPECT_TRUE(capsule.inset(0.0201).is_empty());
  EXPECT_TRUE(sphere.inset(0.0201).is_empty());
}

TEST(Rounded, MapsOfItsSurfacesAreInverse) {
  for (const auto& walls : {sphere.surfaces(), capsule.surfaces(), jar.surfaces()})
    EXPECT_TRUE(rc::check([&] {
      for (std::size_t k = 0; k < walls.size(); ++k) {
        const double u = draw(0.0, 1.0), v = draw(0.0, 1.0);
        const auto p = walls[k].point(u, v);
        const auto found = walls[k].map(p);
        RC_ASSERT(std::abs(found.v - v) < 1e-12);
        RC_ASSERT((walls[k].point(found.u, found.v) - p).norm() < 1e-14);
      }
    }));
}

}  // namespace
}  // namespace edmill::model
