// Which balls may meet one ball: the pair filter for many flights at once.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "dynamics/pair_search.hpp"

namespace edmill::engine {

/// A query of the pair filter: the state of one ball now, and the constants of the filter.
struct PairFilterQuery {
  const dynamics::PairSearch<double>::State& state;
  double radius;
  Instant<double> now;
  const dynamics::PairFilter<double>& filter;
};

/// A batch of flights, stored in columns.
struct alignas(64) FlightBatch {
  static constexpr int capacity = 64;
  double position[3][capacity], velocity[3][capacity];  ///< at the start, by axis
  std::int64_t period[capacity];                        ///< of the start
  double offset[capacity];                              ///< of the start
  double radius[capacity];  ///< only the first is used if all balls are alike
};

/// The results of the filter for each ball, and the list of candidates. The capacity only grows.
class PairFilterResult {
 public:
  /// Makes room for this many balls, rounded up to a multiple of four.
  void make_room(int count) {
    if (count > room_) [[unlikely]]
      grow(count);
  }

  /// Time until the contact with the k-th ball [s], (3.1); negative if a pair search must decide.
  double delay(int k) const {
    return discriminant_[k] < 0 ? -1.0 : gap_[k] / (std::sqrt(discriminant_[k]) - approach_[k]);
  }

  int* candidates() {
    return candidates_.data();
  }  ///< places of the candidates among the balls filtered
  double* approach() { return approach_.data(); }  ///< b = r.v of (3.1)
  double* gap() { return gap_.data(); }            ///< c = r.r - R^2
  double* discriminant() {
    return discriminant_.data();
  }  ///< b^2 - v.v c; -1 if its sign is uncertain
 private:
  void grow(int count);

  int room_ = 0;
  std::vector<int> candidates_;
  std::vector<double> approach_, gap_, discriminant_;
};

/// Finds the candidates in a list of balls, and returns their number. Compiled for several
/// instruction sets, which all give the same bits since no operations are contracted.
/// @param flights, radii  of all balls; ball i has radius radii[i * stride]
/// @param self            the ball of the query, which is never a candidate
/// @param balls, result   with room for three more than `count`
int filter_pairs(const dynamics::Flight<double>* flights, const double* radii, int stride,
    const PairFilterQuery& query, int self, int* balls, int count, PairFilterResult& result);

/// Filters the first `balls` of `batches`, rounded up to a multiple of four, in the same way.
int filter_all_pairs(const FlightBatch* batches, int balls, bool alike,
    const PairFilterQuery& query, PairFilterResult& result);

/// The flights of all balls, for the filter to test every ball where cells do not help.
class FlightColumns {
 public:
  /// @param alike  whether all balls have one radius
  FlightColumns(int balls, bool alike)
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

  /// Finds the candidates among all balls; the k-th ball filtered is ball k. @return their number
  int filter(const PairFilterQuery& query, PairFilterResult& result) const;
 private:
  int balls_;
  bool alike_;
  std::vector<FlightBatch> batches_;
};

}  // namespace edmill::engine
