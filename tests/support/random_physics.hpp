// RapidCheck generators for physical values, exact in every scalar.
#pragma once

#include <rapidcheck.h>

#include "base/vector.hpp"
#include "model/ball.hpp"

namespace edmill::testing {

/// Uniform in [low, high): a fraction k/2^40 of the range.
template <class Real> Real draw(const Real& low, const Real& high) {
  const auto k = *rc::gen::inRange<std::int64_t>(0, std::int64_t{1} << 40);
  return low + (high - low) * (Real(k) / Real(std::int64_t{1} << 40));
}

template <class Real> Vec3<Real> draw_vector(const Real& size) {
  const Real x = draw<Real>(-size, size), y = draw<Real>(-size, size), z = draw<Real>(-size, size);
  return {x, y, z};
}

template <class Real> Vec3<Real> draw_direction() {
  const Vec3<Real> v = draw_vector<Real>(Real(1));
  const Real size = norm<Real>(v);
  if (size > Real(1) / 100) return v * (1 / size);
  return {Real(1), Real(0), Real(0)};
}

/// Radius 0.5 to 10 mm, mass by a density of 1 to 20 g/cm3, reduced inertia 0.1 to 0.7.
template <class Real> model::BallProperties<Real> draw_ball() {
  const Real radius = draw<Real>(Real(1) / 2000, Real(1) / 100);
  const Real density = draw<Real>(Real(1000), Real(20000));
  return {radius, density * 4 * radius * radius * radius, draw<Real>(Real(1) / 10, Real(7) / 10)};
}

}  // namespace edmill::testing
