#include "edmill/engine/flight_table.hpp"

#include <cstring>

namespace edmill::engine {

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define EDMILL_FOR_SEVERAL_CPUS [[gnu::target_clones("avx2", "default")]]
#else
#define EDMILL_FOR_SEVERAL_CPUS
#endif
// Of what the clones call: compiled by itself it would be for the oldest CPU. The clones themselves must not
// end in a call: GCC 12 then leaves out vzeroupper, and all SSE code after it is slow.
#define EDMILL_INTO_CLONES [[gnu::always_inline]] static inline

namespace {

typedef double Four __attribute__((vector_size(32)));
typedef std::int64_t FourIntegers __attribute__((vector_size(32)));

static_assert(sizeof(dynamics::Flight<double>) == 2 * sizeof(Four));

/// Four flights by columns.
struct FourFlights {
  Four x, y, z, u, v, w;
  Four age;  ///< now [s]
  Four radius;
};

/// A question in every lane, and out of reach of stores.
struct FourQuestions {
  Four px, py, pz, vx, vy, vz, age, radius;
  Four gx, gy, gz, relative, slowest, touching;
  Four drive, now;
};

EDMILL_INTO_CLONES void spread(double value, Four& four) { four = value - Four{}; }
EDMILL_INTO_CLONES void spread(const PairQuestion& q, FourQuestions& four) {
  spread(q.seen.position[0], four.px), spread(q.seen.position[1], four.py),
      spread(q.seen.position[2], four.pz);
  spread(q.seen.velocity[0], four.vx), spread(q.seen.velocity[1], four.vy),
      spread(q.seen.velocity[2], four.vz);
  spread(q.seen.age, four.age), spread(q.radius, four.radius);
  spread(q.filter.gravity[0], four.gx), spread(q.filter.gravity[1], four.gy),
      spread(q.filter.gravity[2], four.gz);
  spread(q.filter.relative, four.relative), spread(q.filter.slowest_squared, four.slowest);
  spread(q.filter.touching, four.touching);
  spread(q.filter.period, four.drive), spread(q.now.offset, four.now);
}

EDMILL_INTO_CLONES void load(const double* from, Four& four) { std::memcpy(&four, from, sizeof four); }
EDMILL_INTO_CLONES void store(double* to, const Four& four) { std::memcpy(to, &four, sizeof four); }
EDMILL_INTO_CLONES void store(std::int64_t* to, const FourIntegers& four) {
  std::memcpy(to, &four, sizeof four);
}

/// Entries k to k + 3 of `looks`; see PairFilter. `meets` becomes -1 for a suspect and 0 else. A ball that is
/// in the very same place is the ball of the question itself.
EDMILL_INTO_CLONES void look_at_four(const FourFlights& f, const FourQuestions& q, int k, Looks& looks,
                                     FourIntegers& meets) {
  const Four half = f.age * 0.5, dt = q.age - f.age;
  const Four rx = q.px - (f.x + f.age * (f.u + half * q.gx));
  const Four ry = q.py - (f.y + f.age * (f.v + half * q.gy));
  const Four rz = q.pz - (f.z + f.age * (f.w + half * q.gz));
  const Four ux = (q.vx - f.u) + q.gx * dt, uy = (q.vy - f.v) + q.gy * dt, uz = (q.vz - f.w) + q.gz * dt;
  const Four b = rx * ux + ry * uy + rz * uz;
  const Four r2 = rx * rx + ry * ry + rz * rz;
  const Four v2 = ux * ux + uy * uy + uz * uz;
  const Four sum = q.radius + f.radius;
  const Four c = r2 - sum * sum;
  const Four discriminant = b * b - v2 * c, doubt = q.relative * (v2 * r2);
  const FourIntegers moving = v2 > q.slowest, clear = moving & (c > q.touching);
  const FourIntegers apart = (c > q.touching) & ((b >= 0) | (discriminant < -doubt));
  const FourIntegers parting = (b > 0) & (b * b > doubt);
  meets = ~((moving & (apart | parting)) | (r2 == 0));
  store(looks.approach() + k, b);
  store(looks.gap() + k, c);
  store(looks.discriminant() + k, (clear & (discriminant > doubt)) ? discriminant : Four{} - 1.0);
}

}  // namespace

EDMILL_FOR_SEVERAL_CPUS void look_at_all(const FlightColumns& flights, const PairQuestion& question,
                                         Looks& looks) {
  FourQuestions q;
  spread(question, q);
  Four now_period;
  spread(static_cast<double>(question.now.period), now_period);
  const int rounded_up = static_cast<int>(flights.x.size());
  for (int k = 0; k < rounded_up; k += 4) {
    FourFlights f;
    Four period, offset;
    load(&flights.x[k], f.x), load(&flights.y[k], f.y), load(&flights.z[k], f.z);
    load(&flights.u[k], f.u), load(&flights.v[k], f.v), load(&flights.w[k], f.w);
    load(&flights.period[k], period), load(&flights.offset[k], offset), load(&flights.radius[k], f.radius);
    f.age = (now_period - period) * q.drive + (q.now - offset);
    FourIntegers meets;
    look_at_four(f, q, k, looks, meets);
    store(looks.meets() + k, meets);
  }
}

// Four flights are two rows each; turned, they are columns.
EDMILL_FOR_SEVERAL_CPUS int look_at(const dynamics::Flight<double>* flights, const double* radii, int stride,
                                    const PairQuestion& question, int self, int* balls, int count,
                                    Looks& looks) {
  FourQuestions q;
  spread(question, q);
  const std::int64_t now_period = question.now.period;
  Four common_radius;
  spread(radii[0], common_radius);
  int* suspects = looks.suspects();
  int found = 0;
  balls[count] = balls[count + 1] = balls[count + 2] = self;
  for (int k = 0; k < count; k += 4) {
    const int i0 = balls[k], i1 = balls[k + 1], i2 = balls[k + 2], i3 = balls[k + 3];
    const auto rows = [flights](int i) { return reinterpret_cast<const double*>(&flights[i]); };
    Four a0, a1, b0, b1, c0, c1, d0, d1;
    load(rows(i0), a0), load(rows(i1), b0), load(rows(i2), c0), load(rows(i3), d0);
    load(rows(i0) + 4, a1), load(rows(i1) + 4, b1), load(rows(i2) + 4, c1), load(rows(i3) + 4, d1);
    const Four ab0 = __builtin_shufflevector(a0, b0, 0, 4, 2, 6),
               cd0 = __builtin_shufflevector(c0, d0, 0, 4, 2, 6);
    const Four ab1 = __builtin_shufflevector(a0, b0, 1, 5, 3, 7),
               cd1 = __builtin_shufflevector(c0, d0, 1, 5, 3, 7);
    const Four ef0 = __builtin_shufflevector(a1, b1, 0, 4, 2, 6),
               gh0 = __builtin_shufflevector(c1, d1, 0, 4, 2, 6);
    const Four ef1 = __builtin_shufflevector(a1, b1, 1, 5, 3, 7),
               gh1 = __builtin_shufflevector(c1, d1, 1, 5, 3, 7);
    FourFlights f;
    f.x = __builtin_shufflevector(ab0, cd0, 0, 1, 4, 5);
    f.z = __builtin_shufflevector(ab0, cd0, 2, 3, 6, 7);
    f.y = __builtin_shufflevector(ab1, cd1, 0, 1, 4, 5);
    f.u = __builtin_shufflevector(ab1, cd1, 2, 3, 6, 7);
    f.v = __builtin_shufflevector(ef0, gh0, 0, 1, 4, 5);
    f.w = __builtin_shufflevector(ef1, gh1, 0, 1, 4, 5);
    const Four period = __builtin_shufflevector(ef0, gh0, 2, 3, 6, 7),
               offset = __builtin_shufflevector(ef1, gh1, 2, 3, 6, 7);
    f.radius = stride == 0 ? common_radius : Four{radii[i0], radii[i1], radii[i2], radii[i3]};

    // Whole periods since the start, below 2^51: as the low bits of a double they need no conversion.
    constexpr double shift = 6755399441055744.0;  // 1.5 x 2^52
    FourIntegers started;
    std::memcpy(&started, &period, sizeof period);
    const FourIntegers shifted = (now_period - started) + std::int64_t{0x4338000000000000};
    Four periods;
    std::memcpy(&periods, &shifted, sizeof periods);
    f.age = (periods - shift) * q.drive + (q.now - offset);
    FourIntegers meets;
    look_at_four(f, q, k, looks, meets);
    // Without branches: which of them is one is anybody's guess.
    suspects[found] = k, found -= static_cast<int>(meets[0]);
    suspects[found] = k + 1, found -= static_cast<int>(meets[1]);
    suspects[found] = k + 2, found -= static_cast<int>(meets[2]);
    suspects[found] = k + 3, found -= static_cast<int>(meets[3]);
  }
  return found;
}

int FlightTable::look(const PairQuestion& question, Looks& looks) const {
  looks.make_room(balls_);
  look_at_all(f_, question, looks);
  const std::int64_t* meets = looks.meets();
  int* suspects = looks.suspects();
  int found = 0;
  // Suspects are rare: look at eight at a time.
  int k = 0;
  for (; k + 8 <= balls_; k += 8) {
    const std::int64_t* m = meets + k;
    if ((((m[0] | m[1]) | (m[2] | m[3])) | ((m[4] | m[5]) | (m[6] | m[7]))) == 0) continue;
    for (int near = k; near < k + 8; ++near)
      if (meets[near] != 0) suspects[found++] = near;
  }
  for (; k < balls_; ++k)
    if (meets[k] != 0) suspects[found++] = k;
  return found;
}

}  // namespace edmill::engine
