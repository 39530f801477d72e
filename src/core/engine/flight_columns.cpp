#include "engine/flight_columns.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace edmill::engine {

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define EDMILL_FOR_SEVERAL_CPUS [[gnu::target_clones("avx2", "default")]]
#else
#define EDMILL_FOR_SEVERAL_CPUS
#endif
// For functions that the clones call: compiled alone, they would be for the oldest CPU. Clones must
// not end in a call: GCC 12 then omits vzeroupper, and all SSE code after it is slow.
#define EDMILL_INTO_CLONES [[gnu::always_inline]] static inline

namespace {

typedef double Four __attribute__((vector_size(32)));
typedef std::int64_t FourIntegers __attribute__((vector_size(32)));
typedef int FourPlaces __attribute__((vector_size(16)));
using Column = double[FlightBatch::capacity];

static_assert(sizeof(dynamics::Flight<double>) == 2 * sizeof(Four));

EDMILL_INTO_CLONES void load(const double* from, Four& four) {
  std::memcpy(&four, from, sizeof four);
}
EDMILL_INTO_CLONES void store(double* to, const Four& four) { std::memcpy(to, &four, sizeof four); }

/// Transposes flights into columns, four at a time: each flight is two vectors of four doubles.
/// @param balls  with room for a multiple of four
EDMILL_INTO_CLONES void gather(const dynamics::Flight<double>* flights, const double* radii,
    int stride, const int* balls, int count, FlightBatch& batch) {
  batch.radius[0] = radii[0];
  for (int k = 0; k < count; k += 4) {
    const int i0 = balls[k], i1 = balls[k + 1], i2 = balls[k + 2], i3 = balls[k + 3];
    const auto rows = [flights](int i) { return reinterpret_cast<const double*>(&flights[i]); };
    Four a0, a1, b0, b1, c0, c1, d0, d1;
    load(rows(i0), a0);
    load(rows(i1), b0);
    load(rows(i2), c0);
    load(rows(i3), d0);
    load(rows(i0) + 4, a1);
    load(rows(i1) + 4, b1);
    load(rows(i2) + 4, c1);
    load(rows(i3) + 4, d1);
    const Four ab0 = __builtin_shufflevector(a0, b0, 0, 4, 2, 6),
               cd0 = __builtin_shufflevector(c0, d0, 0, 4, 2, 6);
    const Four ab1 = __builtin_shufflevector(a0, b0, 1, 5, 3, 7),
               cd1 = __builtin_shufflevector(c0, d0, 1, 5, 3, 7);
    const Four ef0 = __builtin_shufflevector(a1, b1, 0, 4, 2, 6),
               gh0 = __builtin_shufflevector(c1, d1, 0, 4, 2, 6);
    const Four ef1 = __builtin_shufflevector(a1, b1, 1, 5, 3, 7),
               gh1 = __builtin_shufflevector(c1, d1, 1, 5, 3, 7);
    store(batch.position[0] + k, __builtin_shufflevector(ab0, cd0, 0, 1, 4, 5));
    store(batch.position[1] + k, __builtin_shufflevector(ab1, cd1, 0, 1, 4, 5));
    store(batch.position[2] + k, __builtin_shufflevector(ab0, cd0, 2, 3, 6, 7));
    store(batch.velocity[0] + k, __builtin_shufflevector(ab1, cd1, 2, 3, 6, 7));
    store(batch.velocity[1] + k, __builtin_shufflevector(ef0, gh0, 0, 1, 4, 5));
    store(batch.velocity[2] + k, __builtin_shufflevector(ef1, gh1, 0, 1, 4, 5));
    const Four periods = __builtin_shufflevector(ef0, gh0, 2, 3, 6, 7);
    std::memcpy(batch.period + k, &periods, sizeof periods);
    store(batch.offset + k, __builtin_shufflevector(ef1, gh1, 2, 3, 6, 7));
    if (stride != 0) store(batch.radius + k, Four{radii[i0], radii[i1], radii[i2], radii[i3]});
  }
}

/// Computes the times since the starts of the flights [s].
EDMILL_INTO_CLONES void find_ages(
    const FlightBatch& batch, const PairFilterQuery& query, int count, Column& ages) {
  // Whole periods are below 2^51: as the low bits of a double they need no conversion.
  constexpr double shift = 6755399441055744.0;  // 1.5 x 2^52
  constexpr std::int64_t bits_of_shift = 0x4338000000000000;
  const double drive = query.filter.period, now = query.now.offset;
  for (int k = 0; k < count; k += 4) {
    FourIntegers started;
    std::memcpy(&started, batch.period + k, sizeof started);
    const FourIntegers shifted = (query.now.period - started) + bits_of_shift;
    Four periods, offset;
    std::memcpy(&periods, &shifted, sizeof shifted);
    load(batch.offset + k, offset);
    store(ages + k, (periods - shift) * drive + (now - offset));
  }
}

/// One coordinate of the motion of the query's ball relative to each of the batch.
EDMILL_INTO_CLONES void find_motion(const FlightBatch& batch, const PairFilterQuery& query,
    int axis, int count, const Column& ages, Column& r, Column& v) {
  const double position = query.state.position[axis], velocity = query.state.velocity[axis];
  const double gravity = query.filter.gravity[axis];
  Four x, u, age;
  if (gravity == 0) {  // omitting it changes no bit of a contact
    for (int k = 0; k < count; k += 4) {
      load(batch.position[axis] + k, x);
      load(batch.velocity[axis] + k, u);
      load(ages + k, age);
      store(r + k, position - (x + age * u));
      store(v + k, velocity - u);
    }
  } else {
    for (int k = 0; k < count; k += 4) {
      load(batch.position[axis] + k, x);
      load(batch.velocity[axis] + k, u);
      load(ages + k, age);
      store(r + k, position - (x + age * (u + (age * 0.5) * gravity)));
      store(v + k, (velocity - u) + gravity * (query.state.age - age));
    }
  }
}

/// Computes the squared contact distances; only the first four if all balls are alike.
EDMILL_INTO_CLONES void find_squares(
    const FlightBatch& batch, double radius, bool alike, int count, Column& squares) {
  if (alike) {
    const double sum = radius + batch.radius[0];
    return std::fill(squares, squares + 4, sum * sum);
  }
  for (int k = 0; k < count; k += 4) {
    Four other;
    load(batch.radius + k, other);
    const Four sum = radius + other;
    store(squares + k, sum * sum);
  }
}

/// A bit mask of the lanes that are -1.
EDMILL_INTO_CLONES unsigned bits_of(const FourIntegers& lanes) {
#ifdef __SSE2__
  typedef double Two __attribute__((vector_size(16)));
  Two low, high;
  std::memcpy(&low, &lanes, sizeof low);
  std::memcpy(&high, reinterpret_cast<const char*>(&lanes) + sizeof low, sizeof high);
  return static_cast<unsigned>(__builtin_ia32_movmskpd(low) + 4 * __builtin_ia32_movmskpd(high));
#else
  return static_cast<unsigned>((lanes[0] & 1) + (lanes[1] & 2) + (lanes[2] & 4) + (lanes[3] & 8));
#endif
}

/// The indices of the lanes that are set in each bit mask, and their number, in four bits each.
constexpr auto lanes_by_bits = [] {
  std::array<std::array<int, 4>, 16> table{};
  for (int bits = 0; bits < 16; ++bits)
    for (int lane = 0, found = 0; lane < 4; ++lane)
      if ((bits >> lane & 1) != 0) table[bits][found++] = lane;
  return table;
}();
constexpr std::uint64_t counts_by_bits = 0x4332322132212110;

/// Applies PairFilter to a batch whose first ball has the place `first`. Each step is a short chain
/// of operations: the processor overlaps several vectors. A ball at exactly the same place is the
/// query's.
/// @param found  number of candidates so far
/// @return the number including this batch
EDMILL_INTO_CLONES int filter_batch(const FlightBatch& batch, const PairFilterQuery& query,
    bool alike, int first, int count, PairFilterResult& result, int found) {
  alignas(64) Column ages, rx, ry, rz, vx, vy, vz, squares;
  find_ages(batch, query, count, ages);
  find_motion(batch, query, 0, count, ages, rx, vx);
  find_motion(batch, query, 1, count, ages, ry, vy);
  find_motion(batch, query, 2, count, ages, rz, vz);
  find_squares(batch, query.radius, alike, count, squares);
  const int next_square = alike ? 0 : 1;
  const double relative = query.filter.relative, slowest = query.filter.slowest_squared,
               touching = query.filter.touching, grazing = query.filter.grazing;
  double *approach = result.approach() + first, *gap = result.gap() + first,
         *discriminants = result.discriminant() + first;
  int* candidates = result.candidates();
  for (int k = 0; k < count; k += 4) {
    Four x, y, z, u, v, w, square;
    load(rx + k, x);
    load(ry + k, y);
    load(rz + k, z);
    load(vx + k, u);
    load(vy + k, v);
    load(vz + k, w);
    load(squares + k * next_square, square);
    const Four b = x * u + y * v + z * w;
    const Four r2 = x * x + y * y + z * z;
    const Four v2 = u * u + v * v + w * w;
    const Four c = r2 - square;
    const Four discriminant = b * b - v2 * c, error = relative * (v2 * r2);
    const FourIntegers moving = v2 > slowest, clear = moving & (c > touching);
    const FourIntegers apart = (c > touching) & ((b >= 0) | (discriminant < -error));
    const FourIntegers parting = (b > 0) & (b * b > error);
    const FourIntegers meets = ~((moving & (apart | parting)) | (r2 == 0));
    store(approach + k, b);
    store(gap + k, c);
    const FourIntegers certain = clear & (discriminant > error + grazing);
    store(discriminants + k, certain ? discriminant : Four{} - 1.0);
    // Without branches: which lanes are candidates is unpredictable.
    const unsigned bits = bits_of(meets);
    FourPlaces places;
    std::memcpy(&places, &lanes_by_bits[bits], sizeof places);
    places += first + k;
    std::memcpy(candidates + found, &places, sizeof places);
    found += static_cast<int>(counts_by_bits >> (4 * bits) & 15);
  }
  return found;
}

}  // namespace

