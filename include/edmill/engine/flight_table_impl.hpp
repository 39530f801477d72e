// Implementation of mark_candidates; included by the instantiation files only.
#pragma once

#include <type_traits>

#include "edmill/engine/flight_table.hpp"

namespace edmill::engine {

namespace detail {

template <class Real>
[[gnu::always_inline]] inline void mark_loop(const FlightColumns<Real>& f, const PairQuestion<Real>& q,
                                             std::vector<Real>& hits) {
  const Real *x = f.x.data(), *y = f.y.data(), *z = f.z.data(), *u = f.u.data(), *v = f.v.data(),
             *w = f.w.data();
  const Real *period = f.period.data(), *offset = f.offset.data(), *radius = f.radius.data();
  Real* __restrict hit = hits.data();
  // Copies, so that no store can be thought to change them.
  const Real px = q.seen.position[0], py = q.seen.position[1], pz = q.seen.position[2];
  const Real vx = q.seen.velocity[0], vy = q.seen.velocity[1], vz = q.seen.velocity[2];
  const Real gx = q.filter.gravity[0], gy = q.filter.gravity[1], gz = q.filter.gravity[2];
  const Real own_age = q.seen.age, own_radius = q.radius, now_period = q.now_period,
             now_offset = q.now_offset;
  const Real drive = q.filter.period, slowest = q.filter.slowest_squared, touching = q.filter.touching;
  const Real relative = q.filter.relative;
  const Real none(0), some(1);
  const int n = static_cast<int>(hits.size());
  for (int k = 0; k < n; ++k) {
    const Real age = (now_period - period[k]) * drive + (now_offset - offset[k]);
    const Real half = age / 2, dt = own_age - age;
    const Real rx = px - (x[k] + age * (u[k] + half * gx));
    const Real ry = py - (y[k] + age * (v[k] + half * gy));
    const Real rz = pz - (z[k] + age * (w[k] + half * gz));
    const Real ux = (vx - u[k]) + gx * dt, uy = (vy - v[k]) + gy * dt, uz = (vz - w[k]) + gz * dt;
    const Real b = rx * ux + ry * uy + rz * uz;
    const Real r2 = rx * rx + ry * ry + rz * rz;
    const Real v2 = ux * ux + uy * uy + uz * uz;
    const Real sum = own_radius + radius[k];
    const Real c = r2 - sum * sum;
    const bool clear = (v2 > slowest) & (c > touching);
    const bool apart = (b >= 0) | (b * b - v2 * c < -(relative * (v2 * r2)));
    hit[k] = (clear & apart) ? none : some;
  }
}

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
[[gnu::target_clones("avx2", "default")]]
#endif
inline void
mark_doubles(const FlightColumns<double>& flights, const PairQuestion<double>& question,
             std::vector<double>& hits) {
  mark_loop<double>(flights, question, hits);
}

}  // namespace detail

template <class Real>
void mark_candidates(const FlightColumns<Real>& flights, const PairQuestion<Real>& question,
                     std::vector<Real>& hits) {
  if constexpr (std::is_same_v<Real, double>)
    detail::mark_doubles(flights, question, hits);
  else
    detail::mark_loop<Real>(flights, question, hits);
}

}  // namespace edmill::engine
