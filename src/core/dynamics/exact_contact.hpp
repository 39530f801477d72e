// First contacts in exact arithmetic, where the gap is a polynomial of second degree: two balls, which fall
// alike, and flat walls that do not move along their normals. theory.md, section 4
#pragma once

#include <optional>

#include "base/dyadic.hpp"
#include "dynamics/flight.hpp"
#include "dynamics/wall_query.hpp"
#include "model/motion.hpp"
#include "model/vessel.hpp"

namespace edmill::dynamics {

/// A gap, or a function with its sign: value + rate t + bend t^2, t from some instant on.
struct ExactGap {
  Dyadic value, rate, bend;
};

/// (p + s sqrt(square)) / q with q > 0.
struct ExactTime {
  Dyadic p, q{1};
  int s = 0;
  Dyadic square{};

  /// Rounded down to the scalar, but not below zero. @pre it is not negative
  template <class Real>
  Real rounded_down() const;
  /// Sign of this time less the other one, which counts from `later` after the origin of this one.
  int compare(const ExactTime& other, const Dyadic& later = {}) const;
};

/// The first t >= 0 at which the gap is zero or negative while it falls, or is about to fall.
std::optional<ExactTime> exact_contact_time(const ExactGap& gap);

/// Time from `from` to `to` [s].
template <class Real>
Dyadic exact_elapsed(const Instant<Real>& from, const Instant<Real>& to, const Real& period) {
  return Dyadic::of(Real(to.period - from.period)) * Dyadic::of(period) + Dyadic::of(to.offset) -
         Dyadic::of(from.offset);
}

/// The squared distance of two balls less that of their contact, from `now` on [m^2].
template <class Real>
ExactGap exact_gap(const Flight<Real>& i, const Flight<Real>& j, const Instant<Real>& now,
                   const Real& radius_sum, const Vec3<Real>& gravity, const Real& period);

/// The gap to a wall from the begin of the window on [m]; nothing where it is no such polynomial.
template <model::Motion M, model::Vessel V, class Real = typename M::Scalar>
std::optional<ExactGap> exact_gap(const M& motion, const V& vessel, const Vec3<Real>& gravity,
                                  const WallQuery<Real>& query, int wall);

}  // namespace edmill::dynamics
