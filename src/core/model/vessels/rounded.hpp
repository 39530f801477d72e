// Vessels whose ends are rounded: the points within a distance of a disc, a segment or a cylinder.
#pragma once

#include <boost/container/static_vector.hpp>
#include <optional>

#include "model/parts/parameter.hpp"
#include "model/parts/partners.hpp"
#include "model/parts/surface.hpp"

namespace edmill::model {

/// All points within `rounding` of a core: a cylinder about y of radius a and half height b, or a
/// segment if a is zero. The surface is smooth, but each gap function belongs to one wall, and is
/// valid in the region of the points whose nearest point of the core is on the corresponding part.
/// A search considers the walls and the borders of the ball's region. A border is a little beyond
/// the plane or cylinder between two regions, where the two gap functions differ by less than their
/// rounding: a ball that crosses it is well inside the next region. theory.md, section 2
template <class Real> class RoundedVessel {
 public:
  using Scalar = Real;
  static constexpr std::size_t most_functions = 11;
  template <class Value> using PerWall = boost::container::static_vector<Value, most_functions>;
  template <class Value> using PerKind = PerWall<Value>;

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
  template <class To> RoundedVessel<To> cast() const {
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
      return {
          {"end -y", "the end at -y"}, {"end +y", "the end at +y"}, {"cylinder", "the cylinder"}};
    return {{"edge -y", "the edge at -y"}, {"edge +y", "the edge at +y"},
        {"cylinder", "the cylinder"}, {"cap -y", "the cap at -y"}, {"cap +y", "the cap at +y"}};
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
  /// The volumes of the core, of the layers on its caps and around it, and of the quarter of a
  /// torus on each edge. (Steiner)
  Real volume() const {
    const Real pi = numerics::pi<Real>(), r = rounding_;
    return 2 * pi * (a_ + r) * (a_ + r) * b_ + 2 * pi * a_ * a_ * r + pi * pi * a_ * r * r +
        4 * pi * r * r * r / 3;
  }
  Real widest_ball() const { return 2 * (a_ < b_ ? Real(a_ + rounding_) : Real(b_ + rounding_)); }

  /// A ball no smaller than the rounding touches the caps and the cylinder only: the region of its
  /// centre is a cylinder with sharp edges.
  RoundedVessel inset(const Real& by) const {
    if (is_sharp_ || !(by < rounding_)) return sharp(by);
    RoundedVessel smaller(*this);
    smaller.rounding_ -= by;
    return smaller;
  }
  bool is_empty() const { return is_sharp_ ? !(a_ > 0 && b_ > 0) : !(rounding_ > 0); }
  bool contains(const Vec3<Real>& p) const {
    return !is_empty() && squared_norm<Real>(from_core(p)) <= rounding_ * rounding_;
  }

  PerWall<Real> gaps(const Vec3<Real>& p) const {
    const Real square = squared_across(p), around = radial(p) - a_;
    PerWall<Real> all;
    for (int f = 0; f < function_count(); ++f) all.push_back(gap_at(f, p[1], square, around));
    return all;
  }
  Real gap(int f, const Vec3<Real>& p) const {
    return gap_at(f, p[1], squared_across(p), f < 2 ? Real(radial(p) - a_) : Real(0));
  }
  PerWall<Real> rates(const Vec3<Real>& p, const Vec3<Real>& u) const {
    const Real moved = p[0] * u[0] + p[2] * u[2];
    const Real r = radial(p), around = r - a_, outwards = r > 0 ? Real(moved / r) : Real(0);
    const Real radially = a_ > 0 ? Real(around * outwards) : moved;
    return derivatives(p, u[1], moved, [&](const Real& side, const Real& above) {
      return Real(radially + above * (side * u[1]));
    });
  }
  PerWall<Real> curvatures(const Vec3<Real>& p, const Vec3<Real>& u, const Vec3<Real>& a) const {
    const Real moved = p[0] * u[0] + p[2] * u[2];
    const Real bent = (u[0] * u[0] + p[0] * a[0]) + (u[2] * u[2] + p[2] * a[2]);
    const Real r = radial(p), around = r - a_, rate = r > 0 ? Real(moved / r) : Real(0);
    const Real second = r > 0 ? Real((bent - rate * rate) / r) : Real(0);
    const Real radially = a_ > 0 ? Real(rate * rate + around * second) : bent;
    return derivatives(p, a[1], bent, [&](const Real& side, const Real& above) {
      return Real(radially + (u[1] * u[1] + above * (side * a[1])));
    });
  }

  /// The walls and borders of the region of p.
  PerWall<bool> active(const Vec3<Real>& p) const {
    PerWall<bool> on(function_count(), false);
    if (is_sharp_) {
      on[2] = on[3] = on[4] = true;
      return on;
    }
    const bool above = p[1] > b_, below = p[1] < -b_,
               outer = !(a_ > 0) || squared_across(p) > a_ * a_;
    const int region = above ? (outer ? 1 : 4) : below ? (outer ? 0 : 3) : outer ? 2 : in_core;
    if (region != in_core) on[region] = true;
    for (int f = wall_count(); f < function_count(); ++f) on[f] = bounds_region(f, region);
    return on;
  }
  /// True if the gap function of this wall is valid at p, to within its rounding.
  bool is_valid(int wall, const Vec3<Real>& p) const {
    if (is_sharp_) return true;
    for (int f = wall_count(); f < function_count(); ++f)
      if (bounds_region(f, wall) && gap(f, p) < 0) return false;
    return true;
  }
  /// The gap of an edge is not smooth near the axis.
  std::optional<Real> smooth_way(const Vec3<Real>& p) const {
    if (is_sharp_ || !(a_ > 0) || !(p[1] > b_ || p[1] < -b_)) return std::nullopt;
    const Real r = across(p);
    return r > a_ ? std::optional(Real(r - a_ / 2)) : std::nullopt;
  }
  PerWall<bool> within(const Vec3<Real>& p, const Real& way) const {
    auto near = active(p);
    // Far inside: all of the surface is farther away than `way`.
    const Real room = rounding_ - way, to_plane = magnitude<Real>(magnitude(p[1]) - b_);
    const bool far = !is_sharp_ && room > 0 && squared_norm<Real>(from_core(p)) < room * room;
    for (int f = 0; f < wall_count() + 4; ++f)
      near[f] = near[f] && !(f < wall_count() ? far : to_plane > way);
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
      const Real& frame_speed, const Real& acceleration, const Real& beyond) const {
    const auto& y = coordinate;
    const Real &v = frame_speed, &a = acceleration, R = a_ + rounding_ + beyond,
               slack = 4 * slack_ * slack_;
    if (f >= 2) {  // a squared distance from the axis
      auto errors = squared_distance_errors(y, u, v, a, R);
      errors.value += slack;
      return errors;
    }
    // The distance r from the axis, which is at least a/2, and its derivatives.
    const Real inverse = a_ > 0 ? Real(2 / a_) : Real(0), bend = a + v * v * inverse;
    const auto [r0, r1, r2] = distance_errors(y, u, v, a, R, inverse);
    const Real far = rounding_ + beyond + a_ / 2,
               turned = far * (r2 + y.second) + bend * r0 + a * y.value;
    return {4 * far * (r0 + y.value) + 8 * u * far * far + slack,
        3 * (far * (r1 + y.rate) + v * (r0 + y.value)) + 12 * u * far * v,
        6 * v * (r1 + y.rate) + 3 * turned + 24 * u * (v * v + far * bend)};
  }

  /// Computed from the true distance, so that the normal does not depend on the gap function that
  /// found the contact.
  Vec3<Real> normal(int wall, const Vec3<Real>& p) const {
    if (is_sharp_ && is_cap(wall)) return {Real(0), Real(wall == 3 ? 1 : -1), Real(0)};
    Vec3<Real> d = is_sharp_ ? Vec3<Real>(p[0], Real(0), p[2]) : from_core(p);
    if (!(squared_norm<Real>(d) > 0))
      d = {Real(0), Real(p[1] < 0 ? -1 : 1), Real(0)};  // in the core
    return d * Real(-1 / norm<Real>(d));
  }
  Real overlap(int wall, const Vec3<Real>& p) const {
    if (!is_sharp_) return norm<Real>(from_core(p)) - rounding_;
    if (is_cap(wall)) return (wall == 3 ? Real(-p[1]) : p[1]) - b_;
    return across(p) - a_;
  }
 private:
  template <class> friend class RoundedVessel;

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
  /// @param along, across  derivatives of y and of (x^2 + z^2) / 2
  /// @param of_edge        half of that of the gap of an edge, less the sign, from its side and y
  /// beyond it
  PerWall<Real> derivatives(
      const Vec3<Real>& p, const Real& along, const Real& across, const auto& of_edge) const {
    PerWall<Real> all;
    for (const Real& side : {Real(-1), Real(1)})
      all.push_back(-2 * of_edge(side, Real(side * p[1] - b_)));
    for (int f = 2; f < function_count(); ++f)
      all.push_back(along_y(f) != 0 ? Real(along_y(f) * along) : Real(across_y(f) * 2 * across));
    return all;
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
  /// Sign of the derivative of a function of y alone, otherwise 0; `across_y` is the sign of a
  /// function of the distance from the axis.
  int along_y(int f) const {
    if (is_cap(f)) return f == 3 ? 1 : -1;
    constexpr std::array signs{-1, 1, 1, -1, 0, 0};
    return f < wall_count() ? 0 : signs[f - wall_count()];
  }
  int across_y(int f) const { return f == 2 || f == wall_count() + 4 ? -1 : 1; }
  /// True if a border bounds the region of a wall, or that in the core.
  bool bounds_region(int border, int region) const {
    constexpr int of[6][6] = {{0, 0, 0, 1, 0, 1}, {0, 0, 1, 0, 0, 1}, {1, 1, 0, 0, 0, 1},
        {0, 0, 0, 1, 1, 0}, {0, 0, 1, 0, 1, 0}, {1, 1, 0, 0, 1, 0}};
    return of[region][border - wall_count()] != 0;
  }
  Real radial(const Vec3<Real>& p) const { return a_ > 0 ? across(p) : Real(0); }
  /// Vector from the nearest point of the core to p.
  Vec3<Real> from_core(const Vec3<Real>& p) const {
    const Real y = p[1] > b_ ? Real(p[1] - b_) : p[1] < -b_ ? Real(p[1] + b_) : Real(0);
    if (!(a_ > 0)) return {p[0], y, p[2]};
    const Real r = across(p);
    if (!(r > a_)) return {Real(0), y, Real(0)};
    const Real rest = 1 - a_ / r;
    return {p[0] * rest, y, p[2] * rest};
  }
  /// Bound on the k-th derivative of r^2 - 2 a r + a^2 + (y - b)^2, where r >= a/2. The derivatives
  /// of r follow from those of its square.
  Real edge_bound(const CoordinateBounds<Real>& c, int k) const {
    Majorant<Real> y = c.y;
    y[0] = rounding_ + (c.y[0] - (b_ + rounding_));
    const Real along = product_bound(y, 0, y, k);
    if (!(a_ > 0)) return product_bound(c.x, 0, c.x, k) + product_bound(c.z, 0, c.z, k) + along;
    const Real most = (a_ > rounding_ ? a_ : rounding_) + (c.x[0] - (a_ + rounding_));
    const auto r = distance_bound(c, most, Real(a_ * 49 / 100), k);
    return product_bound(r, 0, r, k) + along;
  }

  static constexpr int in_core = 5;  ///< the number of the region without a wall
  Real a_{0}, b_{0}, rounding_{0}, slack_{0};
  bool is_sharp_ = false;
};

/// [vessel] type = "capsule": a cylinder with hemispherical ends; the height is over all.
/// Source of the shape: Takacs and McHenry, J. Mater. Sci. 41 (2006) 5246.
template <class Number> struct Capsule {
  static constexpr const char* name = "capsule";
  Number diameter, height;

  static void parameters(auto& part, auto&& visit) {
    visit(positive_length("diameter", "inner diameter"), part.diameter);
    visit(positive_length("height", "inner height including the round ends"), part.height);
  }
  RoundedVessel<Number> vessel() const {
    return {Number(0), Number((height - diameter) / 2), Number(diameter / 2)};
  }
};

/// [vessel] type = "rounded_cylinder": a cylinder whose edges are a quarter of a torus.
template <class Number> struct RoundedCylinder {
  static constexpr const char* name = "rounded_cylinder";
  Number diameter, height, edge;

  static void parameters(auto& part, auto&& visit) {
    visit(positive_length("diameter", "inner diameter"), part.diameter);
    visit(positive_length("height", "inner height"), part.height);
    visit(positive_length("edge_radius", "radius of the edges of the caps"), part.edge);
  }
  RoundedVessel<Number> vessel() const {
    return {Number(diameter / 2 - edge), Number(height / 2 - edge), edge};
  }
};

}  // namespace edmill::model
