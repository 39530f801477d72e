// Free flight of a ball between impacts. (2.1)
#pragma once

#include <type_traits>

#include "base/instant.hpp"
#include "base/scalar.hpp"
#include "base/vector.hpp"

namespace edmill::dynamics {

/// A ball's path from `start` on; its spin does not change in flight. In double it is one cache line.
template <class Real>
struct alignas(sizeof(Real) == 8 ? 64 : alignof(Real)) Flight {
  Vec3<Real> position;  ///< at `start` [m]
  Vec3<Real> velocity;  ///< at `start` [m/s]
  Instant<Real> start;

  void archive(Archive& a) { a(position, velocity, start); }
};

template <class Real>
inline Vec3<Real> position_after(const Flight<Real>& f, const Vec3<Real>& gravity, const Real& dt) {
  const Real half = dt / 2;
  return {f.position[0] + dt * (f.velocity[0] + half * gravity[0]),
          f.position[1] + dt * (f.velocity[1] + half * gravity[1]),
          f.position[2] + dt * (f.velocity[2] + half * gravity[2])};
}

template <class Real>
inline Vec3<Real> velocity_after(const Flight<Real>& f, const Vec3<Real>& gravity, const Real& dt) {
  return {f.velocity[0] + dt * gravity[0], f.velocity[1] + dt * gravity[1], f.velocity[2] + dt * gravity[2]};
}

template <class Real>
inline Real fly_to(Flight<Real>& f, const Vec3<Real>& gravity, const DriveClock<Real>& clock,
                   const Instant<Real>& when) {
  const Real dt = clock.elapsed(f.start, when);
  f.position = position_after(f, gravity, dt);
  f.velocity = velocity_after(f, gravity, dt);
  f.start = when;
  return dt;
}

template <class To, class From>
inline Instant<To> instant_cast(const Instant<From>& t) {
  return {t.period, static_cast<To>(t.offset)};
}

/// The latest instant of a narrower scalar that is not after `t`.
template <class To, class From>
inline Instant<To> rounded_down(const Instant<From>& t) {
  To offset = static_cast<To>(t.offset);
  if (From(offset) > t.offset) {
    if constexpr (std::is_same_v<To, double>)
      offset = std::nextafter(offset, 0.0);
    else
      offset -= offset * epsilon<To>();
  }
  return {t.period, offset};
}

template <class To, class From>
inline Flight<To> flight_cast(const Flight<From>& f) {
  return {vector_cast<To>(f.position), vector_cast<To>(f.velocity), instant_cast<To>(f.start)};
}

}  // namespace edmill::dynamics
