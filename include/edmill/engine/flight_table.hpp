// Which balls may meet one ball: the pair filter for many flights at once.
#pragma once

#include <cmath>
#include <vector>

#include "edmill/dynamics/pair_search.hpp"

namespace edmill::engine {

/// One ball as seen now, and what would make another one worth a closer look.
struct PairQuestion {
  dynamics::PairSearch<double>::Seen seen;
  double radius;
  Instant<double> now;
  dynamics::PairFilter<double> filter;
};

/// Flights by columns, with room for a multiple of four.
struct FlightColumns {
  std::vector<double> x, y, z, u, v, w, period, offset, radius;
};

/// A ball that may meet the one of a question.
struct Suspect {
  int ball;
  double delay;  ///< until they meet [s]; negative where only a closer look can tell
};

/// What the filter saw, one entry for each ball looked at, and what is left of it: the suspects. Room only
/// grows.
class Looks {
 public:
  std::vector<double> passes;        ///< 1 where the two are proven never to meet, -1 elsewhere
  std::vector<double> approach;      ///< b = r.v of (3.1)
  std::vector<double> gap;           ///< c = r.r - R^2
  std::vector<double> discriminant;  ///< b^2 - v.v c; negative where rounding leaves its sign open

  /// For so many balls, rounded up to a multiple of four.
  void make_room(int count) {
    const std::size_t size = (static_cast<std::size_t>(count) + 3) / 4 * 4;
    if (passes.size() >= size) return;
    passes.resize(size), approach.resize(size), gap.resize(size), discriminant.resize(size);
    place_.resize(size), suspects_.resize(size);
  }

  /// Picks the suspects among `count` balls, in their order; entry k of the columns belongs to ball balls[k].
  void pick(const int* balls, int count);
  /// The same where entry k belongs to ball k.
  void pick_all(int count);

  const Suspect* begin() const { return suspects_.data(); }
  const Suspect* end() const { return suspects_.data() + found_; }

 private:
  /// (3.1)
  double delay(int k) const {
    return discriminant[k] < 0 ? -1.0 : gap[k] / (std::sqrt(discriminant[k]) - approach[k]);
  }

  std::vector<int> place_;
  std::vector<Suspect> suspects_;
  int found_ = 0;
};

/// Fills the columns of `looks`, which have room for all balls. Compiled for several instruction sets, all
/// with the same bits since nothing is contracted.
void look_at_all(const FlightColumns& flights, const PairQuestion& question, Looks& looks);

/// The same for a list of balls.
/// @param flights, radii  of all balls; ball i has radius radii[i * stride]
/// @param balls, looks  with room for `count` rounded up to a multiple of four
void look_at(const dynamics::Flight<double>* flights, const double* radii, int stride,
             const PairQuestion& question, int* balls, int count, Looks& looks);

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

  /// Suspects among all balls, the ball of the question itself included.
  void look(const PairQuestion& question, Looks& looks) const {
    looks.make_room(balls_);
    look_at_all(f_, question, looks);
    looks.pick_all(balls_);
  }

 private:
  int balls_;
  FlightColumns f_;
};

}  // namespace edmill::engine
