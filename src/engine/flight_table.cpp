#include "edmill/engine/flight_table.hpp"

#include <cstring>

namespace edmill::engine {

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define EDMILL_FOR_SEVERAL_CPUS [[gnu::target_clones("avx2", "default")]]
#else
#define EDMILL_FOR_SEVERAL_CPUS
#endif

EDMILL_FOR_SEVERAL_CPUS void mark_candidates(const FlightColumns& f, const PairQuestion& q,
                                             std::vector<double>& hits) {
  const double *x = f.x.data(), *y = f.y.data(), *z = f.z.data(), *u = f.u.data(), *v = f.v.data(),
               *w = f.w.data();
  const double *period = f.period.data(), *offset = f.offset.data(), *radius = f.radius.data();
  double* __restrict hit = hits.data();
  // Copies, so that no store can be thought to change them.
  const double px = q.seen.position[0], py = q.seen.position[1], pz = q.seen.position[2];
  const double vx = q.seen.velocity[0], vy = q.seen.velocity[1], vz = q.seen.velocity[2];
  const double gx = q.filter.gravity[0], gy = q.filter.gravity[1], gz = q.filter.gravity[2];
  const double own_age = q.seen.age, own_radius = q.radius, now_period = static_cast<double>(q.now.period),
               now_offset = q.now.offset;
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

namespace {

typedef double Four __attribute__((vector_size(32)));
typedef std::int64_t FourIntegers __attribute__((vector_size(32)));

static_assert(sizeof(dynamics::Flight<double>) == 2 * sizeof(Four));

}  // namespace

// Four flights are two rows each; turned, they are the columns of the loop above. Written out, since a
// function called from here would be compiled for the oldest CPU.
EDMILL_FOR_SEVERAL_CPUS int keep_candidates(const dynamics::Flight<double>* flights, const double* radii,
                                            int stride, const PairQuestion& q, int* balls, int count) {
  const double drive = q.filter.period, slowest = q.filter.slowest_squared, touching = q.filter.touching;
  const double relative = q.filter.relative;
  for (int k = count; k & 3; ++k) balls[k] = balls[0];
  int kept = 0;
  for (int k = 0; k < count; k += 4) {
    const int i0 = balls[k], i1 = balls[k + 1], i2 = balls[k + 2], i3 = balls[k + 3];
    Four a0, a1, b0, b1, c0, c1, d0, d1;
    const auto load = [flights](int i, Four& low, Four& high) {
      const char* from = reinterpret_cast<const char*>(&flights[i]);
      std::memcpy(&low, from, sizeof low);
      std::memcpy(&high, from + sizeof low, sizeof high);
    };
    load(i0, a0, a1), load(i1, b0, b1), load(i2, c0, c1), load(i3, d0, d1);
    const Four ab0 = __builtin_shufflevector(a0, b0, 0, 4, 2, 6),
               cd0 = __builtin_shufflevector(c0, d0, 0, 4, 2, 6);
    const Four ab1 = __builtin_shufflevector(a0, b0, 1, 5, 3, 7),
               cd1 = __builtin_shufflevector(c0, d0, 1, 5, 3, 7);
    const Four ef0 = __builtin_shufflevector(a1, b1, 0, 4, 2, 6),
               gh0 = __builtin_shufflevector(c1, d1, 0, 4, 2, 6);
    const Four ef1 = __builtin_shufflevector(a1, b1, 1, 5, 3, 7),
               gh1 = __builtin_shufflevector(c1, d1, 1, 5, 3, 7);
    const Four x = __builtin_shufflevector(ab0, cd0, 0, 1, 4, 5),
               z = __builtin_shufflevector(ab0, cd0, 2, 3, 6, 7);
    const Four y = __builtin_shufflevector(ab1, cd1, 0, 1, 4, 5),
               u = __builtin_shufflevector(ab1, cd1, 2, 3, 6, 7);
    const Four v = __builtin_shufflevector(ef0, gh0, 0, 1, 4, 5),
               p = __builtin_shufflevector(ef0, gh0, 2, 3, 6, 7);
    const Four w = __builtin_shufflevector(ef1, gh1, 0, 1, 4, 5),
               offset = __builtin_shufflevector(ef1, gh1, 2, 3, 6, 7);
    const Four radius{radii[i0 * stride], radii[i1 * stride], radii[i2 * stride], radii[i3 * stride]};

    // Whole periods since the start, below 2^51: as the low bits of a double they need no conversion.
    constexpr double shift = 6755399441055744.0;  // 1.5 x 2^52
    FourIntegers started;
    std::memcpy(&started, &p, sizeof p);
    const FourIntegers shifted = (q.now.period - started) + std::int64_t{0x4338000000000000};
    Four periods;
    std::memcpy(&periods, &shifted, sizeof periods);
    const Four age = (periods - shift) * drive + (q.now.offset - offset);
    const Four half = age / 2, dt = q.seen.age - age;
    const Vec3<double>& g = q.filter.gravity;
    const Four rx = q.seen.position[0] - (x + age * (u + half * g[0]));
    const Four ry = q.seen.position[1] - (y + age * (v + half * g[1]));
    const Four rz = q.seen.position[2] - (z + age * (w + half * g[2]));
    const Four ux = (q.seen.velocity[0] - u) + g[0] * dt, uy = (q.seen.velocity[1] - v) + g[1] * dt,
               uz = (q.seen.velocity[2] - w) + g[2] * dt;
    const Four b = rx * ux + ry * uy + rz * uz;
    const Four r2 = rx * rx + ry * ry + rz * rz;
    const Four v2 = ux * ux + uy * uy + uz * uz;
    const Four sum = q.radius + radius;
    const Four c = r2 - sum * sum;
    const FourIntegers clear = (v2 > slowest) & (c > touching);
    const FourIntegers apart = (b >= 0) | (b * b - v2 * c < -(relative * (v2 * r2)));
    const FourIntegers meets = ~(clear & apart) & 1;
    if ((meets[0] | meets[1] | meets[2] | meets[3]) == 0) continue;
    balls[kept] = i0, kept += static_cast<int>(meets[0]);
    balls[kept] = i1, kept += static_cast<int>(meets[1]) & (k + 1 < count);
    balls[kept] = i2, kept += static_cast<int>(meets[2]) & (k + 2 < count);
    balls[kept] = i3, kept += static_cast<int>(meets[3]) & (k + 3 < count);
  }
  return kept;
}

}  // namespace edmill::engine
