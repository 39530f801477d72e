// The vessel: the concept, and a type that can be any vessel.
#pragma once

#include <boost/container/static_vector.hpp>
#include <concepts>
#include <memory>
#include <utility>
#include <variant>

#include "model/vessels/algebraic.hpp"
#include "model/vessels/piston.hpp"
#include "model/vessels/polyhedron.hpp"
#include "model/vessels/rounded.hpp"
#include "model/vessels/simple.hpp"

namespace edmill::model {

/// A closed convex shape in the vessel frame, its walls numbered from 0. Gaps are smooth functions
/// of the position of a ball's centre: positive inside, zero at contact. They need not be lengths.
/// The region of the centre of a ball of radius R is the vessel `inset(R)`, whose gaps are those of
/// the ball.
///
/// - `wall_count()`; `walls()`: their names; `surfaces()`: for maps and pictures, empty if they
/// have no
///   coordinates; `PerWall<T>`: one T for each
/// - `reach()` [m]: from the centre to the farthest point; `extent()`, no less and without a root;
///   `half_sizes()`: bounds on the coordinates; `volume()` [m3]; `widest_ball()`: diameter of the
///   largest ball that fits [m]
/// - `inset(R)`; `is_empty()`, also if a ball just fits and cannot move; `contains(p)`; optionally
///   `place(drawn)`: a uniform position in the vessel from three numbers that are uniform in [-1,
///   1], or nothing if new ones must be drawn (default: by rejection from the box of
///   `half_sizes()`)
/// - `gaps(p)`, `gap(wall, p)`; `rates(p, u)` and `curvatures(p, u, a)`, their derivatives where p'
/// = u, u' =
///   a
/// - `within(p, way)`: for each wall, whether it may be within `way` [m] of p; `way` includes all
/// rounding
/// - `kind_of(wall)`: walls of one kind have the same `derivative_bounds(coordinates, k)`, on the
/// k-th
///   derivatives of their gaps
/// - `is_flat(wall)`: the gap is a coordinate up to sign and offset, and as accurate as one; for
/// other walls
///   `curved_errors` bounds the rounding, from that of a coordinate, the speed and acceleration in
///   the vessel frame, and how far outside the ball may be [m]
/// - only if the gap functions of walls are valid in regions: `function_count()`: the functions
/// after those
///   of the walls are the borders of the regions; `active(p)`: those that must be searched from p
///   on; `is_valid(wall, p)`: whether that wall's gap is valid at p, to within rounding;
///   `smooth_way(p)`: how far a ball at p may move while all active functions are smooth [m], or
///   nothing if there is no limit
/// - `normal(wall, p)`: of a contact, unit, into the vessel; `overlap(wall, p)` [m], negative for a
/// gap
template <class V, class Real = typename V::Scalar>
concept Vessel = requires(const V& vessel, int wall, const Vec3<Real>& p, const Real& x,
    const CoordinateBounds<Real>& coordinates, const ErrorBounds<Real>& errors) {
  typename V::template PerWall<bool>;
  typename V::template PerKind<bool>;
  { vessel.wall_count() } -> std::same_as<int>;
  { vessel.walls() } -> std::same_as<std::vector<WallInfo>>;
  { vessel.surfaces() } -> std::same_as<std::vector<WallSurface<Real>>>;
  { vessel.reach() } -> std::same_as<Real>;
  { vessel.extent() } -> std::same_as<Real>;
  { vessel.half_sizes() } -> std::same_as<Vec3<Real>>;
  { vessel.volume() } -> std::same_as<Real>;
  { vessel.widest_ball() } -> std::same_as<Real>;
  { vessel.inset(x) } -> std::same_as<V>;
  { vessel.is_empty() } -> std::same_as<bool>;
  { vessel.contains(p) } -> std::same_as<bool>;
  { vessel.gaps(p) } -> std::same_as<typename V::template PerWall<Real>>;
  { vessel.gap(wall, p) } -> std::same_as<Real>;
  { vessel.rates(p, p) } -> std::same_as<typename V::template PerWall<Real>>;
  { vessel.curvatures(p, p, p) } -> std::same_as<typename V::template PerWall<Real>>;
  { vessel.within(p, x) } -> std::same_as<typename V::template PerWall<bool>>;
  { vessel.kind_of(wall) } -> std::same_as<int>;
  {
    vessel.derivative_bounds(coordinates, wall)
    } -> std::same_as<typename V::template PerKind<Real>>;
  { vessel.is_flat(wall) } -> std::same_as<bool>;
  { vessel.curved_errors(wall, errors, x, x, x, x) } -> std::same_as<ErrorBounds<Real>>;
  { vessel.normal(wall, p) } -> std::same_as<Vec3<Real>>;
  { vessel.overlap(wall, p) } -> std::same_as<Real>;
};

/// The vessels that a case file can name, the default first. A new one is a file in model/vessels/
/// and a line here and in VesselVariant: it is read, described and passed to every scalar by its
/// list of parameters.
template <class Number>
using NamedVessels = std::variant<Cylinder<Number>,  //
    Box<Number>,                                     //
    Sphere<Number>,                                  //
    Capsule<Number>,                                 //
    RoundedCylinder<Number>,                         //
    Polyhedron<Number>>;

template <class Real>
using VesselVariant = std::variant<CylinderVessel<Real>,  //
    BoxVessel<Real>,                                      //
    SphereVessel<Real>,                                   //
    RoundedVessel<Real>,                                  //
    PolyhedronVessel<Real>,                               //
    AlgebraicVessel<Real>>;

/// A vessel whose gap functions are valid only in regions.
template <class V>
concept HasRegions = requires(const V& vessel) {
  vessel.function_count();
};

template <class V> int function_count(const V& vessel) {
  if constexpr (HasRegions<V>)
    return vessel.function_count();
  else
    return vessel.wall_count();
}
/// A list that has the same value for each function.
template <class V, class Value>
typename V::template PerWall<Value> per_wall(const V& vessel, const Value& value) {
  using All = typename V::template PerWall<Value>;
  if constexpr (requires { All(1, value); }) {
    return All(static_cast<std::size_t>(function_count(vessel)), value);
  } else {
    All all;
    all.fill(value);
    return all;
  }
}
template <class V> auto active_functions(const V& vessel, const Vec3<typename V::Scalar>& p) {
  if constexpr (HasRegions<V>)
    return vessel.active(p);
  else
    return per_wall(vessel, true);
}

/// Any vessel, chosen when the case is read.
template <class Real> class AnyVessel {
 public:
  using Scalar = Real;
  static constexpr int most_walls = 32;
  template <class Value> using PerWall = boost::container::static_vector<Value, most_walls>;
  template <class Value> using PerKind = PerWall<Value>;

  AnyVessel() = default;
  template <class V>
  requires(!std::same_as<V, AnyVessel>) &&
      std::constructible_from<VesselVariant<Real>, V> AnyVessel(V vessel)
      : vessel_(std::move(vessel)) {}
  template <class To> AnyVessel<To> cast() const {
    auto to = visit([](const auto& v) { return AnyVessel<To>(v.template cast<To>()); });
    if (pistons_) to.set(pistons_->template cast<To>());
    return to;
  }

  /// Walls that move; null if there are none. An inset does not include them.
  const Pistons<Real>* pistons() const { return pistons_.get(); }
  void set(Pistons<Real> pistons) {
    pistons_ = std::make_shared<const Pistons<Real>>(std::move(pistons));
  }

  /// The vessel if it is a V, otherwise null.
  template <class V> const V* get_if() const { return std::get_if<V>(&vessel_); }
  template <class F> decltype(auto) visit(F&& f) const {
    return std::visit(std::forward<F>(f), vessel_);
  }

  int function_count() const {
    return visit([](const auto& v) { return model::function_count(v); });
  }
  PerWall<bool> active(const Vec3<Real>& p) const {
    return visit([&](const auto& v) { return listed(active_functions(v, p)); });
  }
  bool is_valid(int wall, const Vec3<Real>& p) const {
    return visit([&]<class V>(const V& v) {
      if constexpr (HasRegions<V>)
        return v.is_valid(wall, p);
      else
        return true;
    });
  }
  std::optional<Real> smooth_way(const Vec3<Real>& p) const {
    return visit([&]<class V>(const V& v) -> std::optional<Real> {
      if constexpr (HasRegions<V>)
        return v.smooth_way(p);
      else
        return std::nullopt;
    });
  }
  std::optional<Vec3<Real>> place(const Vec3<Real>& drawn) const {
    return visit([&](const auto& v) -> std::optional<Vec3<Real>> {
      if constexpr (requires { v.place(drawn); }) return v.place(drawn);
      const Vec3<Real> p = drawn.cwiseProduct(v.half_sizes());
      return v.contains(p) ? std::optional(p) : std::nullopt;
    });
  }
  AnyVessel inset(const Real& by) const {
    return visit([&](const auto& v) { return AnyVessel(v.inset(by)); });
  }

// The concept documents the parameters. Return types are explicit, as in AnyMotion. First single
// values, then one for each wall or kind of wall.
#define EDMILL_OF_VESSEL(Result, name)                         \
  Result name(const auto&... a) const {                        \
    return visit([&](const auto& v) { return v.name(a...); }); \
  }
#define EDMILL_OF_WALLS(Result, name)                                  \
  Result name(const auto&... a) const {                                \
    return visit([&](const auto& v) { return listed(v.name(a...)); }); \
  }
  EDMILL_OF_VESSEL(int, wall_count)
  EDMILL_OF_VESSEL(std::vector<WallInfo>, walls)
  EDMILL_OF_VESSEL(std::vector<WallSurface<Real>>, surfaces)
  EDMILL_OF_VESSEL(Real, reach)
  EDMILL_OF_VESSEL(Real, extent)
  EDMILL_OF_VESSEL(Vec3<Real>, half_sizes)
  EDMILL_OF_VESSEL(Real, volume)
  EDMILL_OF_VESSEL(Real, widest_ball)
  EDMILL_OF_VESSEL(bool, is_empty)
  EDMILL_OF_VESSEL(bool, contains)
  EDMILL_OF_VESSEL(Real, gap)
  EDMILL_OF_VESSEL(int, kind_of)
  EDMILL_OF_VESSEL(bool, is_flat)
  EDMILL_OF_VESSEL(ErrorBounds<Real>, curved_errors)
  EDMILL_OF_VESSEL(Vec3<Real>, normal)
  EDMILL_OF_VESSEL(Real, overlap)
  EDMILL_OF_WALLS(PerWall<Real>, gaps)
  EDMILL_OF_WALLS(PerWall<Real>, rates)
  EDMILL_OF_WALLS(PerWall<Real>, curvatures)
  EDMILL_OF_WALLS(PerWall<bool>, within)
  EDMILL_OF_WALLS(PerKind<Real>, derivative_bounds)
#undef EDMILL_OF_VESSEL
#undef EDMILL_OF_WALLS
 private:
  static auto listed(const auto& values) {
    return PerWall<std::decay_t<decltype(values[0])>>(values.begin(), values.end());
  }

  VesselVariant<Real> vessel_;
  std::shared_ptr<const Pistons<Real>> pistons_;
};

static_assert(Vessel<CylinderVessel<double>> && Vessel<BoxVessel<double>> &&
    Vessel<SphereVessel<double>> && Vessel<RoundedVessel<double>> &&
    Vessel<PolyhedronVessel<double>> && Vessel<AlgebraicVessel<double>> &&
    Vessel<AnyVessel<double>>);

}  // namespace edmill::model
