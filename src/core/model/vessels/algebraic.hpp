// A convex vessel whose walls are zeros of polynomials, as a program gives them.
#pragma once

#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/errors.hpp"
#include "edmill/polynomial.hpp"
#include "model/parts/partners.hpp"
#include "model/parts/surface.hpp"

namespace edmill::model {

/// A polynomial of a place and of the radius of a ball, to be evaluated.
template <class Real> struct AlgebraicForm {
  struct Term {
    Real factor;
    Polynomial<double>::Powers powers;
    int degree() const { return powers[0] + powers[1] + powers[2]; }
  };
  std::vector<Term> terms;

  template <class To> AlgebraicForm<To> cast() const {
    AlgebraicForm<To> to;
    for (const auto& t : terms) to.terms.push_back({static_cast<To>(t.factor), t.powers});
    return to;
  }
  AlgebraicForm by(int axis) const {
    AlgebraicForm derivative;
    for (auto t : terms) {
      auto& power = t.powers[axis];
      if (power == 0) continue;
      t.factor = t.factor * Real(power--);
      derivative.terms.push_back(std::move(t));
    }
    return derivative;
  }
  Real at(const Vec3<Real>& p, const Real& r) const {
    Real sum(0);
    for (const auto& t : terms) sum += product(t.factor, t.powers, p, r);
    return sum;
  }
  /// Bound on the absolute value where no coordinate is larger than these.
  Real size(const Vec3<Real>& sizes, const Real& r) const {
    Real sum(0);
    for (const auto& t : terms) sum += product(magnitude(t.factor), t.powers, sizes, r);
    return sum;
  }
  static Real product(
      Real factor, const Polynomial<double>::Powers& powers, const Vec3<Real>& p, const Real& r) {
    for (int axis = 0; axis < 3; ++axis)
      for (int k = 0; k < powers[axis]; ++k) factor *= p[axis];
    for (int k = 0; k < powers[3]; ++k) factor *= r;
    return factor;
  }
};

/// A vessel whose wall k is where the k-th polynomial, the gap, is zero; it need not be a length.
/// The ball's radius is one of its variables, so that an inset only changes the radius.
template <class Real> class AlgebraicVessel {
 public:
  using Scalar = Real;
  static constexpr std::size_t most_walls = 32;
  static constexpr int most_degree = 8;
  template <class Value> using PerWall = boost::container::static_vector<Value, most_walls>;
  template <class Value> using PerKind = PerWall<Value>;

  /// @throws InputError when the walls close no vessel in the box
  AlgebraicVessel(const std::vector<Polynomial<Real>>& walls, const Vec3<Real>& half_sizes) {
    if (walls.empty() || walls.size() > most_walls)
      throw InputError(
          "vessel: found " + std::to_string(walls.size()) + " walls, expected 1 to 32");
    if (!(half_sizes.minCoeff() > 0))
      throw InputError(
          "vessel: found half_sizes that are not positive, expected those of a box around the "
          "vessel");
    auto shape = std::make_shared<Shape>();
    for (const auto& polynomial : walls) {
      AlgebraicForm<Real> gap;
      for (const auto& [powers, factor] : polynomial.terms())
        if (factor != 0) gap.terms.push_back({factor, powers});
      for (const auto& t : gap.terms)
        if (t.degree() > most_degree || t.powers[3] > most_degree)
          throw InputError("vessel: found a wall of degree " +
              std::to_string(std::max(t.degree(), t.powers[3])) + ", expected at most 8");
      shape->walls.push_back(Wall(std::move(gap)));
      if (shape->walls.back().by_radius.terms.empty())
        throw InputError(
            "vessel: found a wall that does not depend on r, expected a ball's radius in it");
    }
    shape->half_sizes = half_sizes;
    shape_ = shape;
    if (reaches_out()) throw InputError("vessel: the walls leave it open within half_sizes");
    const auto [widest, volume] = measures();
    if (!(widest > 0)) throw InputError("vessel: the walls leave no room within half_sizes");
    shape->widest = widest;
    shape->volume = volume;
  }
  template <class To> AlgebraicVessel<To> cast() const {
    auto shape = std::make_shared<typename AlgebraicVessel<To>::Shape>();
    for (const auto& wall : shape_->walls) shape->walls.push_back({wall.gap.template cast<To>()});
    shape->half_sizes = vector_cast<To>(shape_->half_sizes);
    shape->widest = static_cast<To>(shape_->widest);
    shape->volume = static_cast<To>(shape_->volume);
    return AlgebraicVessel<To>(std::move(shape), static_cast<To>(radius_));
  }

  int wall_count() const { return static_cast<int>(shape_->walls.size()); }
  std::vector<WallInfo> walls() const { return numbered_walls(wall_count(), "the curved wall "); }
  static std::vector<WallSurface<Real>> surfaces() { return {}; }
  /// The gaps of the walls as functions of place and radius.
  const AlgebraicForm<Real>& form(int wall) const { return of(wall).gap; }

  Real reach() const { return norm<Real>(half_sizes()); }
  Real extent() const { return half_sizes().sum(); }
  Vec3<Real> half_sizes() const {
    return shape_->half_sizes - Vec3<Real>(radius_, radius_, radius_);
  }
  /// Accurate to about a thousandth.
  Real volume() const { return shape_->volume; }
  Real widest_ball() const { return shape_->widest - 2 * radius_; }
  AlgebraicVessel inset(const Real& by) const { return AlgebraicVessel(shape_, radius_ + by); }
  bool is_empty() const { return !(2 * radius_ < shape_->widest); }
  bool contains(const Vec3<Real>& p) const {
    const Vec3<Real> half = half_sizes();
    for (int axis = 0; axis < 3; ++axis)
      if (p[axis] > half[axis] || -p[axis] > half[axis]) return false;
    return !is_empty() && has_room(p, radius_);
  }

  PerWall<Real> gaps(const Vec3<Real>& p) const {
    return each([&](const Wall& wall) { return wall.gap.at(p, radius_); });
  }
  Real gap(int wall, const Vec3<Real>& p) const { return of(wall).gap.at(p, radius_); }
  PerWall<Real> rates(const Vec3<Real>& p, const Vec3<Real>& u) const {
    return each([&](const Wall& wall) { return wall.along(u, p, radius_); });
  }
  PerWall<Real> curvatures(const Vec3<Real>& p, const Vec3<Real>& u, const Vec3<Real>& a) const {
    return each([&](const Wall& wall) {
      Real sum = wall.along(a, p, radius_);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) sum += wall.bends[i][j].at(p, radius_) * (u[i] * u[j]);
      return sum;
    });
  }
  PerWall<bool> within(const Vec3<Real>& p, const Real& way) const {
    const Vec3<Real> sizes = p.cwiseAbs() + Vec3<Real>(way, way, way);
    PerWall<bool> near;
    for (const auto& wall : shape_->walls)
      near.push_back(!(wall.gap.at(p, radius_) > wall.steepest(sizes, radius_) * way));
    return near;
  }

