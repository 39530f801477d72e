// Vessels whose ends are rounded: the points within a distance of a disc, a segment or a cylinder.
#pragma once

#include <array>
#include <boost/container/static_vector.hpp>
#include <cmath>
#include <optional>
#include <vector>

#include "base/scalar.hpp"
#include "base/trigonometry.hpp"
#include "model/parts/parameter.hpp"
#include "model/parts/partners.hpp"
#include "model/parts/surface.hpp"
#include "model/parts/vessel_frame.hpp"

namespace edmill::model {

/// All points within `rounding` of a core: a cylinder about y of radius a and half height b, or a segment if
/// a is zero. The surface is smooth, but each gap function belongs to one wall, and is valid in the region of
/// the points whose nearest point of the core is on the corresponding part. A search considers the walls of
/// the region that the ball is in, and the borders of the region, which are functions after those of the
/// walls. A border is a little beyond the plane or cylinder between two regions, where the two gap functions
/// differ by less than their rounding: a ball that crosses it is well inside the next region. theory.md,
/// section 2
template <class Real>
class RoundedVessel {
 public:
  using Scalar = Real;
  static constexpr std::size_t most_functions = 11;
  template <class Value>
  using PerWall = boost::container::static_vector<Value, most_functions>;
  template <class Value>
  using PerKind = PerWall<Value>;

  RoundedVessel() = default;
  /// @param core_radius  a [m], 0 for a capsule
  /// @param core_half    b [m]
  /// @param edge_radius  rounding [m]
  RoundedVessel(const Real& core_radius, const Real& core_half, const Real& edge_radius)
      : a_(core_radius), b_(core_half), rounding_(edge_radius) {
    using std::sqrt;
    // The square of the slack is far below the rounding of a gap.
    slack_ = sqrt(epsilon<Real>()) * (a_ + b_ + rounding_) / 64;
  }
  template <class To>
  RoundedVessel<To> cast() const {
    RoundedVessel<To> to(static_cast<To>(a_), static_cast<To>(b_), static_cast<To>(rounding_));
    return is_sharp_ ? to.sharp(To(0)) : to;
  }

  const Real& core_radius() const { return a_; }
  const Real& core_half() const { return b_; }
  const Real& rounding() const { return rounding_; }

  int wall_count() const { return a_ > 0 ? 5 : 3; }
  int function_count() const { return a_ > 0 ? 11 : 7; }
  std::vector<WallInfo> walls() const {
    if (!(a_ > 0))
      return {{"end -y", "the end at -y"}, {"end +y", "the end at +y"}, {"cylinder", "the cylinder"}};
    return {{"edge -y", "the edge at -y"},
            {"edge +y", "the edge at +y"},
            {"cylinder", "the cylinder"},
            {"cap -y", "the cap at -y"},
            {"cap +y", "the cap at +y"}};
  }
  std::vector<WallSurface<Real>> surfaces() const {
    const Vec3<Real> top{Real(0), b_, Real(0)}, end{Real(0), Real(b_ + rounding_), Real(0)};
    const Vec3<Real> zero = Vec3<Real>::Zero();
    const Frame<Real> up = frame_at<Real>(top);
    const Frame<Real> down{-top, Vec3<Real>::UnitX(), -Vec3<Real>::UnitY(), -Vec3<Real>::UnitZ()};
    const Tube<Real> tube{{frame_at<Real>(zero)}, a_ + rounding_, b_};
    if (!(a_ > 0))
      return {Zone<Real>{{down}, rounding_, Real(0), rounding_},
              Zone<Real>{{up}, rounding_, Real(0), rounding_}, tube};
    return {Edge<Real>{{down}, a_, rounding_}, Edge<Real>{{up}, a_, rounding_}, tube,
            Disc<Real>{{frame_at<Real>(-end)}, a_}, Disc<Real>{{frame_at<Real>(end)}, a_}};
  }

  Real reach() const {
    using std::sqrt;
    return (sqrt(a_ * a_ + b_ * b_) + rounding_) * (1 + rounding_margin<Real>());
  }
  Real extent() const { return a_ + b_ + rounding_; }
  Vec3<Real> half_sizes() const { return {a_ + rounding_, b_ + rounding_, a_ + rounding_}; }
  /// The volumes of the core, of the layers on its caps and around it, and of the quarter of a torus on each
  /// edge. (Steiner)
  Real volume() const {
    const Real pi = numerics::pi<Real>(), r = rounding_;
    return 2 * pi * (a_ + r) * (a_ + r) * b_ + 2 * pi * a_ * a_ * r + pi * pi * a_ * r * r +
           4 * pi * r * r * r / 3;
  }
  Real widest_ball() const { return 2 * (a_ < b_ ? Real(a_ + rounding_) : Real(b_ + rounding_)); }

