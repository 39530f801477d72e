// The walls of vessels as surfaces: coordinates, areas, and the meshes of pictures.
#include "model/parts/surface.hpp"

#include <gtest/gtest.h>

#include <set>

#include "core.hpp"
#include "model/vessel.hpp"
#include "random_physics.hpp"

namespace edmill::model {
namespace {

using testing::draw;

const CylinderVessel<double> vial{0.019, 0.0285};
const Vec3<double> half_sizes{0.01, 0.02, 0.03};

template <class Real>
void expect_inverse(const std::vector<WallSurface<Real>>& walls, const Real& size) {
  EXPECT_TRUE(rc::check([&] {
    for (const auto& wall : walls) {
      const Real u = draw<Real>(Real(0), Real(1)), v = draw<Real>(Real(0), Real(1));
      const Vec3<Real> p = wall.point(u, v);
      const auto found = wall.map(p);
      const Real allowed = 64 * epsilon<Real>();
      RC_ASSERT(abs(found.v - v) <= allowed);
      RC_ASSERT(norm<Real>(Vec3<Real>(wall.point(found.u, found.v) - p)) <= allowed * size);
    }
  }));
}

TEST(WallSurface, PointAndMapAreInverse) {
  using std::abs;
  expect_inverse(vial.surfaces(), vial.reach());
  expect_inverse(box_surfaces(half_sizes), half_sizes.norm());
  expect_inverse(
      CylinderVessel<mpfr50>{mpfr50("0.019"), mpfr50("0.0285")}.surfaces(), mpfr50("0.04"));
  // Anywhere and turned: the frame's y axis along X.
  const Frame<double> frame{{1, 2, 3}, {0, 1, 0}, {1, 0, 0}, {0, 0, -1}};
  expect_inverse<double>({Disc<double>{{frame}, 0.3}, Tube<double>{{frame}, 0.3, 0.4}}, 5);
}

TEST(WallSurface, PointsLieOnTheWall) {
  const auto walls = vial.surfaces();
  const auto box = box_surfaces(half_sizes);
  EXPECT_TRUE(rc::check([&] {
    const double u = draw<double>(0, 1), v = draw<double>(0, 1);
    for (int wall = 0; wall < 3; ++wall)
      RC_ASSERT(
          std::abs(vial.overlap(wall, walls[static_cast<std::size_t>(wall)].point(u, v))) < 1e-16);
    for (int wall = 0; wall < 6; ++wall) {
      const Vec3<double> p = box[static_cast<std::size_t>(wall)].point(u, v);
      RC_ASSERT(p[wall / 2] == half_sizes[wall / 2] * (wall % 2 == 0 ? -1 : 1));
      for (int axis = 0; axis < 3; ++axis)
        RC_ASSERT(std::abs(p[axis]) <= half_sizes[axis] * (1 + 1e-15));
    }
  }));
}

double area(const std::vector<WallSurface<double>>& walls) {
  double sum = 0;
  for (const auto& wall : walls) sum += wall.area();
  return sum;
}

TEST(WallSurface, AreasAddUpToTheVessels) {
  const double pi = numerics::pi<double>(), R = vial.radius, h = 2 * vial.half_height;
  EXPECT_NEAR(area(vial.surfaces()), 2 * pi * R * (R + h), 1e-16);
  EXPECT_NEAR(area(box_surfaces(half_sizes)), 8 * (0.01 * 0.02 + 0.02 * 0.03 + 0.03 * 0.01), 1e-16);
}

/// Area of the part of a wall between two u and two v, from |dP/du x dP/dv| by the midpoint rule.
double area_between(const WallSurface<double>& wall, double u, double v, double size) {
  constexpr int parts = 40;
  const double step = size / parts, d = 1e-5;
  double sum = 0;
  for (int i = 0; i < parts; ++i)
    for (int j = 0; j < parts; ++j) {
      const double a = u + (i + 0.5) * step, b = v + (j + 0.5) * step;
      const Vec3<double> along_u = (wall.point(a + d, b) - wall.point(a - d, b)) / (2 * d),
                         along_v = (wall.point(a, b + d) - wall.point(a, b - d)) / (2 * d);
      sum += cross<double>(along_u, along_v).norm() * step * step;
    }
  return sum;
}

TEST(WallSurface, EqualPartsHaveEqualAreas) {
  auto walls = vial.surfaces();
  const auto box = box_surfaces(half_sizes);
  walls.insert(walls.end(), box.begin(), box.end());
  for (const auto& wall : walls)
    for (const double u : {0.0, 0.25, 0.75})
      for (const double v : {0.25, 0.5, 0.75})
        EXPECT_NEAR(area_between(wall, u, v, 0.25), wall.area() / 16, 1e-6 * wall.area());
}

/// The value of a coordinate at a point of the vial or of a wall of the box.
double value_at(const WallSurface<double>& wall, std::size_t axis, const Vec3<double>& p) {
  switch (wall.coordinates()[axis]) {
    case Coordinate::angle: {
      const double angle = std::atan2(p[2], p[0]);
      return angle < 0 ? angle + 2 * numerics::pi<double>() : angle;
    }
    case Coordinate::height: return p[1];
    case Coordinate::radius: return std::hypot(p[0], p[2]);
    default: {
      const auto& rectangle = std::get<Rectangle<double>>(wall.kind());
      return Vec3<double>(p - rectangle.centre).dot(rectangle.halves[axis].normalized());
    }
  }
}

TEST(WallSurface, EdgesAreTheValuesOfTheCoordinatesThere) {
  auto walls = vial.surfaces();
  const auto box = box_surfaces(half_sizes);
  walls.insert(walls.end(), box.begin(), box.end());
  for (const auto& wall : walls)
    for (std::size_t k = 1; k < 7; ++k) {
      const double share = static_cast<double>(k) / 7;
      const auto p = wall.point(share, share);
      for (const int axis : {0, 1})
        EXPECT_NEAR(
            wall.edge(axis, k, 7), value_at(wall, static_cast<std::size_t>(axis), p), 1e-14);
    }
}

TEST(WallSurface, AnglesBelongToThePartThatTheyBegin) {
  const auto tube = vial.surfaces()[2];
  const auto u = [&](double x, double z) { return tube.map({x, 0, z}).u; };
  EXPECT_EQ(u(0.019, 0), 0);
  EXPECT_EQ(u(0, 0.019), 0.25);
  EXPECT_EQ(u(-0.019, 0), 0.5);
  EXPECT_EQ(u(0, -0.019), 0.75);
}

TEST(Mesh, IsTheWallAsFlatFaces) {
  const auto walls = vial.surfaces();
  for (std::size_t id = 0; id < walls.size(); ++id) {
    const auto mesh = mesh_of(walls[id]);
    std::set<int> used;
    double area = 0;
    for (const auto& face : mesh.faces) {
      used.insert(face.begin(), face.end());
      const auto corner = [&](std::size_t k) {
        return mesh.points[static_cast<std::size_t>(face[k])];
      };
      for (std::size_t k = 2; k < face.size(); ++k)
        area += cross<double>(corner(k - 1) - corner(0), corner(k) - corner(0)).norm() / 2;
    }
    EXPECT_EQ(used.size(), mesh.points.size());
    EXPECT_EQ(*used.rbegin() + 1, static_cast<int>(mesh.points.size()));
    EXPECT_NEAR(area, walls[id].area(), 0.003 * walls[id].area());  // 48 sides
    for (const auto& p : mesh.points) {
      EXPECT_NEAR(std::hypot(p[0], p[2]), 0.019, 1e-16);
      EXPECT_NEAR(std::abs(p[1]), 0.0285, 1e-16);
    }
  }
  const auto side = mesh_of(box_surfaces(half_sizes)[5]);
  EXPECT_EQ(side.faces, (std::vector<std::vector<int>>{{0, 1, 2, 3}}));
}

}  // namespace
}  // namespace edmill::model
