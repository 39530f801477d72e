// Flat walls of a vessel that move along their normals.
#pragma once

#include <utility>
#include <vector>

#include "base/scalar.hpp"
#include "model/motions/joints.hpp"
#include "model/parts/vessel_frame.hpp"

namespace edmill::model {

/// Inward displacement of a wall from its place in the vessel: distance + speed t + swings.
template <class Number> struct Piston {
  int wall;         ///< id
  Number distance;  ///< [m]
  Number speed;     ///< [m/s]
  std::vector<Swing<Number>> swings;
};

/// The pistons of a vessel.
template <class Real> class Pistons {
 public:
  /// @param period  of the clock [s]
  Pistons(std::vector<Piston<Real>> pistons, const Real& period)
      : given_(std::move(pistons)), period_(period) {
    for (auto& piston : given_)
      for (auto& swing : piston.swings)
        swing.frequency = swing.per_period.template value<Real>() / period_;
    for (const auto& piston : given_) swings_.emplace_back(piston.swings);
  }
  template <class To> Pistons<To> cast() const {
    const auto to = [](const Real& x) { return static_cast<To>(x); };
    std::vector<Piston<To>> list;
    for (const auto& p : given_)
      list.push_back({p.wall, to(p.distance), to(p.speed), converted_swings<To>(p.swings, to)});
    return {std::move(list), to(period_)};
  }

  const std::vector<Piston<Real>>& given() const { return given_; }
  std::size_t count() const { return given_.size(); }
  int wall(std::size_t k) const { return given_[k].wall; }

  /// Displacement [m], its rate and its second derivative.
  Moved<Real> at(std::size_t k, const Instant<Real>& when) const {
    auto moved = swings_[k].at(when);
    const auto& piston = given_[k];
    const Real seconds = Real(when.period) * period_ + when.offset;
    moved.value += piston.distance + piston.speed * seconds;
    moved.rate += piston.speed;
    return moved;
  }
  /// Displacement of a wall and its derivatives; zero if the wall has no piston.
  Moved<Real> of_wall(int wall, const Instant<Real>& when) const {
    for (std::size_t k = 0; k < given_.size(); ++k)
      if (given_[k].wall == wall) return at(k, when);
    return {};
  }

  /// Upper bound on the n-th derivative of any piston, n from 1 to 4 [m/s^n].
  Real bound(int n) const {
    Real most(0);
    for (const auto& piston : given_) {
      Real sum = n == 1 ? magnitude(piston.speed) : Real(0);
      for (const auto& s : piston.swings) {
        Real term = magnitude(s.amplitude);
        for (int k = 0; k < n; ++k) term *= 2 * numerics::pi<Real>() * magnitude(s.frequency);
        sum += term;
      }
      most = sum > most ? sum : most;
    }
    return most * (1 + rounding_margin<Real>());
  }
  /// Longest window [s] for which the derivative bounds are valid: a quarter of a radian of each
  /// swing.
  Real longest_window() const {
    Real longest = period_;
    for (const auto& piston : given_)
      for (const auto& s : piston.swings) {
        const Real turning = 8 * numerics::pi<Real>() * magnitude(s.frequency);
        if (turning * longest > 1) longest = 1 / turning;
      }
    return longest;
  }
  /// Bounds on the rounding errors of a displacement and its derivatives, including those of the
  /// case's numbers. A piston stays in the vessel, so that speed t is below |distance| + extent.
  /// @param extent  of the vessel, beyond half of which no piston goes [m]
  ErrorBounds<Real> errors(std::size_t k, const Real& u, const Real& extent) const {
    const auto& piston = given_[k];
    ErrorBounds<Real> e{
        32 * extent + (piston.speed == 0 ? Real(0) : Real(16 * magnitude(piston.distance))),
        4 * magnitude(piston.speed), Real(0)};
    for (const auto& s : piston.swings) {
      const Real turning = 2 * numerics::pi<Real>() * magnitude(s.frequency);
      const Real relative =
          16 + 7 * (4 + 3 * magnitude<Real>(s.frequency * period_) + magnitude(s.phase));
      const Real of_value = magnitude(s.amplitude) * relative;
      e.value += of_value;
      e.rate += of_value * turning;
      e.second += of_value * turning * turning;
    }
    return {u * e.value, u * e.rate, u * e.second};
  }
 private:
  std::vector<Piston<Real>> given_;
  Real period_;
  std::vector<Swings<Real>> swings_;
};

/// The pistons of a vessel; null if it cannot have any.
template <class V> const Pistons<typename V::Scalar>* pistons_of(const V& vessel) {
  if constexpr (requires { vessel.pistons(); })
    return vessel.pistons();
  else
    return nullptr;
}

}  // namespace edmill::model
