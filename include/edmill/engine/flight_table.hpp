// Which balls may meet one ball: the pair filter for many flights at once.
#pragma once

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

/// Flights by columns: the compiler turns a loop over them into vector instructions.
struct FlightColumns {
  std::vector<double> x, y, z, u, v, w, period, offset, radius;
};

/// hits[k] becomes 0 where ball k is proven never to meet the one of the question. Compiled for several
/// instruction sets, all with the same bits since nothing is contracted.
void mark_candidates(const FlightColumns& flights, const PairQuestion& question, std::vector<double>& hits);

/// Keeps those of `balls` that are not proven never to meet the one of the question, in their order.
/// @param flights, radii  of all balls; ball i has radius radii[i * stride]
/// @param balls  room for `count` rounded up to a multiple of four
/// @return how many were kept. The same bits for several instruction sets, as above.
int keep_candidates(const dynamics::Flight<double>* flights, const double* radii, int stride,
                    const PairQuestion& question, int* balls, int count);

/// Where cells are of no use this looks at every ball.
class FlightTable {
 public:
  explicit FlightTable(std::size_t balls) : hits_(balls) {
    for (auto* column : {&f_.x, &f_.y, &f_.z, &f_.u, &f_.v, &f_.w, &f_.period, &f_.offset, &f_.radius})
      column->resize(balls);
  }

  void set(int ball, const dynamics::Flight<double>& flight, double radius) {
    f_.x[ball] = flight.position[0], f_.y[ball] = flight.position[1], f_.z[ball] = flight.position[2];
    f_.u[ball] = flight.velocity[0], f_.v[ball] = flight.velocity[1], f_.w[ball] = flight.velocity[2];
    f_.period[ball] = static_cast<double>(flight.start.period);
    f_.offset[ball] = flight.start.offset;
    f_.radius[ball] = radius;
  }

  /// Calls `visit(other)` for every ball that is not proven to pass by, the ball
  /// itself included.
  template <class Visit>
  void visit_candidates(const PairQuestion& question, Visit&& visit) {
    mark_candidates(f_, question, hits_);
    const int n = static_cast<int>(hits_.size());
    // Hits are rare: look at eight at a time.
    int k = 0;
    for (; k + 8 <= n; k += 8) {
      const double* h = &hits_[k];
      if (((h[0] + h[1]) + (h[2] + h[3])) + ((h[4] + h[5]) + (h[6] + h[7])) == 0) continue;
      for (int m = k; m < k + 8; ++m)
        if (hits_[m] != 0) visit(m);
    }
    for (; k < n; ++k)
      if (hits_[k] != 0) visit(k);
  }

 private:
  FlightColumns f_;
  std::vector<double> hits_;
};

}  // namespace edmill::engine