  /// A ball no smaller than the rounding touches the caps and the cylinder only: the region of its centre is
  /// a cylinder with sharp edges.
  RoundedVessel inset(const Real& by) const {
    if (is_sharp_ || !(by < rounding_)) return sharp(by);
    RoundedVessel smaller(*this);
    smaller.rounding_ -= by;
    return smaller;
  }
  bool is_empty() const { return is_sharp_ ? !(a_ > 0 && b_ > 0) : !(rounding_ > 0); }
  bool contains(const Vec3<Real>& p) const {
    if (is_empty()) return false;
    const Vec3<Real> d = from_core(p);
    return squared_norm<Real>(d) <= rounding_ * rounding_;
  }

  PerWall<Real> gaps(const Vec3<Real>& p) const {
    const Real square = p[0] * p[0] + p[2] * p[2], around = radial(square) - a_;
    PerWall<Real> all;
    for (int f = 0; f < function_count(); ++f) all.push_back(gap_at(f, p[1], square, around));
    return all;
  }
  Real gap(int f, const Vec3<Real>& p) const {
    const Real square = p[0] * p[0] + p[2] * p[2];
    return gap_at(f, p[1], square, f < 2 ? Real(radial(square) - a_) : Real(0));
  }
  PerWall<Real> rates(const Vec3<Real>& p, const Vec3<Real>& u) const {
    const Real square = p[0] * p[0] + p[2] * p[2], moved = p[0] * u[0] + p[2] * u[2];
    const Real r = radial(square), around = r - a_, outwards = r > 0 ? Real(moved / r) : Real(0);
    PerWall<Real> all;
    for (int f = 0; f < function_count(); ++f) {
      if (f < 2) {
        const Real side(f == 0 ? -1 : 1), above = side * p[1] - b_;
        all.push_back(-2 * ((a_ > 0 ? Real(around * outwards) : moved) + above * (side * u[1])));
      } else {
        const int along = along_y(f), across = across_y(f);
        all.push_back(along != 0 ? Real(along * u[1]) : Real(across * 2 * moved));
      }
    }
    return all;
  }
  PerWall<Real> curvatures(const Vec3<Real>& p, const Vec3<Real>& u, const Vec3<Real>& a) const {
    const Real square = p[0] * p[0] + p[2] * p[2], moved = p[0] * u[0] + p[2] * u[2];
    const Real bent = (u[0] * u[0] + p[0] * a[0]) + (u[2] * u[2] + p[2] * a[2]);
    const Real r = radial(square), around = r - a_;
    const Real rate = r > 0 ? Real(moved / r) : Real(0),
               second = r > 0 ? Real((bent - rate * rate) / r) : Real(0);
    PerWall<Real> all;
    for (int f = 0; f < function_count(); ++f) {
      if (f < 2) {
        const Real side(f == 0 ? -1 : 1), above = side * p[1] - b_;
        const Real radially = a_ > 0 ? Real(rate * rate + around * second) : bent;
        all.push_back(-2 * (radially + (u[1] * u[1] + above * (side * a[1]))));
      } else {
        const int along = along_y(f), across = across_y(f);
        all.push_back(along != 0 ? Real(along * a[1]) : Real(across * 2 * bent));
      }
    }
    return all;
  }

  /// The walls and borders of the region of p.
  PerWall<bool> active(const Vec3<Real>& p) const {
    PerWall<bool> on(static_cast<std::size_t>(function_count()), false);
    const std::size_t border = static_cast<std::size_t>(wall_count());
    if (is_sharp_) {
      on[2] = on[3] = on[4] = true;
      return on;
    }
    const bool above = p[1] > b_, below = p[1] < -b_;
    const bool outer = !(a_ > 0) || p[0] * p[0] + p[2] * p[2] > a_ * a_;
    on[0] = below && outer;
    on[1] = above && outer;
    on[2] = !above && !below && outer;
    on[border] = on[border + 1] = !above && !below;
    on[border + 2] = above;
    on[border + 3] = below;
    if (a_ > 0) {
      on[3] = below && !outer;
      on[4] = above && !outer;
      on[border + 4] = !outer;
      on[border + 5] = outer;
    }
    return on;
  }
  /// True if the gap function of this wall is valid at p, to within its rounding.
  bool is_valid(int wall, const Vec3<Real>& p) const {
    if (is_sharp_) return true;
    const std::size_t border = static_cast<std::size_t>(wall_count());
    for (std::size_t f = border; f < static_cast<std::size_t>(function_count()); ++f)
      if (bounds_region(f - border, wall) && gap(static_cast<int>(f), p) < 0) return false;
    return true;
  }
  /// How far a ball at p may move while the gaps of its region are smooth [m]; empty if there is no limit.
  /// The gap of an edge is not smooth near the axis.
  std::optional<Real> smooth_way(const Vec3<Real>& p) const {
    using std::sqrt;
    if (is_sharp_ || !(a_ > 0) || !(p[1] > b_ || p[1] < -b_)) return std::nullopt;
    const Real r = sqrt(p[0] * p[0] + p[2] * p[2]);
    if (!(r > a_)) return std::nullopt;
    return Real(r - a_ / 2);
  }
  PerWall<bool> within(const Vec3<Real>& p, const Real& way) const {
    auto near = active(p);
    const Real y = magnitude(p[1]);
    const std::size_t border = static_cast<std::size_t>(wall_count());
    // Far inside: all of the surface is farther away than `way`.
    const Vec3<Real> d = from_core(p);
    const Real room = rounding_ - way;
    const bool far = !is_sharp_ && room > 0 && squared_norm<Real>(d) < room * room;
    for (std::size_t f = 0; f < border; ++f) near[f] = near[f] && !far;
    const Real to_plane = y < b_ ? Real(b_ - y) : Real(y - b_);
    for (std::size_t f = border; f < border + 4; ++f) near[f] = near[f] && !(to_plane > way);
    return near;
  }

