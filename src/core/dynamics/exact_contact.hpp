// First contacts in exact arithmetic, where the gap is a polynomial of second degree: two balls,
// which fall alike, and flat walls that do not move along their normals. theory.md, section 4
#pragma once

#include <optional>

#include "base/dyadic.hpp"
#include "dynamics/flight.hpp"
#include "model/motion.hpp"
#include "model/vessel.hpp"

namespace edmill::dynamics {

/// A gap, or a function with the same sign, as value + rate t + bend t^2 from some instant on.
struct ExactGap {
  Dyadic value, rate, bend;
};

/// (p + s sqrt(square)) / q with q > 0.
struct ExactTime {
  Dyadic p, q{1};
  int s = 0;
  Dyadic square{};

  /// Rounded down to the scalar, but not below zero. @pre it is not negative
  template <class Real> Real rounded_down() const {
    using std::sqrt;
    // The root with the smaller absolute value is the product of both over the other one.
    const Real whole = p.to<Real>(), over = q.to<Real>(), root = Real(s) * sqrt(square.to<Real>());
    const Real t = s * p.sign() < 0 ? Real((p * p - square).to<Real>() / (over * (whole - root)))
                                    : Real((whole + root) / over);
    Real below = t > 0 ? t : Real(0);
    for (Real step = epsilon<Real>() / 2; below > 0 && compare({Dyadic::of(below)}) < 0;
         step = 2 * step)
      below = below - below * step;
    return below;
  }
  /// Sign of this time minus `other`, whose origin is `later` after that of this time.
  int compare(const ExactTime& other, const Dyadic& later = {}) const {
    const Dyadic rational = p * other.q - other.p * q - later * q * other.q;
    return sign_of_sum(rational, s, square * other.q * other.q, -other.s, other.square * q * q);
  }
};

/// The first t >= 0 at which the gap is zero or negative while it falls, or is about to fall.
inline std::optional<ExactTime> exact_contact_time(const ExactGap& gap) {
  const auto& [value, rate, bend] = gap;
  const int turn = bend.sign();
  const Dyadic discriminant = rate * rate - Dyadic(4) * value * bend;
  if (value.sign() <= 0) {
    if (rate.sign() < 0 || (rate.sign() == 0 && turn < 0)) return ExactTime{};
    if (rate.sign() == 0 || turn >= 0) return std::nullopt;
    // It rises and turns back: before it opens, or after.
    if (discriminant.sign() <= 0) return ExactTime{rate, Dyadic(-2) * bend};
    return ExactTime{rate, Dyadic(-2) * bend, 1, discriminant};
  }
  if (turn < 0) return ExactTime{rate, Dyadic(-2) * bend, 1, discriminant};
  if (rate.sign() >= 0) return std::nullopt;
  if (turn == 0) return ExactTime{value, -rate};
  if (discriminant.sign() <= 0) return std::nullopt;
  return ExactTime{-rate, Dyadic(2) * bend, -1, discriminant};
}

template <class Real>
Dyadic exact_elapsed(const Instant<Real>& from, const Instant<Real>& to, const Real& period) {
  const Dyadic periods = Dyadic::of(Real(to.period - from.period));
  return periods * Dyadic::of(period) + Dyadic::of(to.offset) - Dyadic::of(from.offset);
}

/// Squared distance of two balls minus its value at contact, from `now` on [m^2].
template <class Real>
ExactGap exact_gap(const Flight<Real>& i, const Flight<Real>& j, const Instant<Real>& now,
    const Real& radius_sum, const Vec3<Real>& gravity, const Real& period) {
  const Dyadic age_i = exact_elapsed(i.start, now, period);
  const Dyadic age_j = exact_elapsed(j.start, now, period), sum = Dyadic::of(radius_sum);
  ExactGap gap{-(sum * sum), {}, {}};
  for (int k = 0; k < 3; ++k) {
    const Dyadic g = Dyadic::of(gravity[k]);
    const auto place = [&](const Flight<Real>& f, const Dyadic& age) {
      return Dyadic::of(f.position[k]) + age * (Dyadic::of(f.velocity[k]) + (age * g).half());
    };
    const Dyadic r = place(i, age_i) - place(j, age_j);
    const Dyadic v = Dyadic::of(i.velocity[k]) - Dyadic::of(j.velocity[k]) + g * (age_i - age_j);
    gap.value = gap.value + r * r;
    gap.rate = gap.rate + Dyadic(2) * r * v;
    gap.bend = gap.bend + v * v;
  }
  return gap;
}

namespace detail {

template <class Real> model::Joints<Real> joints_of(const model::ChainMotion<Real>& chain) {
  return chain.joints();
}
/// The joints are used only to test whether angles vary, so the unit of angles does not matter.
template <class Real> model::Joints<Real> joints_of(const model::SpexMotion<Real>& spex) {
  return model::spex_joints<Real>(spex.arm(), spex.theta_max(), spex.gamma_max(), spex.period());
}

template <class Real> model::Joints<Real> joints_of(const model::AnyMotion<Real>& motion) {
  return motion.visit([](const auto& m) { return joints_of(m); });
}

/// The shape of a wall, by the vessel coordinates that its gap depends on.
template <class Real> struct Shape {
  enum Kind { other, plane, round } kind = other;
  /// The inward normal of a plane; for a round wall, 1 for each coordinate in its squared radius.
  Vec3<Real> axes{Real(0), Real(0), Real(0)};
  Real distance{0};  ///< of the wall from the centre [m]
};
template <class V, class Real = typename V::Scalar> Shape<Real> shape_of(const V& vessel, int id) {
  const Real one(1), zero(0);
  if constexpr (std::is_same_v<V, model::AnyVessel<Real>>) {
    if (const auto* pistons = vessel.pistons())
      for (std::size_t k = 0; k < pistons->count(); ++k)
        if (pistons->wall(k) == id) return {};
    return vessel.visit([&](const auto& v) { return shape_of(v, id); });
  } else if constexpr (std::is_same_v<V, model::SphereVessel<Real>>) {
    return {Shape<Real>::round, {one, one, one}, vessel.radius};
  } else if constexpr (model::HasRegions<V> || std::is_same_v<V, model::AlgebraicVessel<Real>>) {
    return {};
  } else {
    if constexpr (std::is_same_v<V, model::CylinderVessel<Real>>)
      if (!vessel.is_flat(id)) return {Shape<Real>::round, {one, zero, one}, vessel.radius};
    const Vec3<Real> centre = Vec3<Real>::Zero();
    return {Shape<Real>::plane, vessel.normal(id, centre), vessel.gap(id, centre)};
  }
}

/// A vessel coordinate that equals an inertial one up to sign and a constant.
struct StillCoordinate {
  int axis, sign;
  Dyadic offset;  ///< coordinate in the vessel = sign * coordinate in the ground - offset [m]
};

/// Expresses a vessel coordinate in inertial ones, by following its axis from joint to joint to the
/// ground; empty if a joint moves it. @param axis  of the vessel
template <class Real>
std::optional<StillCoordinate> still_coordinate(const model::Joints<Real>& joints, int axis) {
  StillCoordinate seen{axis, 1, {}};
  for (auto joint = joints.list.rbegin(); joint != joints.list.rend(); ++joint) {
    bool moves = joint->speed != 0;
    for (const auto& swing : joint->swings) moves = moves || swing.amplitude != 0;
    const auto along = [&](int k) -> const Real& {
      return joint->axis[static_cast<std::size_t>(k)];
    };
    if (!joint->rotates) {
      if (moves && along(seen.axis) != 0) return std::nullopt;
      const Dyadic shift = Dyadic::of(joint->shift[static_cast<std::size_t>(seen.axis)]);
      seen.offset = seen.sign > 0 ? seen.offset + shift : seen.offset - shift;
      continue;
    }
    int about = -1;  // the axis of rotation; 3 if it is not along x, y or z
    for (int k = 0; k < 3; ++k)
      if (along(k) != 0) about = about < 0 ? k : 3;
    if (about < 0 || about == seen.axis) continue;  // turns about the direction itself
    const Real quarters = 4 * joint->angle;
    const int turns = static_cast<int>(static_cast<double>(quarters));
    if (moves || about == 3 || Real(turns) != quarters) return std::nullopt;
    // By a quarter of a turn about z, x goes to y and y to -x.
    for (int count = ((along(about) < 0 ? -turns : turns) % 4 + 4) % 4; count > 0; --count) {
      if (seen.axis == (about + 2) % 3) seen.sign = -seen.sign;
      seen.axis = 3 - about - seen.axis;
    }
  }
  return seen;
}

/// The gap as a polynomial; one instance serves all motions and vessels of a scalar.
template <class Real>
std::optional<ExactGap> exact_gap(const model::Joints<Real>& joints, const Shape<Real>& shape,
    const Vec3<Real>& gravity, const WallQuery<Real>& query) {
  const bool round = shape.kind == Shape<Real>::round;
  const auto& flight = query.flight;
  const Dyadic age = exact_elapsed(flight.start, query.begin, joints.period);
  const Dyadic room = Dyadic::of(shape.distance) - Dyadic::of(query.radius);
  ExactGap gap{round ? room * room : room, {}, {}};
  for (int k = 0; k < 3; ++k) {
    if (shape.axes[k] == 0) continue;
    const auto seen = still_coordinate(joints, k);
    if (!seen || (round && gravity[seen->axis] != 0)) return std::nullopt;
    const Dyadic side(seen->sign), g = side * Dyadic::of(gravity[seen->axis]);
    const Dyadic begun = side * Dyadic::of(flight.velocity[seen->axis]), v = begun + age * g;
    const Dyadic p = side * Dyadic::of(flight.position[seen->axis]) +
        age * (begun + (age * g).half()) - seen->offset;
    const Dyadic n = Dyadic::of(shape.axes[k]);
    gap.value = gap.value + (round ? -(p * p) : n * p);
    gap.rate = gap.rate + (round ? Dyadic(-2) * p * v : n * v);
    gap.bend = gap.bend + (round ? -(v * v) : n * g.half());
  }
  return gap;
}

}  // namespace detail

/// The gap to a wall of a mill from the begin of the window on [m]; empty if it is no polynomial.
template <class Real>
std::optional<ExactGap> exact_gap(const auto& mill, const WallQuery<Real>& query, int wall) {
  if (wall >= mill.vessel.wall_count()) return std::nullopt;  // a body
  const auto shape = detail::shape_of(mill.vessel, wall);
  if (shape.kind == detail::Shape<Real>::other) return std::nullopt;
  return detail::exact_gap(detail::joints_of(mill.motion), shape, mill.gravity, query);
}

}  // namespace edmill::dynamics
