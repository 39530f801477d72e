// A sphere about the origin of the vessel frame.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "base/trigonometry.hpp"
#include "model/parts/parameter.hpp"
#include "model/parts/partners.hpp"
#include "model/parts/surface.hpp"
#include "model/parts/vessel_frame.hpp"

namespace edmill::model {

/// One wall, whose gap is q = (R_v-R)^2 - x^2 - y^2 - z^2 [m^2], smooth in the centre.
template <class Real>
struct SphereVessel {
  using Scalar = Real;
  template <class Value>
  using PerWall = std::array<Value, 1>;
  template <class Value>
  using PerKind = std::array<Value, 1>;

  Real radius{0};  ///< R_v [m]

  template <class To>
  SphereVessel<To> cast() const {
    return {static_cast<To>(radius)};
  }

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
  bool contains(const Vec3<Real>& p) const { return !is_empty() && squared_norm<Real>(p) <= radius * radius; }
  std::optional<Vec3<Real>> place(const Vec3<Real>& drawn) const {
    if (squared_norm<Real>(drawn) > 1) return std::nullopt;
    return Vec3<Real>(drawn * radius);
  }

  PerWall<Real> gaps(const Vec3<Real>& p) const { return {gap(0, p)}; }
  Real gap(int, const Vec3<Real>& p) const { return radius * radius - squared_norm<Real>(p); }
  static PerWall<Real> rates(const Vec3<Real>& p, const Vec3<Real>& u) { return {-2 * dot<Real>(p, u)}; }
  static PerWall<Real> curvatures(const Vec3<Real>& p, const Vec3<Real>& u, const Vec3<Real>& a) {
    return {-2 * (squared_norm<Real>(u) + dot<Real>(p, a))};
  }
  PerWall<bool> within(const Vec3<Real>& p, const Real& way) const {
    const Real side = radius - way;
    return {!((side > 0) & (squared_norm<Real>(p) < side * side))};
  }

  static constexpr int kind_of(int) { return 0; }
  static PerKind<Real> derivative_bounds(const CoordinateBounds<Real>& c, int k) {
    return {product_bound(c.x, 0, c.x, k) + product_bound(c.y, 0, c.y, k) + product_bound(c.z, 0, c.z, k)};
  }
  static constexpr bool is_flat(int) { return false; }
  /// The gap is a sum of three squares; by Cauchy's inequality its terms are together at most sqrt(3) R.
  ErrorBounds<Real> curved_errors(int, const ErrorBounds<Real>& coordinate, const Real& u,
                                  const Real& frame_speed, const Real& acceleration,
                                  const Real& beyond) const {
    const auto& y = coordinate;
    const Real R = radius + beyond;
    return {4 * R * y.value + 5 * u * R * R,
            4 * R * y.rate + 4 * frame_speed * y.value + 8 * u * R * frame_speed,
            8 * frame_speed * y.rate + 5 * R * y.second + 5 * acceleration * y.value +
                14 * u * (frame_speed * frame_speed + R * acceleration)};
  }

  Vec3<Real> normal(int, const Vec3<Real>& p) const { return p * Real(-1 / norm<Real>(p)); }
  Real overlap(int, const Vec3<Real>& p) const { return norm<Real>(p) - radius; }
};

/// [vessel] type = "sphere".
template <class Number>
struct Sphere {
  static constexpr const char* name = "sphere";
  Number diameter;

  static void parameters(auto& part, auto&& visit) {
    visit(Parameter{"diameter", Dimension::length, "inner diameter", Range::positive}, part.diameter);
  }
  SphereVessel<Number> vessel() const { return {diameter / 2}; }
};

}  // namespace edmill::model
