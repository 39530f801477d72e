// Plain values that describe how a run went.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/archive.hpp"
#include "model/ball.hpp"

namespace edmill::model {

/// Mechanical energy of all balls [J].
template <class Real>
struct Energy {
  Real kinetic{0};    ///< translation and spin
  Real potential{0};  ///< -m g.r

  void archive(Archive& a) { a(kinetic, potential); }
  Energy& operator+=(const Energy& other) {
    kinetic += other.kinetic;
    potential += other.potential;
    return *this;
  }
};

/// The energy of one ball.
template <class Real>
Energy<Real> energy_of(const BallProperties<Real>& ball, const BallState<Real>& state,
                       const Vec3<Real>& gravity) {
  const Real inertia = ball.reduced_inertia * ball.mass * ball.radius * ball.radius;
  return {ball.mass / 2 * squared_norm<Real>(state.velocity) + inertia / 2 * squared_norm<Real>(state.spin),
          -(ball.mass * dot<Real>(gravity, state.position))};
}

/// The energy of all balls.
template <class Real>
Energy<Real> energy_of(const std::vector<BallProperties<Real>>& balls,
                       const std::vector<BallState<Real>>& states, const Vec3<Real>& gravity) {
  Energy<Real> total;
  for (std::size_t k = 0; k < balls.size(); ++k) total += energy_of<Real>(balls[k], states[k], gravity);
  return total;
}

/// Where a run could not go on: the exact model has a Zeno point here. (docs/theory.md, section 6)
template <class Real>
struct InelasticCollapse {
  int ball = -1;
  bool with_wall = false;
  int partner = -1;
  Real accumulation_time{};  ///< when the impacts accumulate [s]
};

/// Where a run could not go on since its clock stood still. (docs/theory.md, section 6)
template <class Real>
struct Stall {
  Real time{};                    ///< [s]
  std::vector<int> balls, walls;  ///< that hit each other at this instant, by id
  std::uint64_t impacts = 0;      ///< they had, at least

  void archive(Archive& a) { a(time, balls, walls, impacts); }
};

}  // namespace edmill::model
