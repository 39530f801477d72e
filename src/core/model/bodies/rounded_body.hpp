// Convex bodies inside the vessel: boxes and cylinders whose edges may be rounded, seen from
// outside.
#pragma once

#include <algorithm>
#include <optional>
#include <utility>

#include "model/parts/partners.hpp"
#include "model/parts/surface.hpp"

namespace edmill::model {

/// All points within `rounding` of a core: a box, or a cylinder about y, whose half edges may be
/// zero. The space around the body is a vessel (vessel.hpp) with one wall: its gap is |u|^2 -
/// (rounding + R)^2, with the vector u from the nearest point of the core to the ball's centre. It
/// is smooth in the region of the points with the same coordinates outside of the core's: `enter`
/// chooses the region of a ball, and the functions after the gap are its borders, a little beyond
/// its ends, as in RoundedVessel. theory.md, section
/// 2
template <class Real> class RoundedBody {
 public:
  using Scalar = Real;
  static constexpr std::size_t functions = 7;
  template <class Value> using PerWall = std::array<Value, functions>;
  template <class Value> using PerKind = std::array<Value, functions + 2>;

  RoundedBody() = default;
  /// @param is_round  whether the core is a cylinder of radius half[0] = half[2] > 0 about y
  /// @param half, rounding  half edges of the core [m], [m]
  RoundedBody(bool is_round, const Vec3<Real>& half, const Real& rounding)
      : is_round_(is_round), half_(half), rounding_(rounding), distance_(rounding) {}
  template <class To> RoundedBody<To> cast() const {
    RoundedBody<To> to(is_round_, vector_cast<To>(half_), static_cast<To>(rounding_));
    return to.among(
        static_cast<To>(largest_ball_), static_cast<To>(domain_ * (1 + rounding_margin<Real>())));
  }
  /// The body with bounds for the balls of a case: the largest radius [m], and a distance from the
  /// body's origin that no ball's centre exceeds [m].
  RoundedBody among(const Real& largest_ball, const Real& domain) const {
    using std::sqrt;
    RoundedBody body(*this);
    body.largest_ball_ = largest_ball;
    body.domain_ = domain;
    // The square of the slack is far below the rounding of a gap.
    body.slack_ = sqrt(epsilon<Real>()) * (rounding_ + largest_ball) / 64;
    return body;
  }

  bool is_round() const { return is_round_; }
  const Vec3<Real>& half() const { return half_; }
  const Real& rounding() const { return rounding_; }
  /// An upper bound on the distance of the body's points from its origin [m].
  Real size() const {
    return (is_round_ ? half_[0] : Real(half_[0] + half_[2])) + half_[1] + rounding_;
  }
  /// The volume, by Steiner's formula [m3].
  Real solid_volume() const {
    const Real pi = numerics::pi<Real>(), r = rounding_;
    const Real &a = half_[0], &b = half_[1], &c = half_[2], ball = 4 * pi * r * r * r / 3;
    if (is_round_)
      return 2 * pi * (a + r) * (a + r) * b + 2 * pi * a * a * r + pi * pi * a * r * r + ball;
    return 8 * (a * b * c + r * (a * b + b * c + c * a)) + 2 * pi * r * r * (a + b + c) + ball;
  }

  /// The area of the surface: the derivative of the volume with respect to the rounding [m2].
  Real area() const {
    const Real pi = numerics::pi<Real>(), r = rounding_;
    const Real &a = half_[0], &b = half_[1], &c = half_[2], ball = 4 * pi * r * r;
    if (is_round_) return 4 * pi * (a + r) * b + 2 * pi * a * a + 2 * pi * pi * a * r + ball;
    return 8 * (a * b + b * c + c * a) + 4 * pi * r * (a + b + c) + ball;
  }

  /// The region of p becomes that of the functions. @return its number
  int enter(const Vec3<Real>& p) {
    outside_ = {side(0, p), side(1, p), side(2, p)};
    if (is_round_) outside_ = {squared_across(p) > half_[0] * half_[0], outside_[1], 0};
    return 9 * outside_[0] + 3 * outside_[1] + outside_[2];
  }

  // As a vessel.
  static int wall_count() { return 1; }
  static int function_count() { return static_cast<int>(functions); }
  static std::vector<WallInfo> walls() { return {{"body", "the body"}}; }
  /// A box has the faces x-, x+, y-, y+, z-, z+ and all of its rounded edges; a cylinder has the
  /// lower and the upper edge, the side, the lower and the upper end. Parts may have no area.
  std::vector<WallSurface<Real>> surfaces() const {
    const Real &a = half_[0], &b = half_[1], &c = half_[2], &r = rounding_;
    if (!is_round_) {
      auto faces = box_surfaces<Real>(half_);
      for (std::size_t k = 0; k < faces.size(); ++k) {
        auto face = std::get<Rectangle<Real>>(faces[k].kind());
        face.centre[static_cast<int>(k / 2)] += k % 2 == 0 ? Real(-r) : r;
        faces[k] = face;
      }
      const Real flat = 8 * (a * b + b * c + c * a), rest = area() - flat;
      faces.emplace_back(Patch<Real>{r > 0 ? rest : Real(0)});
      return faces;
    }
    const Vec3<Real> top{Real(0), b, Real(0)}, end{Real(0), Real(b + r), Real(0)};
    const auto middle = frame_at<Real>(Vec3<Real>::Zero());
    const auto at = [&](const Vec3<Real>& place, int up) {
      return Frame<Real>{place * Real(up), middle.x, middle.y * Real(up), middle.z * Real(up)};
    };
    return {Edge<Real>{{at(top, -1)}, a, r}, Edge<Real>{{at(top, 1)}, a, r},
        Tube<Real>{{middle}, Real(a + r), b}, Disc<Real>{{at(end, -1)}, a},
        Disc<Real>{{at(end, 1)}, a}};
  }
  /// The number among `surfaces()` of the part that a ball at p touches; a sharp edge belongs to
  /// the part that the ball is farther beyond.
  std::size_t part_at(const Vec3<Real>& p) const {
    const Vec3<Real> d = from_core(p);
    const auto beyond = [&](int i) { return i == 0 && is_round_ ? across(d) : magnitude(d[i]); };
    const int axes = is_round_ ? 2 : 3;
    int first = 0, outside = 0;
    for (int i = 0; i < axes; ++i) {
      outside += beyond(i) > 0 ? 1 : 0;
      if (beyond(i) > beyond(first)) first = i;
    }
    const std::size_t up = d[1] > 0 ? 1 : 0;
    // A part without area is a line or a point of the rounded edges.
    const bool has_area = is_round_ ? first != 0 || half_[1] > 0
                                    : half_[(first + 1) % 3] * half_[(first + 2) % 3] > 0;
    const bool on_edge = rounding_ > 0 && (outside > 1 || !has_area);
    if (is_round_) return on_edge ? up : first == 0 ? 2 : 3 + up;
    return on_edge ? 6 : static_cast<std::size_t>(2 * first + (d[first] > 0 ? 1 : 0));
  }
  Real reach() const { return domain_; }
  Real extent() const { return domain_; }
  Vec3<Real> half_sizes() const { return {domain_, domain_, domain_}; }
  Real volume() const { return 4 * domain_ * domain_ * domain_ - solid_volume(); }
  Real widest_ball() const { return domain_; }
  RoundedBody inset(const Real& by) const {
    RoundedBody larger(*this);
    larger.distance_ = rounding_ + by;
    return larger;
  }
  static bool is_empty() { return false; }
  bool contains(const Vec3<Real>& p) const {
    return squared_norm<Real>(from_core(p)) >= distance_ * distance_;
  }

  PerWall<Real> gaps(const Vec3<Real>& p) const {
    PerWall<Real> all;
    for (int f = 0; f < function_count(); ++f) all[f] = gap(f, p);
    return all;
  }
  Real gap(int f, const Vec3<Real>& p) const {
    if (f > 0) return border(f, p);
    if (is_side()) {  // without the root
      const Real far = half_[0] + distance_;
      return squared_across(p) - far * far;
    }
    Real sum(0);
    for (int i = 0; i < 3; ++i)
      if (counts(i)) {
        const Real u = excess(i, p);
        sum += u * u;
      }
    return sum - distance_ * distance_;
  }
  PerWall<Real> rates(const Vec3<Real>& p, const Vec3<Real>& v) const {
    const Real moved = p[0] * v[0] + p[2] * v[2];
    if (is_side()) return derivatives(moved, moved, v);
    Real sum(0);
    for (int i = 0; i < 3; ++i)
      if (counts(i)) sum += excess(i, p) * excess_rate(i, p, v);
    return derivatives(sum, moved, v);
  }
  PerWall<Real> curvatures(const Vec3<Real>& p, const Vec3<Real>& v, const Vec3<Real>& a) const {
    const Real bent = (v[0] * v[0] + p[0] * a[0]) + (v[2] * v[2] + p[2] * a[2]);
    if (is_side()) return derivatives(bent, bent, a);
    Real sum(0);
    for (int i = 0; i < 3; ++i)
      if (counts(i)) {
        const Real rate = excess_rate(i, p, v);
        Real second = outside_[i] < 0 ? Real(-a[i]) : a[i];
        if (is_round_ && i == 0) second = (bent - rate * rate) / across(p);
        sum += rate * rate + excess(i, p) * second;
      }
    return derivatives(sum, bent, a);
  }

  PerWall<bool> active(const Vec3<Real>&) const {
    PerWall<bool> on;
    for (int f = 0; f < function_count(); ++f) on[f] = f == 0 || is_border(f);
    return on;
  }
  /// True if p is in the region, to within the rounding of the gap.
  bool is_valid(int, const Vec3<Real>& p) const {
    for (int f = 1; f < function_count(); ++f)
      if (is_border(f) && border(f, p) < 0) return false;
    return true;
  }
  /// The distance from the axis is not smooth near the axis, and its derivatives are large.
  std::optional<Real> smooth_way(const Vec3<Real>& p) const {
    if (!is_round_ || is_side() || outside_[0] == 0) return std::nullopt;
    const Real inward = across(p) - half_[0] * 3 / 4;
    return inward < distance_ ? inward : distance_;
  }
  /// The least distance of a ball at p from contact [m], at most 0 in contact.
  Real clearance(const Vec3<Real>& p) const { return norm<Real>(from_core(p)) - distance_; }
  /// Bound on the distance from the origin of a ball that is at most `way` [m] from contact.
  Real reach_near(const Real& way) const { return size() + 2 * largest_ball_ + way; }
  PerWall<bool> within(const Vec3<Real>& p, const Real& way) const {
    const Real near = distance_ + way;
    if (squared_norm<Real>(from_core(p)) > near * near) return {};
    auto on = active(p);
    for (int f = is_round_ ? 3 : 1; f < function_count(); ++f)
      on[f] = on[f] && !(border(f, p) > way);
    return on;
  }

  /// The gap has other bounds where it contains a root, the square of the distance from the axis,
  /// or y alone.
  int kind_of(int f) const {
    if (f > 0 || !is_round_ || (outside_[0] != 0 && outside_[1] != 0)) return f;
    return is_side() ? function_count() : function_count() + 1;
  }
  /// @pre the ball begins within the way of a window of contact: no function is needed farther out
  PerKind<Real> derivative_bounds(const CoordinateBounds<Real>& c, int k) const {
    const Real square = product_bound(c.x, 0, c.x, k) + product_bound(c.z, 0, c.z, k);
    const Real most = rounding_ + largest_ball_ + 3 * (c.x[0] - domain_);  // of the excess
    const Real least = half_[0] * 74 / 100;  // of the distance from the axis
    Majorant<Real> x = c.x, y = c.y, z = c.z;
    x[0] = y[0] = z[0] = most;
    Real bound = product_bound(y, 0, y, k);
    if (is_round_) {
      const auto r = distance_bound(c, Real(most + half_[0] / 4), least, k);
      return {bound + product_bound(r, 0, r, k), square, square, c.y[k], c.y[k], c.z[k], c.z[k],
          square, bound};
    }
    bound += product_bound(x, 0, x, k) + product_bound(z, 0, z, k);
    return {bound, c.x[k], c.x[k], c.y[k], c.y[k], c.z[k], c.z[k], bound, bound};
  }
  bool is_flat(int f) const { return f >= (is_round_ ? 3 : 1); }
  /// The region is unknown here: the largest bounds of all.
  ErrorBounds<Real> curved_errors(int f, const ErrorBounds<Real>& coordinate, const Real& u,
      const Real& frame_speed, const Real& acceleration, const Real& beyond) const {
    const Real &v = frame_speed, &a = acceleration;
    const Real most = rounding_ + largest_ball_ + 3 * beyond, slack = 4 * slack_ * slack_;
    const Real inside = half_[0] + half_[1] + half_[2];
    auto e = coordinate;  // of an excess
    e.value += 4 * u * (inside + most);
    if (!is_round_) return squares(e, u, v, a, most, slack);
    const Real R = half_[0] + most;
    auto square = squared_distance_errors(coordinate, u, v, a, R);
    square.value += slack;
    if (f > 0) return square;
    e = larger(e, distance_errors(coordinate, u, v, a, R, Real(4 / (3 * half_[0]))));
    return larger(square, squares(e, u, v, a, Real(most + half_[0] / 4), slack));
  }

  Vec3<Real> normal(int, const Vec3<Real>& p) const {
    const Vec3<Real> d = from_core(p);
    const Real size = norm<Real>(d);
    return size > 0 ? Vec3<Real>(d / size) : way_out(p).first;
  }
  Real overlap(int, const Vec3<Real>& p) const {
    const Real size = norm<Real>(from_core(p));
    return size > 0 ? Real(distance_ - size) : Real(distance_ + way_out(p).second);
  }
 private:
  template <class> friend class RoundedBody;

  /// On which side of the core's edges a coordinate is: -1, 1, or 0 between them.
  int side(int i, const Vec3<Real>& p) const {
    return !(half_[i] > 0) ? 1 : p[i] > half_[i] ? 1 : p[i] < -half_[i] ? -1 : 0;
  }
  bool is_side() const { return is_round_ && outside_[0] != 0 && outside_[1] == 0; }
  /// True if an excess is part of the gap. The excess of a cylinder across its axis takes the place
  /// of x.
  bool counts(int i) const { return outside_[i] != 0; }
  Real excess(int i, const Vec3<Real>& p) const {
    if (is_round_ && i == 0) return across(p) - half_[0];
    return (outside_[i] < 0 ? Real(-p[i]) : p[i]) - half_[i];
  }
  Real excess_rate(int i, const Vec3<Real>& p, const Vec3<Real>& v) const {
    if (is_round_ && i == 0) return (p[0] * v[0] + p[2] * v[2]) / across(p);
    return outside_[i] < 0 ? Real(-v[i]) : v[i];
  }

  /// Derivatives of the gap, twice the given one, and of the borders.
  /// @param across, along  of (x^2 + z^2) / 2 and of the coordinates
  PerWall<Real> derivatives(
      const Real& half_of_gap, const Real& across, const Vec3<Real>& along) const {
    PerWall<Real> all{Real(2 * half_of_gap)};
    for (int f = 1; f < function_count(); ++f)
      if (is_border(f))
        all[f] = is_round_ && f < 3 ? sign(f) * 2 * across : sign(f) * along[axis(f)];
    return all;
  }

  // Borders: functions 2 i + 1 and 2 i + 2 belong to axis i. A region outside has the first of
  // them, one between the edges both; an edge of length zero has none.
  static int axis(int f) { return (f - 1) / 2; }
  bool is_border(int f) const {
    const int i = axis(f);
    if (!(half_[i] > 0) || (is_round_ && (i == 2 || f == 2))) return false;
    return !counts(i) || f % 2 == 1;
  }
  /// The sign of the derivative along the axis or, for a cylinder, across its axis.
  int sign(int f) const {
    const int own = outside_[axis(f)];
    if (is_round_ && f < 3) return own != 0 ? 1 : -1;
    return own != 0 ? own : f % 2 == 1 ? 1 : -1;
  }
  Real border(int f, const Vec3<Real>& p) const {
    if (!is_border(f)) return Real(1);
    const int i = axis(f);
    const bool out = counts(i);
    if (is_round_ && f < 3) {
      const Real a = out ? Real(half_[0] - slack_) : Real(half_[0] + slack_);
      return out ? Real(squared_across(p) - a * a) : Real(a * a - squared_across(p));
    }
    const Real along = sign(f) < 0 ? Real(-p[i]) : p[i];
    return (out ? Real(along - half_[i]) : Real(along + half_[i])) + slack_;
  }

  /// Vector from the nearest point of the core to p.
  Vec3<Real> from_core(const Vec3<Real>& p) const {
    Vec3<Real> d;
    for (int i = 0; i < 3; ++i) d[i] = p[i] - std::clamp(p[i], Real(-half_[i]), half_[i]);
    if (!is_round_) return d;
    const Real r = across(p), rest = r > half_[0] ? Real(1 - half_[0] / r) : Real(0);
    return {p[0] * rest, d[1], p[2] * rest};
  }

  /// From a point of the core to its nearest face: direction and length.
  std::pair<Vec3<Real>, Real> way_out(const Vec3<Real>& p) const {
    using Way = std::pair<Vec3<Real>, Real>;
    const auto to_face = [&](int i) {
      return Way(Vec3<Real>::Unit(i) * Real(p[i] < 0 ? -1 : 1), half_[i] - magnitude(p[i]));
    };
    const auto shorter = [](const Way& a, const Way& b) { return b.second < a.second ? b : a; };
    if (!is_round_) return shorter(shorter(to_face(1), to_face(0)), to_face(2));
    const Real r = across(p);
    const Vec3<Real> outwards =
        r > 0 ? Vec3<Real>(p[0] / r, Real(0), p[2] / r) : Vec3<Real>(1, 0, 0);
    return shorter(to_face(1), Way(outwards, half_[0] - r));
  }

  static ErrorBounds<Real> larger(const ErrorBounds<Real>& a, const ErrorBounds<Real>& b) {
    const auto more = [](const Real& x, const Real& y) { return x > y ? x : y; };
    return {more(a.value, b.value), more(a.rate, b.rate), more(a.second, b.second)};
  }
  /// Errors of the sum of the squares of three numbers below `far` with errors e, and of its
  /// derivatives.
  static ErrorBounds<Real> squares(const ErrorBounds<Real>& e, const Real& u, const Real& v,
      const Real& a, const Real& far, const Real& slack) {
    return {7 * far * e.value + 16 * u * far * far + slack,
        7 * (far * e.rate + v * e.value) + 32 * u * far * v,
        7 * (2 * v * e.rate + far * e.second + a * e.value) + 32 * u * (v * v + far * a)};
  }

  bool is_round_ = false;
  Vec3<Real> half_ = Vec3<Real>::Zero();
  Real rounding_{0}, distance_{0};  ///< from the core to a ball's centre at contact
  Real largest_ball_{0}, domain_{0}, slack_{0};
  /// The region; of a cylinder across its axis, and along it.
  std::array<int, 3> outside_{1, 1, 1};
};

/// Rings around y from below to above, for pictures.
template <class Real> Mesh mesh_of(const RoundedBody<Real>& body) {
  const Vec3<double> half = vector_cast<double>(body.half());
  const double rounding = static_cast<double>(body.rounding()),
               quarter = numerics::pi<double>() / 2;
  const bool round = body.is_round();
  const int steps = rounding > 0 ? 4 : 0, columns = round ? 12 : steps + 1;  // of a quarter
  Mesh mesh;
  std::vector<int> ring;
  for (int row = 0; row <= 2 * steps + 1; ++row) {
    const bool above = row > steps;
    const double up = steps == 0 ? 0 : quarter * (above ? row - steps - 1 : row - steps) / steps;
    std::vector<int> next;
    for (int q = 0; q < 4; ++q)
      for (int k = 0; k < columns; ++k) {
        const double share = round ? double(k) / columns : steps == 0 ? 0.5 : double(k) / steps;
        const double around = quarter * (q + share);
        const double x = std::cos(around), z = std::sin(around), out = rounding * std::cos(up);
        const double a = half[0] * (round ? x : q == 0 || q == 3 ? 1 : -1);
        const double c = half[2] * (round ? z : q < 2 ? 1 : -1);
        next.push_back(static_cast<int>(mesh.points.size()));
        mesh.points.emplace_back(
            a + out * x, (above ? half[1] : -half[1]) + rounding * std::sin(up), c + out * z);
      }
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const auto after = (k + 1) % ring.size();
      mesh.faces.push_back({ring[k], ring[after], next[after], next[k]});
    }
    if (row == 0) mesh.faces.push_back(next);
    ring = std::move(next);
  }
  mesh.faces.push_back(ring);
  return mesh;
}

}  // namespace edmill::model