  static int kind_of(int f) { return f; }
  PerKind<Real> derivative_bounds(const CoordinateBounds<Real>& c, int k) const {
    const Real square = product_bound(c.x, 0, c.x, k) + product_bound(c.z, 0, c.z, k);
    const Real on_edge = edge_bound(c, k);
    PerKind<Real> bounds;
    for (int f = 0; f < function_count(); ++f)
      bounds.push_back(f < 2 ? on_edge : along_y(f) != 0 ? c.y[k] : square);
    return bounds;
  }
  bool is_flat(int f) const { return f >= 2 && along_y(f) != 0; }
  ErrorBounds<Real> curved_errors(int f, const ErrorBounds<Real>& coordinate, const Real& u,
                                  const Real& frame_speed, const Real& acceleration,
                                  const Real& beyond) const {
    const auto& y = coordinate;
    const Real &v = frame_speed, R = a_ + rounding_ + beyond;
    if (f >= 2)  // a squared distance from the axis
    {
      auto errors = squared_distance_errors(y, u, v, acceleration, Real(R));
      errors.value += 4 * slack_ * slack_;
      return errors;
    }
    // The distance r from the axis, which is at least a/2, and its derivatives.
    const Real inverse = a_ > 0 ? Real(2 / a_) : Real(0);
    const Real bend = acceleration + v * v * inverse;
    const auto [r0, r1, r2] = distance_errors(y, u, v, acceleration, R, inverse);
    const Real far = rounding_ + beyond + a_ / 2;
    return {4 * far * (r0 + y.value) + 8 * u * far * far + 4 * slack_ * slack_,
            3 * (far * (r1 + y.rate) + v * (r0 + y.value)) + 12 * u * far * v,
            6 * v * (r1 + y.rate) + 3 * (far * (r2 + y.second) + bend * r0 + acceleration * y.value) +
                24 * u * (v * v + far * bend)};
  }

  /// Computed from the true distance, so that the normal does not depend on the gap function that found the
  /// contact.
  Vec3<Real> normal(int wall, const Vec3<Real>& p) const {
    if (is_sharp_ && is_cap(wall)) return {Real(0), Real(wall == 3 ? 1 : -1), Real(0)};
    Vec3<Real> d = is_sharp_ ? Vec3<Real>(p[0], Real(0), p[2]) : from_core(p);
    if (!(squared_norm<Real>(d) > 0)) d = {Real(0), Real(p[1] < 0 ? -1 : 1), Real(0)};  // in the core
    return d * Real(-1 / norm<Real>(d));
  }
  Real overlap(int wall, const Vec3<Real>& p) const {
    using std::sqrt;
    if (!is_sharp_) return norm<Real>(from_core(p)) - rounding_;
    if (is_cap(wall)) return (wall == 3 ? Real(-p[1]) : p[1]) - b_;
    return sqrt(p[0] * p[0] + p[2] * p[2]) - a_;
  }

 private:
  template <class>
  friend class RoundedVessel;

