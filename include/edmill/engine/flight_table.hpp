// Which balls may meet one ball: the pair filter for many flights at once.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "edmill/dynamics/pair_search.hpp"

namespace edmill::engine {

/// One ball as seen now, and what would make another one worth a closer look.
struct PairQuestion {
  const dynamics::PairSearch<double>::Seen& seen;
  double radius;
  Instant<double> now;
  const dynamics::PairFilter<double>& filter;
};

/// Flights by columns, with room for a multiple of four.
struct FlightColumns {
  std::vector<double> x, y, z, u, v, w, period, offset, radius;
};

/// What the filter saw of each ball looked at, and which of them are left: the suspects. Room only grows.
class Looks {
 public:
  /// For so many balls, rounded up to a multiple of four.
  void make_room(int count) {
    const std::size_t size = (static_cast<std::size_t>(count) + 7) / 4 * 4;
    if (suspects_.size() >= size) return;
    suspects_.resize(size), meets_.resize(size);
    approach_.resize(size), gap_.resize(size), discriminant_.resize(size);
  }

  /// Until the contact with the k-th ball looked at [s]; negative where only a closer look can tell. (3.1)
  double delay(int k) const {
    return discriminant_[k] < 0 ? -1.0 : gap_[k] / (std::sqrt(discriminant_[k]) - approach_[k]);
  }

  int* suspects() { return suspects_.data(); }     ///< places of the suspects among the balls looked at
  std::int64_t* meets() { return meets_.data(); }  ///< -1 for a suspect and 0 else
  double* approach() { return approach_.data(); }  ///< b = r.v of (3.1)
  double* gap() { return gap_.data(); }            ///< c = r.r - R^2
  double* discriminant() { return discriminant_.data(); }  ///< b^2 - v.v c; -1 where its sign is open

 private:
  std::vector<int> suspects_;
  std::vector<std::int64_t> meets_;
  std::vector<double> approach_, gap_, discriminant_;
};

/// Fills the columns of `looks`, which have room for all balls. Compiled for several instruction sets, all
/// with the same bits since nothing is contracted.
void look_at_all(const FlightColumns& flights, const PairQuestion& question, Looks& looks);

/// The same for a list of balls, and finds the suspects among them.
/// @param flights, radii  of all balls; ball i has radius radii[i * stride]
/// @param self            the ball of the question, which is never a suspect
/// @param balls, looks    with room for three more than `count`
/// @return how many suspects there are
int look_at(const dynamics::Flight<double>* flights, const double* radii, int stride,
            const PairQuestion& question, int self, int* balls, int count, Looks& looks);

/// Where cells are of no use this looks at every ball.
class FlightTable {
 public:
  explicit FlightTable(int balls) : balls_(balls) {
    for (auto* column : {&f_.x, &f_.y, &f_.z, &f_.u, &f_.v, &f_.w, &f_.period, &f_.offset, &f_.radius})
      column->resize((static_cast<std::size_t>(balls) + 3) / 4 * 4);
  }

  void set(int ball, const dynamics::Flight<double>& flight, double radius) {
    f_.x[ball] = flight.position[0], f_.y[ball] = flight.position[1], f_.z[ball] = flight.position[2];
    f_.u[ball] = flight.velocity[0], f_.v[ball] = flight.velocity[1], f_.w[ball] = flight.velocity[2];
    f_.period[ball] = static_cast<double>(flight.start.period);
    f_.offset[ball] = flight.start.offset;
    f_.radius[ball] = radius;
  }

  /// Finds the suspects among all balls; the k-th ball looked at is ball k.
  /// @return how many there are
  int look(const PairQuestion& question, Looks& looks) const;

 private:
  int balls_;
  FlightColumns f_;
};

}  // namespace edmill::engine
