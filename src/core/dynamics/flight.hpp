// Free flight of a ball (2.1); queries and answers of the search for its first contact with a wall.
#pragma once

#include <optional>
#include <type_traits>

#include "base/instant.hpp"
#include "base/scalar.hpp"
#include "base/vector.hpp"
#include "model/motion.hpp"

namespace edmill::dynamics {

/// A ball's path from `start` on; its spin is constant. In double it is one cache line.
template <class Real> struct alignas(sizeof(Real) == 8 ? 64 : alignof(Real)) Flight {
  Vec3<Real> position;  ///< at `start` [m]
  Vec3<Real> velocity;  ///< at `start` [m/s]
  Instant<Real> start;

  void archive(Archive& a) { a(position, velocity, start); }
};

template <class Real>
inline Vec3<Real> position_after(const Flight<Real>& f, const Vec3<Real>& g, const Real& dt) {
  const auto& [r, v, start] = f;
  const Real half = dt / 2;
  return {r[0] + dt * (v[0] + half * g[0]), r[1] + dt * (v[1] + half * g[1]),
      r[2] + dt * (v[2] + half * g[2])};
}

template <class Real>
inline Vec3<Real> velocity_after(const Flight<Real>& f, const Vec3<Real>& g, const Real& dt) {
  const auto& v = f.velocity;
  return {v[0] + dt * g[0], v[1] + dt * g[1], v[2] + dt * g[2]};
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

template <class To, class From> inline Instant<To> instant_cast(const Instant<From>& t) {
  return {t.period, static_cast<To>(t.offset)};
}

/// The latest instant of a narrower scalar that is not after `t`.
template <class To, class From> inline Instant<To> rounded_down(const Instant<From>& t) {
  To offset = static_cast<To>(t.offset);
  if (From(offset) > t.offset) {
    if constexpr (std::is_same_v<To, double>)
      offset = std::nextafter(offset, 0.0);
    else
      offset -= offset * epsilon<To>();
  }
  return {t.period, offset};
}

template <class To, class From> inline Flight<To> flight_cast(const Flight<From>& f) {
  return {vector_cast<To>(f.position), vector_cast<To>(f.velocity), instant_cast<To>(f.start)};
}

enum class Verdict { none, contact, undecided };

struct NoPose {
  void archive(Archive&) {}
};

/// Pose of the vessel at a contact: kept by wide scalars, whose sines are expensive.
template <class Real>
using ContactPose =
    std::conditional_t<std::is_same_v<Real, double>, NoPose, std::optional<model::AnyPose<Real>>>;

/// The answer of a search over (begin, begin + length]; `none` may be proven for a shorter window.
template <class Real> struct WallAnswer {
  Verdict verdict = Verdict::none;
  int wall = -1;         ///< of a contact
  Instant<Real> time{};  ///< of a contact: the non-penetrating end of the bracket
  /// No precision decides it: of two walls at one time the lower id was taken, or a gap is zero.
  bool by_rule = false;
  Real searched{0};    ///< if none: length of the proven window from begin [s]
  Real time_error{0};  ///< of a contact: bound on the rounding error of its time [s]
  [[no_unique_address]] ContactPose<Real> pose{};  ///< of a contact, where the search knows it

  static WallAnswer none(const Real& searched) { return {Verdict::none, -1, {}, false, searched}; }
  static WallAnswer contact(int wall, const Instant<Real>& time, const Real& time_error) {
    return {.verdict = Verdict::contact, .wall = wall, .time = time, .time_error = time_error};
  }
};

template <class Real> struct WallQuery {
  Flight<Real> flight;
  Real radius;          ///< [m]
  Instant<Real> begin;  ///< not before the flight's start
  Real length;          ///< [s], at most WallSearch::longest_window()
};

/// Statements proven in double for a wider flight and mill, rounded to double. Times are offsets
/// [s] in the drive period in which the window begins.
struct RoughAnswer {
  Verdict verdict = Verdict::undecided;
  double until = 0;            ///< of none: no contact up to here
  int wall = -1;               ///< of a contact; no wall is touched before `left`
  int region = 0;              ///< of the gap functions, where a body has several
  double left = 0, right = 0;  ///< its gap decreases throughout [left, right], through zero
  double root = 0;             ///< estimate of the root
  double curvature = 0, curvature_error = 0;  ///< second derivative there, bound on its error
  double third = 0;                           ///< bound on the third derivative
  double error = 0;  ///< bound on the rounding of the gap in double, without that of the state
};

}  // namespace edmill::dynamics
