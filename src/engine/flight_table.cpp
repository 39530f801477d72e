#include "edmill/engine/flight_table.hpp"

namespace edmill::engine {

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
[[gnu::target_clones("avx2", "default")]]
#endif
void mark_candidates(const FlightColumns& f, const PairQuestion& q, std::vector<double>& hits) {
  const double *x = f.x.data(), *y = f.y.data(), *z = f.z.data(), *u = f.u.data(), *v = f.v.data(),
               *w = f.w.data();
  const double *period = f.period.data(), *offset = f.offset.data(), *radius = f.radius.data();
  double* __restrict hit = hits.data();
  // Copies, so that no store can be thought to change them.
  const double px = q.seen.position[0], py = q.seen.position[1], pz = q.seen.position[2];
  const double vx = q.seen.velocity[0], vy = q.seen.velocity[1], vz = q.seen.velocity[2];
  const double gx = q.filter.gravity[0], gy = q.filter.gravity[1], gz = q.filter.gravity[2];
  const double own_age = q.seen.age, own_radius = q.radius, now_period = q.now_period,
               now_offset = q.now_offset;
  const double drive = q.filter.period, slowest = q.filter.slowest_squared, touching = q.filter.touching;
  const double relative = q.filter.relative;
  const int n = static_cast<int>(hits.size());
  for (int k = 0; k < n; ++k) {
    const double age = (now_period - period[k]) * drive + (now_offset - offset[k]);
    const double half = age / 2, dt = own_age - age;
    const double rx = px - (x[k] + age * (u[k] + half * gx));
    const double ry = py - (y[k] + age * (v[k] + half * gy));
    const double rz = pz - (z[k] + age * (w[k] + half * gz));
    const double ux = (vx - u[k]) + gx * dt, uy = (vy - v[k]) + gy * dt, uz = (vz - w[k]) + gz * dt;
    const double b = rx * ux + ry * uy + rz * uz;
    const double r2 = rx * rx + ry * ry + rz * rz;
    const double v2 = ux * ux + uy * uy + uz * uz;
    const double sum = own_radius + radius[k];
    const double c = r2 - sum * sum;
    const bool clear = (v2 > slowest) & (c > touching);
    const bool apart = (b >= 0) | (b * b - v2 * c < -(relative * (v2 * r2)));
    hit[k] = (clear & apart) ? 0.0 : 1.0;
  }
}

}  // namespace edmill::engine