  static int kind_of(int wall) { return wall; }
  PerKind<Real> derivative_bounds(const CoordinateBounds<Real>& c, int k) const {
    return each([&](const Wall& wall) {
      Real sum(0);
      for (const auto& t : wall.gap.terms) {
        Majorant<Real> bound{Real(1), Real(0), Real(0), Real(0), Real(0)};
        const auto multiply = [&](const Majorant<Real>& by) {
          Majorant<Real> product;
          for (int m = 0; m <= 4; ++m) product[m] = product_bound(bound, 0, by, m);
          bound = product;
        };
        for (int n = 0; n < t.powers[0]; ++n) multiply(c.x);
        for (int n = 0; n < t.powers[1]; ++n) multiply(c.y);
        for (int n = 0; n < t.powers[2]; ++n) multiply(c.z);
        for (int n = 0; n < t.powers[3]; ++n)
          for (auto& b : bound) b *= radius_;
        sum += magnitude(t.factor) * bound[k];
      }
      return sum;
    });
  }
  static constexpr bool is_flat(int) { return false; }
  /// Error of a coordinate, propagated by the derivatives, and a rounding for each product and sum;
  /// a margin of one part in sixteen covers the squares of errors.
  ErrorBounds<Real> curved_errors(int index, const ErrorBounds<Real>& y, const Real& u,
      const Real& v, const Real& a, const Real& beyond) const {
    const auto& wall = of(index);
    const Vec3<Real> sizes = half_sizes() + Vec3<Real>(beyond, beyond, beyond);
    const Real value = wall.gap.size(sizes, radius_), first = wall.steepest(sizes, radius_),
               second = wall.bent(sizes, radius_), third = wall.third(sizes.maxCoeff(), radius_);
    const Real rounding = Real(static_cast<int>(wall.gap.terms.size()) + 2 * most_degree + 16) * u;
    const Real more = Real(17) / 16, bend = a * y.value + 2 * v * y.rate;
    return {more * (first * y.value) + rounding * value,
        more * (first * y.rate + second * (v * y.value)) + rounding * (first * v),
        more * (first * y.second + second * bend + third * (v * v * y.value)) +
            rounding * (first * a + second * (v * v))};
  }