  /// @param square  x^2 + z^2
  /// @param around  r - a, of the edges
  Real gap_at(int f, const Real& y, const Real& square, const Real& around) const {
    if (f < 2) {
      const Real above = (f == 0 ? Real(-y) : y) - b_;
      return rounding_ * rounding_ - ((a_ > 0 ? Real(around * around) : square) + above * above);
    }
    if (f == 2) return (a_ + rounding_) * (a_ + rounding_) - square;
    if (is_cap(f)) return b_ + rounding_ + (f == 3 ? y : Real(-y));
    const int border = f - wall_count();
    if (border < 2) return b_ + slack_ + (border == 0 ? Real(-y) : y);
    if (border < 4) return (border == 2 ? y : Real(-y)) - b_ + slack_;
    return border == 4 ? Real((a_ + slack_) * (a_ + slack_) - square)
                       : Real(square - (a_ - slack_) * (a_ - slack_));
  }
  RoundedVessel sharp(const Real& by) const {
    RoundedVessel smaller(*this);
    smaller.is_sharp_ = true;
    smaller.a_ += rounding_ - by;
    smaller.b_ += rounding_ - by;
    smaller.rounding_ = Real(0);
    return smaller;
  }
  bool is_cap(int f) const { return a_ > 0 && (f == 3 || f == 4); }
  /// Sign of the derivative of a function of y alone, otherwise 0; `across_y` is the sign of a function of
  /// the distance from the axis.
  int along_y(int f) const {
    if (is_cap(f)) return f == 3 ? 1 : -1;
    constexpr std::array signs{-1, 1, 1, -1, 0, 0};
    return f < wall_count() ? 0 : signs[f - wall_count()];
  }
  int across_y(int f) const { return f == 2 || f == wall_count() + 4 ? -1 : 1; }
  /// True if the border bounds the region of the wall.
  static bool bounds_region(std::size_t border, int wall) {
    constexpr std::array<std::array<bool, 6>, 5> of = {{{false, false, false, true, false, true},
                                                        {false, false, true, false, false, true},
                                                        {true, true, false, false, false, true},
                                                        {false, false, false, true, true, false},
                                                        {false, false, true, false, true, false}}};
    return of[wall][border];
  }
  Real radial(const Real& square) const {
    using std::sqrt;
    return a_ > 0 ? Real(sqrt(square)) : Real(0);
  }
  /// Vector from the nearest point of the core to p.
  Vec3<Real> from_core(const Vec3<Real>& p) const {
    using std::sqrt;
    const Real y = p[1] > b_ ? Real(p[1] - b_) : p[1] < -b_ ? Real(p[1] + b_) : Real(0);
    if (!(a_ > 0)) return {p[0], y, p[2]};
    const Real r = sqrt(p[0] * p[0] + p[2] * p[2]);
    if (!(r > a_)) return {Real(0), y, Real(0)};
    const Real rest = 1 - a_ / r;
    return {p[0] * rest, y, p[2] * rest};
  }
  /// Bound on the k-th derivative of r^2 - 2 a r + a^2 + (y - b)^2, where r >= a/2. The derivatives of r
  /// follow from those of its square.
  Real edge_bound(const CoordinateBounds<Real>& c, int k) const {
    const Real drift = c.x[0] - (a_ + rounding_);
    Majorant<Real> y = c.y;
    y[0] = rounding_ + (c.y[0] - (b_ + rounding_));
    if (!(a_ > 0))
      return product_bound(c.x, 0, c.x, k) + product_bound(c.z, 0, c.z, k) + product_bound(y, 0, y, k);
    const auto r = distance_bound(c, Real((a_ > rounding_ ? a_ : rounding_) + drift), Real(a_ * 49 / 100), k);
    return product_bound(r, 0, r, k) + product_bound(y, 0, y, k);
  }

  Real a_{0}, b_{0}, rounding_{0}, slack_{0};
  bool is_sharp_ = false;
};

/// [vessel] type = "capsule": a cylinder with hemispherical ends; the height is over all.
/// Source of the shape: Takacs and McHenry, J. Mater. Sci. 41 (2006) 5246.
template <class Number>
struct Capsule {
  static constexpr const char* name = "capsule";
  Number diameter, height;

  static void parameters(auto& part, auto&& visit) {
    visit(Parameter{"diameter", Dimension::length, "inner diameter", Range::positive}, part.diameter);
    visit(Parameter{"height", Dimension::length, "inner height including the round ends", Range::positive},
          part.height);
  }
  RoundedVessel<Number> vessel() const {
    return {Number(0), Number((height - diameter) / 2), Number(diameter / 2)};
  }
};

/// [vessel] type = "rounded_cylinder": a cylinder whose edges are a quarter of a torus.
template <class Number>
struct RoundedCylinder {
  static constexpr const char* name = "rounded_cylinder";
  Number diameter, height, edge;

  static void parameters(auto& part, auto&& visit) {
    visit(Parameter{"diameter", Dimension::length, "inner diameter", Range::positive}, part.diameter);
    visit(Parameter{"height", Dimension::length, "inner height", Range::positive}, part.height);
    visit(Parameter{"edge_radius", Dimension::length, "radius of the edges of the caps", Range::positive},
          part.edge);
  }
  RoundedVessel<Number> vessel() const {
    return {Number(diameter / 2 - edge), Number(height / 2 - edge), edge};
  }
};

}  // namespace edmill::model
