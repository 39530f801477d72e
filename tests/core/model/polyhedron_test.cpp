// Vessels of planes: sizes in closed form, and what is no vessel.
#include "model/vessels/polyhedron.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core.hpp"
#include "model/vessels/simple.hpp"
#include "random_physics.hpp"

namespace edmill::model {
namespace {

using testing::draw;
using Vessel = PolyhedronVessel<double>;
using Planes = std::vector<Vessel::Plane>;

/// x, y, z between these limits.
Planes block(const Vec3<double>& low, const Vec3<double>& high) {
  Planes planes;
  for (int axis = 0; axis < 3; ++axis) {
    planes.push_back({-Vec3<double>::Unit(axis), -low[axis]});
    planes.push_back({Vec3<double>::Unit(axis), high[axis]});
  }
  return planes;
}

/// A regular tetrahedron about the origin: the distance of its planes is a third of that of its
/// corners.
Planes tetrahedron(double distance) {
  return {{{1, 1, 1}, distance}, {{1, -1, -1}, distance}, {{-1, 1, -1}, distance},
      {{-1, -1, 1}, distance}};
}

/// A right prism over a regular polygon with this inradius.
Planes prism(int sides, double inradius, double half_height) {
  Planes planes{{{0, -1, 0}, half_height}, {{0, 1, 0}, half_height}};
  for (int k = 0; k < sides; ++k) {
    const double angle = 2 * M_PI * k / sides;
    planes.push_back({{std::cos(angle), 0, std::sin(angle)}, inradius});
  }
  return planes;
}

TEST(Polyhedron, VolumeAndReachOfClosedForms) {
  // Edge a = d sqrt(24), volume a^3 / (6 sqrt(2)), circumradius 3 d.
  const double d = 0.01, a = d * std::sqrt(24.0);
  const Vessel four(tetrahedron(d));
  EXPECT_NEAR(four.volume(), a * a * a / (6 * std::sqrt(2.0)), 1e-14 * a * a * a);
  EXPECT_NEAR(four.reach(), 3 * d, 1e-5 * d);
  EXPECT_GE(four.reach(), 3 * d);
  for (const int sides : {3, 6, 12}) {
    const Vessel jar(prism(sides, 0.02, 0.03));
    EXPECT_NEAR(jar.volume(), sides * std::tan(M_PI / sides) * 0.02 * 0.02 * 0.06, 1e-18) << sides;
    EXPECT_NEAR(jar.reach(), std::hypot(0.02 / std::cos(M_PI / sides), 0.03), 1e-7) << sides;
  }
}

TEST(Polyhedron, ABlockIsTheBox) {
  const Vec3<double> half{0.01, 0.02, 0.03};
  const Vessel planes(block(-half, half));
  const BoxVessel<double> box{half};
  EXPECT_NEAR(planes.volume(), box.volume(), 1e-15 * box.volume());
  EXPECT_NEAR(planes.reach(), box.reach(), 1e-5 * box.reach());
  EXPECT_TRUE(rc::check([&] {
    const Vec3<double> p{draw(-0.04, 0.04), draw(-0.04, 0.04), draw(-0.04, 0.04)};
    const auto ours = planes.gaps(p);
    const auto expected = box.gaps(p);
    for (std::size_t wall = 0; wall < 6; ++wall)
      RC_ASSERT(std::abs(ours[wall] - expected[wall]) < 1e-17);
    RC_ASSERT(planes.contains(p) == box.contains(p));
  }));
}

TEST(Polyhedron, RoomForABallDoesNotDependOnTheOrigin) {
  EXPECT_TRUE(rc::check([&] {
    const Vec3<double> size{draw(0.01, 0.1), draw(0.01, 0.1), draw(0.01, 0.1)};
    const Vec3<double> low{
        -size[0] * draw(0.01, 0.99), -size[1] * draw(0.01, 0.99), -size[2] * draw(0.01, 0.99)};
    const Vessel vessel(block(low, low + size));
    const double widest = size.minCoeff() / 2;
    RC_ASSERT(!vessel.inset(widest * (1 - 1e-6)).is_empty());
    RC_ASSERT(vessel.inset(widest * (1 + 1e-6)).is_empty());
    RC_ASSERT(vessel.widest_ball() >= 2 * widest * (1 - 1e-12));
  }));
  // A tetrahedron's largest ball is that in the middle.
  EXPECT_FALSE(Vessel(tetrahedron(0.01)).inset(0.00999).is_empty());
  EXPECT_TRUE(Vessel(tetrahedron(0.01)).inset(0.01001).is_empty());
}

TEST(Polyhedron, RefusesWhatIsNoVessel) {
  const auto all = block({-1, -1, -1}, {1, 1, 1});
  const auto without = [&](std::size_t k) {
    Planes left = all;
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(k));
    return left;
  };
  const auto with = [&](const Vessel::Plane& plane) {
    Planes more = all;
    more.push_back(plane);
    return more;
  };
  EXPECT_NO_THROW(Vessel{all});
  for (std::size_t k = 0; k < 6; ++k)
    EXPECT_THROW(Vessel{without(k)}, InputError) << "open at wall " << k;
  EXPECT_THROW(Vessel({all[0], all[1], all[2]}), InputError) << "too few planes";
  EXPECT_THROW(Vessel{with({{1, 1, 0}, 1.5})}, InputError) << "a plane outside";
  EXPECT_NO_THROW(Vessel{with({{1, 1, 0}, 1.4})}) << "a plane that cuts an edge";
  EXPECT_THROW(Vessel{with({{0, 0, 0}, 1.0})}, InputError) << "no normal";
  EXPECT_THROW(Vessel{with({{1, 1, 0}, -0.1})}, InputError) << "the origin outside";
  EXPECT_THROW(Vessel(prism(32, 0.02, 0.03)), InputError) << "too many planes";
}

TEST(Polyhedron, PlacesOnlyInside) {
  const Vessel four(tetrahedron(0.01));
  int placed = 0;
  EXPECT_TRUE(rc::check([&] {
    const auto p =
        AnyVessel<double>(four).place({draw(-1.0, 1.0), draw(-1.0, 1.0), draw(-1.0, 1.0)});
    if (!p) return;
    ++placed;
    const auto gaps = four.gaps(*p);
    RC_ASSERT(std::all_of(gaps.begin(), gaps.end(), [](double gap) { return gap >= 0; }));
  }));
  EXPECT_GT(placed, 10);
}

}  // namespace
}  // namespace edmill::model