  Vec3<Real> normal(int wall, const Vec3<Real>& p) const {
    const Vec3<Real> slope = of(wall).slope(p, touching(wall, p));
    return slope / norm<Real>(slope);
  }
  Real overlap(int wall, const Vec3<Real>& p) const { return radius_ - touching(wall, p); }
 private:
  template <class> friend class AlgebraicVessel;
  using Form = AlgebraicForm<Real>;

  /// A gap with its derivatives by the coordinates.
  struct Wall {
    Wall(Form of) : gap(std::move(of)), by_radius(gap.by(3)) {
      for (int i = 0; i < 3; ++i) {
        slopes[i] = gap.by(i);
        for (int j = 0; j < 3; ++j) bends[i][j] = slopes[i].by(j);
      }
    }
    Vec3<Real> slope(const Vec3<Real>& p, const Real& r) const {
      return {slopes[0].at(p, r), slopes[1].at(p, r), slopes[2].at(p, r)};
    }
    Real along(const Vec3<Real>& u, const Vec3<Real>& p, const Real& r) const {
      return dot<Real>(slope(p, r), u);
    }
    Real steepest(const Vec3<Real>& sizes, const Real& r) const {
      return slopes[0].size(sizes, r) + slopes[1].size(sizes, r) + slopes[2].size(sizes, r);
    }
    Real bent(const Vec3<Real>& sizes, const Real& r) const {
      Real sum(0);
      for (const auto& row : bends)
        for (const auto& form : row) sum += form.size(sizes, r);
      return sum;
    }
    /// Bound on the sum of all third derivatives.
    Real third(const Real& size, const Real& r) const {
      Real sum(0);
      for (const auto& t : gap.terms) {
        const int d = t.degree();
        if (d < 3) continue;
        const Real factor = magnitude(t.factor) * Real(d * (d - 1) * (d - 2));
        sum += Form::product(factor, {d - 3, 0, 0, t.powers[3]}, {size, size, size}, r);
      }
      return sum;
    }

    Form gap, by_radius;
    Form slopes[3], bends[3][3];
  };
  struct Shape {
    std::vector<Wall> walls;
    Vec3<Real> half_sizes;
    Real widest{0}, volume{0};  ///< diameter of the largest ball [m], [m3]
  };

  AlgebraicVessel(std::shared_ptr<const Shape> shape, const Real& radius)
      : shape_(std::move(shape)), radius_(radius) {}

  /// The radius of the ball about p that touches the wall, by Newton's method: inside, the gap
  /// decreases with the radius, and more and more slowly. Where it increases, the ball is wider
  /// than the vessel.
  Real touching(int index, const Vec3<Real>& p) const {
    const auto& wall = of(index);
    const Real sharp = 8 * epsilon<Real>() * shape_->half_sizes.maxCoeff();
    Real r = wall.by_radius.at(p, radius_) < 0 ? radius_ : Real(0);
    for (int step = 0; step < 2 * binary_digits<Real>(); ++step) {
      const Real fall = wall.by_radius.at(p, r);
      if (!(fall < 0)) break;
      const Real move = wall.gap.at(p, r) / fall;
      r -= move;
      if (move < sharp && -move < sharp) break;
    }
    return r;
  }

