// Vessels whose gaps are smooth everywhere, about the origin of the vessel frame: cylinder, box,
// sphere.
#pragma once

#include <optional>

#include "model/parts/parameter.hpp"
#include "model/parts/partners.hpp"
#include "model/parts/surface.hpp"

namespace edmill::model {

/// A closed cylinder about the y axis. The gaps to its caps are lengths [m]; that to the cylinder
/// is q = (R_v-R)^2 - x^2 - z^2 [m^2], which is smooth on the axis and has the sign of the gap.
/// (2.19'), (2.21'), (2.22'). Walls as in the thesis: 0 is the cap at y = -h/2, 1 that at y = +h/2,
/// 2 the cylinder.
template <class Real> struct CylinderVessel {
  using Scalar = Real;
  template <class Value> using PerWall = std::array<Value, 3>;
  template <class Value> using PerKind = std::array<Value, 2>;

  Real radius{0};       ///< inner radius R_v [m]
  Real half_height{0};  ///< h/2 [m]

  template <class To> CylinderVessel<To> cast() const {
    return {static_cast<To>(radius), static_cast<To>(half_height)};
  }

  static constexpr int wall_count() { return 3; }
  static std::vector<WallInfo> walls() {
    return {{"cap -y", "the cap at -y"}, {"cap +y", "the cap at +y"}, {"cylinder", "the cylinder"}};
  }

  std::vector<WallSurface<Real>> surfaces() const {
    const Vec3<Real> top{Real(0), half_height, Real(0)};
    return {Disc<Real>{{frame_at<Real>(-top)}, radius}, Disc<Real>{{frame_at<Real>(top)}, radius},
        Tube<Real>{{frame_at<Real>(Vec3<Real>::Zero())}, radius, half_height}};
  }

  Real reach() const {
    using std::sqrt;
    return sqrt(radius * radius + half_height * half_height);
  }
  Real extent() const { return radius + half_height; }
  Vec3<Real> half_sizes() const { return {radius, half_height, radius}; }
  Real volume() const { return 2 * numerics::pi<Real>() * radius * radius * half_height; }
  Real widest_ball() const { return 2 * (radius < half_height ? radius : half_height); }

  CylinderVessel inset(const Real& by) const { return {radius - by, half_height - by}; }
  bool is_empty() const { return !(radius > 0 && half_height > 0); }
  bool contains(const Vec3<Real>& p) const {
    return !is_empty() && squared_across(p) <= radius * radius && magnitude(p[1]) <= half_height;
  }
  std::optional<Vec3<Real>> place(const Vec3<Real>& drawn) const {
    if (squared_across(drawn) > 1) return std::nullopt;
    return Vec3<Real>{drawn[0] * radius, drawn[1] * half_height, drawn[2] * radius};
  }

  PerWall<Real> gaps(const Vec3<Real>& p) const {
    return {half_height + p[1], half_height - p[1], radius * radius - squared_across(p)};
  }
  Real gap(int wall, const Vec3<Real>& p) const {
    if (wall == 2) return radius * radius - squared_across(p);
    return wall == 0 ? Real(half_height + p[1]) : Real(half_height - p[1]);
  }
  static PerWall<Real> rates(const Vec3<Real>& p, const Vec3<Real>& u) {
    return {u[1], -u[1], -2 * (p[0] * u[0] + p[2] * u[2])};
  }
  static PerWall<Real> curvatures(const Vec3<Real>& p, const Vec3<Real>& u, const Vec3<Real>& a) {
    return {a[1], -a[1], -2 * ((u[0] * u[0] + p[0] * a[0]) + (u[2] * u[2] + p[2] * a[2]))};
  }
  PerWall<bool> within(const Vec3<Real>& p, const Real& way) const {
    const Real cap = half_height - way, side = radius - way;
    return {!(-p[1] < cap), !(p[1] < cap), !((side > 0) & (squared_across(p) < side * side))};
  }

  /// 0 the caps, 1 the cylinder.
  static constexpr int kind_of(int wall) { return wall == 2; }
  static PerKind<Real> derivative_bounds(const CoordinateBounds<Real>& c, int k) {
    return {c.y[k], product_bound(c.x, 0, c.x, k) + product_bound(c.z, 0, c.z, k)};
  }

  static constexpr bool is_flat(int wall) { return kind_of(wall) == 0; }
  ErrorBounds<Real> curved_errors(int, const ErrorBounds<Real>& y, const Real& u, const Real& v,
      const Real& a, const Real& beyond) const {
    return squared_distance_errors(y, u, v, a, Real(radius + beyond));
  }

  Vec3<Real> normal(int wall, const Vec3<Real>& p) const {
    if (wall != 2) return {Real(0), Real(wall == 0 ? 1 : -1), Real(0)};
    const Real rho = across(p);
    return {-p[0] / rho, Real(0), -p[2] / rho};
  }
  Real overlap(int wall, const Vec3<Real>& p) const {
    if (wall == 2) return across(p) - radius;
    return (wall == 0 ? Real(-p[1]) : p[1]) - half_height;
  }
};

/// [vessel] type = "cylinder".
template <class Number> struct Cylinder {
  static constexpr const char* name = "cylinder";
  Number diameter, height;

  static void parameters(auto& part, auto&& visit) {
    visit(positive_length("diameter", "inner diameter"), part.diameter);
    visit(positive_length("height", "inner height"), part.height);
  }
  CylinderVessel<Number> vessel() const { return {diameter / 2, height / 2}; }
};

/// Walls 0 to 5 are at x = -a, x = +a, y = -b, y = +b, z = -c, z = +c; all gaps are lengths [m].
template <class Real> struct BoxVessel {
  using Scalar = Real;
  template <class Value> using PerWall = std::array<Value, 6>;
  template <class Value> using PerKind = std::array<Value, 3>;

  Vec3<Real> half{Real(0), Real(0), Real(0)};  ///< a, b, c: half of the edges [m]

  template <class To> BoxVessel<To> cast() const { return {vector_cast<To>(half)}; }

  static constexpr int wall_count() { return 6; }
  static std::vector<WallInfo> walls() {
    return {{"wall -x", "the wall at -x"}, {"wall +x", "the wall at +x"},
        {"wall -y", "the wall at -y"}, {"wall +y", "the wall at +y"}, {"wall -z", "the wall at -z"},
        {"wall +z", "the wall at +z"}};
  }

  std::vector<WallSurface<Real>> surfaces() const { return box_surfaces<Real>(half); }

  Real reach() const { return norm<Real>(half); }
  Real extent() const { return half[0] + half[1] + half[2]; }
  Vec3<Real> half_sizes() const { return half; }
  Real volume() const { return 8 * half[0] * half[1] * half[2]; }
  Real widest_ball() const { return 2 * half.minCoeff(); }

  BoxVessel inset(const Real& by) const { return {{half[0] - by, half[1] - by, half[2] - by}}; }
  bool is_empty() const { return !(half[0] > 0 && half[1] > 0 && half[2] > 0); }
  bool contains(const Vec3<Real>& p) const {
    bool inside = true;
    for (int axis = 0; axis < 3; ++axis) inside &= p[axis] <= half[axis] && p[axis] >= -half[axis];
    return inside;
  }

  PerWall<Real> gaps(const Vec3<Real>& p) const {
    return {half[0] + p[0], half[0] - p[0], half[1] + p[1], half[1] - p[1], half[2] + p[2],
        half[2] - p[2]};
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
  static ErrorBounds<Real> curved_errors(int, const ErrorBounds<Real>& coordinate, const Real&,
      const Real&, const Real&, const Real&) {
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
template <class Number> struct Box {
  static constexpr const char* name = "box";
  std::array<Number, 3> size;

  static void parameters(auto& part, auto&& visit) {
    visit(positive_length("size", "inner sizes along x, y, z"), part.size);
  }
  BoxVessel<Number> vessel() const { return {{size[0] / 2, size[1] / 2, size[2] / 2}}; }
};

/// One wall, whose gap is q = (R_v-R)^2 - x^2 - y^2 - z^2 [m^2], smooth in the centre.
template <class Real> struct SphereVessel {
  using Scalar = Real;
  template <class Value> using PerWall = std::array<Value, 1>;
  template <class Value> using PerKind = std::array<Value, 1>;

  Real radius{0};  ///< R_v [m]

  template <class To> SphereVessel<To> cast() const { return {static_cast<To>(radius)}; }

  static constexpr int wall_count() { return 1; }
  static std::vector<WallInfo> walls() { return {{"sphere", "the sphere"}}; }
  std::vector<WallSurface<Real>> surfaces() const {
    return {Zone<Real>{{frame_at<Real>(Vec3<Real>::Zero())}, radius, -radius, radius}};
  }

  Real reach() const { return radius; }
  Real extent() const { return radius; }
  Vec3<Real> half_sizes() const { return {radius, radius, radius}; }
  Real volume() const { return 4 * numerics::pi<Real>() * radius * radius * radius / 3; }
  Real widest_ball() const { return 2 * radius; }

  SphereVessel inset(const Real& by) const { return {radius - by}; }
  bool is_empty() const { return !(radius > 0); }
  bool contains(const Vec3<Real>& p) const {
    return !is_empty() && squared_norm<Real>(p) <= radius * radius;
  }
  std::optional<Vec3<Real>> place(const Vec3<Real>& drawn) const {
    if (squared_norm<Real>(drawn) > 1) return std::nullopt;
    return Vec3<Real>(drawn * radius);
  }

  PerWall<Real> gaps(const Vec3<Real>& p) const { return {gap(0, p)}; }
  Real gap(int, const Vec3<Real>& p) const { return radius * radius - squared_norm<Real>(p); }
  static PerWall<Real> rates(const Vec3<Real>& p, const Vec3<Real>& u) {
    return {-2 * dot<Real>(p, u)};
  }
  static PerWall<Real> curvatures(const Vec3<Real>& p, const Vec3<Real>& u, const Vec3<Real>& a) {
    return {-2 * (squared_norm<Real>(u) + dot<Real>(p, a))};
  }
  PerWall<bool> within(const Vec3<Real>& p, const Real& way) const {
    const Real side = radius - way;
    return {!((side > 0) & (squared_norm<Real>(p) < side * side))};
  }

  static constexpr int kind_of(int) { return 0; }
  static PerKind<Real> derivative_bounds(const CoordinateBounds<Real>& c, int k) {
    return {product_bound(c.x, 0, c.x, k) + product_bound(c.y, 0, c.y, k) +
        product_bound(c.z, 0, c.z, k)};
  }
  static constexpr bool is_flat(int) { return false; }
  /// A sum of three squares; by Cauchy's inequality its terms are together at most sqrt(3) R.
  ErrorBounds<Real> curved_errors(int, const ErrorBounds<Real>& y, const Real& u, const Real& v,
      const Real& a, const Real& beyond) const {
    const Real R = radius + beyond;
    return {4 * R * y.value + 5 * u * R * R, 4 * R * y.rate + 4 * v * y.value + 8 * u * R * v,
        8 * v * y.rate + 5 * R * y.second + 5 * a * y.value + 14 * u * (v * v + R * a)};
  }

  Vec3<Real> normal(int, const Vec3<Real>& p) const { return p * Real(-1 / norm<Real>(p)); }
  Real overlap(int, const Vec3<Real>& p) const { return norm<Real>(p) - radius; }
};

/// [vessel] type = "sphere".
template <class Number> struct Sphere {
  static constexpr const char* name = "sphere";
  Number diameter;

  static void parameters(auto& part, auto&& visit) {
    visit(positive_length("diameter", "inner diameter"), part.diameter);
  }
  SphereVessel<Number> vessel() const { return {diameter / 2}; }
};

}  // namespace edmill::model
