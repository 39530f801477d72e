// Which balls may meet one ball: the pair filter for many flights at once.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "dynamics/pair_search.hpp"

namespace edmill::engine {

/// One ball as seen now, and what would make another one worth a closer look.
struct PairQuestion {
  const dynamics::PairSearch<double>::Seen& seen;
  double radius;
  Instant<double> now;
  const dynamics::PairFilter<double>& filter;
};

/// Some flights by columns.
struct alignas(64) FlightBatch {
  static constexpr int capacity = 64;
  double position[3][capacity], velocity[3][capacity];  ///< at the start, by axis
  std::int64_t period[capacity];                        ///< of the start
  double offset[capacity];                              ///< of the start
  double radius[capacity];                              ///< the first one serves for all when they are alike
};

/// What the filter saw of each ball looked at, and which of them are left: the suspects. Room only grows.
class Looks {
 public:
  /// For so many balls, rounded up to a multiple of four.
  void make_room(int count) {
    if (count > room_) [[unlikely]]
      grow(count);
  }

  /// Until the contact with the k-th ball looked at [s]; negative where only a closer look can tell. (3.1)
  double delay(int k) const {
    return discriminant_[k] < 0 ? -1.0 : gap_[k] / (std::sqrt(discriminant_[k]) - approach_[k]);
  }

  int* suspects() { return suspects_.data(); }     ///< places of the suspects among the balls looked at
  double* approach() { return approach_.data(); }  ///< b = r.v of (3.1)
  double* gap() { return gap_.data(); }            ///< c = r.r - R^2
  double* discriminant() { return discriminant_.data(); }  ///< b^2 - v.v c; -1 where its sign is open

 private:
  void grow(int count);

  int room_ = 0;
  std::vector<int> suspects_;
  std::vector<double> approach_, gap_, discriminant_;
};

/// Looks at a list of balls and finds the suspects among them. Compiled for several instruction sets, all
/// with the same bits since nothing is contracted.
/// @param flights, radii  of all balls; ball i has radius radii[i * stride]
/// @param self            the ball of the question, which is never a suspect
/// @param balls, looks    with room for three more than `count`
/// @return how many suspects there are
int look_at(const dynamics::Flight<double>* flights, const double* radii, int stride,
            const PairQuestion& question, int self, int* balls, int count, Looks& looks);

/// The same for the first `balls` of `batches`, which have room for a multiple of four: those beyond the last
/// are looked at, too.
int look_at_all(const FlightBatch* batches, int balls, bool alike, const PairQuestion& question,
                Looks& looks);

/// Where cells are of no use this looks at every ball.
class FlightTable {
 public:
  /// @param alike  whether all balls have one radius
  FlightTable(int balls, bool alike)
      : balls_(balls), alike_(alike), batches_(balls / FlightBatch::capacity + 1) {}

  void set(int ball, const dynamics::Flight<double>& flight, double radius) {
    FlightBatch& batch = batches_[ball / FlightBatch::capacity];
    const int place = ball % FlightBatch::capacity;
    for (int k = 0; k < 3; ++k) batch.position[k][place] = flight.position[k];
    for (int k = 0; k < 3; ++k) batch.velocity[k][place] = flight.velocity[k];
    batch.period[place] = flight.start.period;
    batch.offset[place] = flight.start.offset;
    batch.radius[place] = radius;
  }

  /// Finds the suspects among all balls; the k-th ball looked at is ball k.
  /// @return how many there are
  int look(const PairQuestion& question, Looks& looks) const;

 private:
  int balls_;
  bool alike_;
  std::vector<FlightBatch> batches_;
};

}  // namespace edmill::engine