  const Wall& of(int wall) const { return shape_->walls[wall]; }
  PerWall<Real> each(const auto& f) const {
    PerWall<Real> values;
    for (const auto& wall : shape_->walls) values.push_back(f(wall));
    return values;
  }

  /// True if the centre of a ball of this radius can be at p. For a much larger ball, a gap such as
  /// (R - r)^2
  /// - x^2 - z^2 becomes positive again, but there it increases with the radius.
  bool has_room(const Vec3<Real>& p, const Real& r) const {
    return std::all_of(shape_->walls.begin(), shape_->walls.end(),
        [&](const Wall& wall) { return wall.gap.at(p, r) >= 0 && wall.by_radius.at(p, r) < 0; });
  }
  /// True if the vessel reaches a face of the box, tested on a lattice of points.
  bool reaches_out() const {
    constexpr int steps = 24;
    const auto& half = shape_->half_sizes;
    const Real beyond_touching = half.minCoeff() / 1000000000;
    for (int axis = 0; axis < 3; ++axis)
      for (const int side : {-1, 1})
        for (int i = 0; i <= steps; ++i)
          for (int j = 0; j <= steps; ++j) {
            Vec3<Real> p;
            p[axis] = half[axis] * side;
            p[(axis + 1) % 3] = half[(axis + 1) % 3] * Real(2 * i - steps) / Real(steps);
            p[(axis + 2) % 3] = half[(axis + 2) % 3] * Real(2 * j - steps) / Real(steps);
            if (has_room(p, beyond_touching)) return true;
          }
    return false;
  }
  /// The radius of the largest ball about a place.
  Real room_at(const Vec3<Real>& p) const {
    if (!has_room(p, Real(0))) return Real(0);
    Real low(0), high = shape_->half_sizes.minCoeff();
    for (int step = 0; step < 40; ++step) {
      const Real middle = (low + high) / 2;
      (has_room(p, middle) ? low : high) = middle;
    }
    return low;
  }
  /// Diameter of the largest ball, by hill climbing from the best point of a lattice, and volume,
  /// by counting points.
  std::pair<Real, Real> measures() const {
    constexpr int steps = 48;
    const auto& half = shape_->half_sizes;
    Real most(0);
    Vec3<Real> best = Vec3<Real>::Zero();
    std::uint64_t inside = 0;
    for (int i = 0; i < steps * steps * steps; ++i) {
      const int n[3] = {i % steps, i / steps % steps, i / (steps * steps)};
      Vec3<Real> p;
      for (int axis = 0; axis < 3; ++axis)
        p[axis] = half[axis] * Real(2 * n[axis] + 1 - steps) / Real(steps);
      if (!has_room(p, Real(0))) continue;
      ++inside;
      if (!has_room(p, most)) continue;
      most = room_at(p);
      best = p;
    }
    for (Real step = half.maxCoeff() / Real(steps / 2); step > most / 1000000; step /= 2)
      for (bool moved = true; moved;) {
        moved = false;
        for (int way = 0; way < 6; ++way) {
          Vec3<Real> p = best;
          p[way / 2] += way % 2 == 0 ? step : Real(-step);
          if (!has_room(p, most)) continue;
          const Real room = room_at(p);
          if (room > most * (1 + Real(1) / 1000000)) {
            most = room;
            best = p;
            moved = true;
          }
        }
      }
    const Real cell = 8 * (half[0] / steps) * (half[1] / steps) * (half[2] / steps);
    return {2 * most, Real(inside) * cell};
  }

  std::shared_ptr<const Shape> shape_;
  Real radius_{0};  ///< of the ball whose centre moves in it [m]
};

}  // namespace edmill::model
