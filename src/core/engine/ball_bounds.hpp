// Bounds that hold for every ball of a run.
#pragma once

#include <algorithm>
#include <vector>

#include "model/case.hpp"

namespace edmill::engine {

template <class Real>
bool all_alike(const std::vector<model::BallProperties<Real>>& balls) {
  return std::all_of(balls.begin(), balls.end(), [&](const auto& b) { return b == balls.front(); });
}

template <class Real>
Real smallest_radius(const std::vector<model::BallProperties<Real>>& balls) {
  Real smallest = balls.front().radius;
  for (const auto& b : balls) smallest = b.radius < smallest ? b.radius : smallest;
  return smallest;
}

/// The most that gravity adds to a ball's speed in one flight: one that stays within `reach` of the origin
/// bends by g t^2/8 < 2 reach [m/s].
template <class Real>
Real largest_fall(const model::Mill<Real>& mill) {
  using std::sqrt;
  const Real reach = mill.motion.reach(mill.vessel.reach());
  return 4 * sqrt(reach * norm<Real>(mill.gravity));
}

/// Speed of two bodies that the accelerations of walls and gravity bring together over a path [m/s].
template <class Real>
Real speed_over(const Real& path, const model::Mill<Real>& mill) {
  using std::sqrt;
  const Real reach = mill.motion.reach(mill.vessel.extent());
  Real acceleration = mill.motion.acceleration_within(reach) + norm<Real>(mill.gravity);
  if (const auto* pistons = mill.vessel.pistons()) acceleration += pistons->bound(2);
  return sqrt(2 * acceleration * path);
}

/// A clock that advances by less hardly advances: no ball has time to move, or rounding is all that moves it
/// [s].
template <class Real>
Real shortest_advance(const model::Mill<Real>& mill) {
  const Real by_rule = mill.least_separations().second / mill.stall.acceleration;
  return std::max(by_rule, Real(1000000 * epsilon<Real>() * mill.motion.period()));
}

/// Largest speed of a ball until impacts make one faster than twice the fastest ball or wall at the start
/// [m/s].
template <class Real>
Real largest_speed(const std::vector<model::BallState<Real>>& states, const model::Mill<Real>& mill) {
  Real largest{1};
  for (const auto& s : states) {
    const Real speed = norm<Real>(s.velocity);
    if (speed > largest) largest = speed;
  }
  Real wall = mill.motion.speed_within(mill.motion.reach(mill.vessel.extent()));
  if (const auto* pistons = mill.vessel.pistons()) wall += pistons->bound(1);
  return 2 * (largest + wall) + largest_fall(mill);
}

}  // namespace edmill::engine
