// Bounds on the motion of a chain of joints that hold at all times. Derivation: docs/theory.md, section 3.
#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "base/scalar.hpp"
#include "base/trigonometry.hpp"
#include "base/vector.hpp"
#include "model/motions/joints.hpp"
#include "model/parts/vessel_frame.hpp"

namespace edmill::model {

/// A vector that is turned about an axis. (Rodrigues)
template <class Real>
Vec3<Real> turned_about(const Vec3<Real>& v, const Vec3<Real>& axis, const numerics::SinCos<Real>& angle) {
  return v * angle.cos + cross<Real>(axis, v) * angle.sin + axis * Real(dot<Real>(axis, v) * (1 - angle.cos));
}

/// Bounds on the sizes of vectors in the frame that moves: of the angular velocity and its first three
/// derivatives, of the acceleration of the origin and its first two, all as the frame itself sees them.
template <class Real>
struct ChainBounds {
  enum class Speeds {
    summed,  ///< constant speeds about parallel axes have signs: a jar may turn against its disc
    apart    ///< the size of each counts, as rounding sees them
  };

  std::array<Real, 4> turning{};       ///< [rad/s], [rad/s^2], ...
  std::array<Real, 3> acceleration{};  ///< [m/s^2], ...
  Real speed{0};                       ///< of the origin [m/s]
  Real distance{0};                    ///< of the origin from that of the ground [m]
  Real errors{20};  ///< what rounding does to any of these at most, relative and in units of u

  ChainBounds(const Joints<Real>& joints, Speeds speeds) {
    std::optional<Vec3<Real>> common;  // of all axes so far, in the present frame
    bool parallel = true;
    Real sum(0), sizes(0);  // of the constant speeds about it
    for (const auto& joint : joints.list) {
      const auto rates = rates_of(joint, joints.times);
      errors += error_of(joint, joints.period);
      const Vec3<Real> axis = direction(joint);
      if (!joint.rotates) {
        shift(joint, rates);
      } else if (!(rates[1] > 0)) {
        if (common) *common = turned_about<Real>(*common, axis, numerics::sin_cos_turns<Real>(-joint.angle));
      } else {
        parallel = parallel && (!common || are_parallel(*common, axis));
        if (common && dot<Real>(*common, axis) < 0) sum = -sum;
        common = axis;
        rotate(rates, parallel);
        if (!parallel || speeds == Speeds::apart) continue;
        const Real own = 2 * numerics::pi<Real>() * joint.speed,
                   sum_of_sizes = magnitude(sum) + magnitude(own);
        sum += own, sizes += magnitude(own);
        turning[0] += (magnitude(sum) - sum_of_sizes) + 8 * epsilon<Real>() * sizes;
      }
    }
    const Real up = 1 + rounding_margin<Real>();  // over the rounding of all this
    speed *= up, distance *= up;
    for (auto& bound : turning) bound *= up;
    for (auto& bound : acceleration) bound *= up;
  }

  static Vec3<Real> direction(const Joint<Real>& joint) {
    const Vec3<Real> axis{joint.axis[0], joint.axis[1], joint.axis[2]};
    const Real size = norm<Real>(axis);
    return size > 0 ? Vec3<Real>(axis / size) : axis;
  }

 private:
  /// Bounds on the joint's angle [rad] or shift [m] and its first four derivatives.
  static std::array<Real, 5> rates_of(const Joint<Real>& joint, const std::array<Real, 2>& times) {
    const Real turn = 2 * numerics::pi<Real>();
    const Real unit = joint.rotates ? turn : Real(1);
    const Vec3<Real> fixed{joint.shift[0], joint.shift[1], joint.shift[2]};
    std::array<Real, 5> rates{norm<Real>(fixed), magnitude<Real>(unit * joint.speed), Real(0), Real(0),
                              Real(0)};
    if (!joint.rotates) {
      const Real first = magnitude(times[0]), last = magnitude(times[1]);
      rates[0] += rates[1] * (first > last ? first : last);
    }
    for (const auto& swing : joint.swings) {
      Real size = magnitude<Real>(swing.amplitude * unit);
      for (auto& rate : rates) rate += size, size *= magnitude<Real>(turn * swing.frequency);
    }
    return rates;
  }
  /// A phase that is known to a few roundings of so many turns is off by 2 pi as much; then a sine, a product
  /// with a matrix and with the vectors behind it.
  static Real error_of(const Joint<Real>& joint, const Real& period) {
    const auto of_phase = [&](const Real& frequency) {
      return Real(7 * (4 + 3 * magnitude<Real>(frequency * period)));
    };
    // Of constant angles and phases as well, where they are more than the turn that this leaves for them.
    const auto of_turns = [](const Real& turns) {
      const Real size = magnitude(turns);
      return size > 1 ? Real(14 * size) : Real(0);
    };
    Real most = of_turns(joint.angle);
    if (!(joint.speed == 0)) most += joint.rotates ? of_phase(joint.speed) : Real(8);
    for (const auto& swing : joint.swings) {
      const Real size = joint.rotates ? Real(7 * magnitude<Real>(swing.amplitude)) : Real(1);
      most += (size > 1 ? size : Real(1)) * (of_phase(swing.frequency) + of_turns(swing.phase));
    }
    return most + 10;
  }
  static bool are_parallel(const Vec3<Real>& a, const Vec3<Real>& b) {
    return squared_norm<Real>(cross<Real>(a, b)) < 64 * epsilon<Real>() * epsilon<Real>();
  }