EDMILL_FOR_SEVERAL_CPUS int filter_pairs(const dynamics::Flight<double>* flights,
    const double* radii, int stride, const PairFilterQuery& query, int self, int* balls, int count,
    PairFilterResult& result) {
  balls[count] = balls[count + 1] = balls[count + 2] = self;
  FlightBatch batch;
  int found = 0;
  for (int first = 0; first < count; first += FlightBatch::capacity) {
    const int here = std::min(count - first, FlightBatch::capacity);
    gather(flights, radii, stride, balls + first, here, batch);
    found = filter_batch(batch, query, stride == 0, first, here, result, found);
  }
  return found;
}

EDMILL_FOR_SEVERAL_CPUS int filter_all_pairs(const FlightBatch* batches, int balls, bool alike,
    const PairFilterQuery& query, PairFilterResult& result) {
  int found = 0;
  for (int first = 0; first < balls; first += FlightBatch::capacity) {
    const int here = std::min(balls - first, FlightBatch::capacity);
    const auto& batch = batches[first / FlightBatch::capacity];
    found = filter_batch(batch, query, alike, first, here, result, found);
  }
  return found;
}

int FlightColumns::filter(const PairFilterQuery& query, PairFilterResult& result) const {
  result.make_room(balls_);
  int found = filter_all_pairs(batches_.data(), balls_, alike_, query, result);
  if (balls_ % 4 != 0)  // the last four places of a batch are not all balls
    while (found > 0 && result.candidates()[found - 1] >= balls_) --found;
  return found;
}

void PairFilterResult::grow(int count) {
  room_ = 2 * count;
  const auto size = static_cast<std::size_t>(room_) + 8;
  candidates_.resize(size);
  for (auto* column : {&approach_, &gap_, &discriminant_}) column->resize(size);
}

}  // namespace edmill::engine
