// A rectangular box about the origin of the vessel frame.
#pragma once

#include <array>
#include <vector>

#include "model/parts/parameter.hpp"
#include "model/parts/partners.hpp"
#include "model/parts/surface.hpp"
#include "model/parts/vessel_frame.hpp"

namespace edmill::model {

/// Walls 0 to 5 are those at x = -a, x = +a, y = -b, y = +b, z = -c, z = +c; all gaps are lengths [m].
template <class Real>
struct BoxVessel {
  using Scalar = Real;
  template <class Value>
  using PerWall = std::array<Value, 6>;
  template <class Value>
  using PerKind = std::array<Value, 3>;

  Vec3<Real> half{Real(0), Real(0), Real(0)};  ///< a, b, c: half of the edges [m]

  template <class To>
  BoxVessel<To> cast() const {
    return {vector_cast<To>(half)};
  }

  static constexpr int wall_count() { return 6; }
  static std::vector<WallInfo> walls() {
    return {{"wall -x", "the wall at -x"}, {"wall +x", "the wall at +x"}, {"wall -y", "the wall at -y"},
            {"wall +y", "the wall at +y"}, {"wall -z", "the wall at -z"}, {"wall +z", "the wall at +z"}};
  }

  std::vector<WallSurface<Real>> surfaces() const { return box_surfaces<Real>(half); }

  Real reach() const { return norm<Real>(half); }
  Real extent() const { return half[0] + half[1] + half[2]; }
  Vec3<Real> half_sizes() const { return half; }
  Real volume() const { return 8 * half[0] * half[1] * half[2]; }
  Real widest_ball() const {
    const Real least = half[0] < half[1] ? half[0] : half[1];
    return 2 * (least < half[2] ? least : half[2]);
  }

  BoxVessel inset(const Real& by) const { return {{half[0] - by, half[1] - by, half[2] - by}}; }
  bool is_empty() const { return !(half[0] > 0 && half[1] > 0 && half[2] > 0); }
  bool contains(const Vec3<Real>& p) const {
    bool inside = true;
    for (int axis = 0; axis < 3; ++axis) inside &= p[axis] <= half[axis] && p[axis] >= -half[axis];
    return inside;
  }

  PerWall<Real> gaps(const Vec3<Real>& p) const {
    return {half[0] + p[0], half[0] - p[0], half[1] + p[1], half[1] - p[1], half[2] + p[2], half[2] - p[2]};
  }
  Real gap(int wall, const Vec3<Real>& p) const {
    const int axis = kind_of(wall);
    return wall % 2 == 0 ? Real(half[axis] + p[axis]) : Real(half[axis] - p[axis]);
  }
  static PerWall<Real> rates(const Vec3<Real>&, const Vec3<Real>& u) {
    return {u[0], -u[0], u[1], -u[1], u[2], -u[2]};
  }
  static PerWall<Real> curvatures(const Vec3<Real>& p, const Vec3<Real>&, const Vec3<Real>& a) {
    return rates(p, a);
  }
  PerWall<bool> within(const Vec3<Real>& p, const Real& way) const {
    PerWall<bool> near;
    for (int wall = 0; wall < 6; ++wall) near[wall] = !(gap(wall, p) > way);
    return near;
  }

  static constexpr int kind_of(int wall) { return wall / 2; }  ///< the axis
  static PerKind<Real> derivative_bounds(const CoordinateBounds<Real>& c, int k) {
    return {c.x[k], c.y[k], c.z[k]};
  }
  static constexpr bool is_flat(int) { return true; }
  static ErrorBounds<Real> curved_errors(int, const ErrorBounds<Real>& coordinate, const Real&, const Real&,
                                         const Real&, const Real&) {
    return coordinate;
  }

  Vec3<Real> normal(int wall, const Vec3<Real>&) const {
    Vec3<Real> n{Real(0), Real(0), Real(0)};
    n[kind_of(wall)] = Real(wall % 2 == 0 ? 1 : -1);
    return n;
  }
  Real overlap(int wall, const Vec3<Real>& p) const { return -gap(wall, p); }
};

/// [vessel] type = "box".
template <class Number>
struct Box {
  static constexpr const char* name = "box";
  std::array<Number, 3> size;

  static void parameters(auto& part, auto&& visit) {
    visit(Parameter{"size", Dimension::length, "inner sizes along x, y, z", Range::positive}, part.size);
  }
  BoxVessel<Number> vessel() const { return {{size[0] / 2, size[1] / 2, size[2] / 2}}; }
};

}  // namespace edmill::model