  /// k-th derivative of a product. (Leibniz)
  template <std::size_t n, std::size_t m>
  static Real product(const std::array<Real, n>& a, std::size_t shift_a, const std::array<Real, m>& b,
                      std::size_t shift_b, std::size_t k) {
    Real sum(0);
    for (std::size_t j = 0; j <= k; ++j) sum += binomial[k][j] * a[j + shift_a] * b[k - j + shift_b];
    return sum;
  }
  /// The frame behind the joint turns about an axis: its angular velocity is E w + axis angle', and E b the
  /// acceleration, where the derivatives of the matrix E follow from those of the angle. (Faa di Bruno)
  void rotate(const std::array<Real, 5>& angle, bool parallel) {
    const Real &a = angle[1], &b = angle[2], &c = angle[3];
    const std::array<Real, 4> matrix{Real(1), a, a * a + b, a * a * a + 3 * a * b + c};
    const auto w = turning;
    const auto old = acceleration;
    for (std::size_t k = 0; k < 4; ++k)
      turning[k] = (parallel ? w[k] : product(matrix, 0, w, 0, k)) + angle[k + 1];
    for (std::size_t k = 0; k < 3; ++k) acceleration[k] = product(matrix, 0, old, 0, k);
  }
  /// (d + C)'' with C = shift in a frame that turns: d'' + 2 w x d' + w' x d + w x (w x d).
  void shift(const Joint<Real>&, const std::array<Real, 5>& d) {
    std::array<Real, 3> square;
    for (std::size_t k = 0; k < 3; ++k) square[k] = product(turning, 0, turning, 0, k);
    for (std::size_t k = 0; k < 3; ++k)
      acceleration[k] += d[k + 2] + 2 * product(turning, 0, d, 1, k) + product(turning, 1, d, 0, k) +
                         product(square, 0, d, 0, k);
    speed += d[1] + turning[0] * d[0];
    distance += d[0];
  }
};

/// Bounds over a box on the distance from an axis through the origin, and along it.
template <class Real>
Real bound_along(const Vec3<Real>& axis, const Vec3<Real>& middle, const Vec3<Real>& half) {
  return magnitude<Real>(dot<Real>(axis, middle)) + dot<Real>(axis.cwiseAbs(), half);
}
template <class Real>
Real bound_across(const Vec3<Real>& axis, const Vec3<Real>& middle, const Vec3<Real>& half) {
  Real most(0);
  for (int corner = 0; corner < 8; ++corner) {
    Vec3<Real> p = middle;
    for (int k = 0; k < 3; ++k) p[k] += (corner >> k) % 2 ? half[k] : Real(-half[k]);
    const Real size = norm<Real>(cross<Real>(axis, p));
    most = size > most ? size : most;
  }
  return most;
}

/// The box that a vessel of these half sizes sweeps: from the vessel to the ground, each joint turns or
/// shifts the box of what is behind it.
template <class Real>
SweptBox<Real> swept_box(const Joints<Real>& joints, const Vec3<Real>& sizes) {
  using std::sqrt;
  SweptBox<Real> box{-sizes, sizes};
  for (auto joint = joints.list.rbegin(); joint != joints.list.rend(); ++joint) {
    const Vec3<Real> axis = ChainBounds<Real>::direction(*joint);
    Real swing(0);
    for (const auto& s : joint->swings) swing += magnitude<Real>(s.amplitude);
    if (!joint->rotates) {
      const Vec3<Real> shift{joint->shift[0], joint->shift[1], joint->shift[2]};
      const Vec3<Real> way = axis.cwiseAbs() * swing;
      const Vec3<Real> first = axis * Real(joint->speed * joints.times[0]),
                       last = axis * Real(joint->speed * joints.times[1]);
      box = {box.low + shift - way + first.cwiseMin(last), box.high + shift + way + first.cwiseMax(last)};
      continue;
    }
    const Vec3<Real> middle = (box.low + box.high) / Real(2), half = (box.high - box.low) / Real(2);
    const Real farthest = norm<Real>(Vec3<Real>(middle.cwiseAbs() + half));
    // By the constant angle, and by the most that the swings add; or all around.
    const auto angle = numerics::sin_cos_turns<Real>(joint->angle);
    const Real more = joint->speed == 0 ? Real(2 * numerics::pi<Real>() * swing * farthest) : 2 * farthest;
    Vec3<Real> reach = Vec3<Real>::Constant(more);
    for (int k = 0; k < 3; ++k) {
      const Vec3<Real> unit = Vec3<Real>::Unit(k);
      reach += turned_about<Real>(unit, axis, angle).cwiseAbs() * half[k];
    }
    const Vec3<Real> centre = turned_about<Real>(middle, axis, angle);
    // What is at a height along the axis stays there, and what is at a distance from it keeps that.
    for (int k = 0; k < 3; ++k) {
      const Real height = magnitude<Real>(axis[k]) * bound_along(axis, middle, half);
      const Real away = sqrt(magnitude<Real>(1 - axis[k] * axis[k])) * bound_across(axis, middle, half);
      const Real around = height + away;
      const Real low = centre[k] - reach[k], high = centre[k] + reach[k];
      box.low[k] = low < -around ? Real(-around) : low;
      box.high[k] = high > around ? around : high;
    }
  }
  const Real up = rounding_margin<Real>();
  const Vec3<Real> margin = (box.high - box.low) * up;
  return {box.low - margin, box.high + margin};
}

}  // namespace edmill::model
