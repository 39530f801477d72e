// The flights of all balls in columns, for asking about one ball and all others at once.
#pragma once

#include <vector>

#include "edmill/dynamics/pair_search.hpp"

namespace edmill::engine {

/// One ball as seen now, and what would make another one worth a closer look.
template <class Real>
struct PairQuestion {
  typename dynamics::PairSearch<Real>::Seen seen;
  Real radius;
  Real now_period, now_offset;  ///< the instant, in the columns' terms
  dynamics::PairFilter<Real> filter;
};

/// Flights by columns: the compiler turns a loop over them into vector instructions.
template <class Real>
struct FlightColumns {
  std::vector<Real> x, y, z, u, v, w, period, offset, radius;
};

/// hits[k] becomes 0 where ball k is proven never to meet the one of the question. For
/// double it is compiled for several instruction sets, all with the same bits since nothing is contracted.
template <class Real>
void mark_candidates(const FlightColumns<Real>& flights, const PairQuestion<Real>& question,
                     std::vector<Real>& hits);

/// Where cells are of no use this looks at every ball.
template <class Real>
class FlightTable {
 public:
  explicit FlightTable(std::size_t balls) : hits_(balls) {
    for (auto* column : {&f_.x, &f_.y, &f_.z, &f_.u, &f_.v, &f_.w, &f_.period, &f_.offset, &f_.radius})
      column->resize(balls);
  }

  void set(int ball, const dynamics::Flight<Real>& flight, const Real& radius) {
    f_.x[ball] = flight.position[0], f_.y[ball] = flight.position[1], f_.z[ball] = flight.position[2];
    f_.u[ball] = flight.velocity[0], f_.v[ball] = flight.velocity[1], f_.w[ball] = flight.velocity[2];
    f_.period[ball] = static_cast<Real>(flight.start.period);
    f_.offset[ball] = flight.start.offset;
    f_.radius[ball] = radius;
  }

  /// Calls `visit(other)` for every ball that is not proven to pass by, the ball
  /// itself included.
  template <class Visit>
  void visit_candidates(const PairQuestion<Real>& question, Visit&& visit) {
    mark_candidates<Real>(f_, question, hits_);
    const int n = static_cast<int>(hits_.size());
    // Hits are rare: look at eight at a time.
    int k = 0;
    for (; k + 8 <= n; k += 8) {
      const Real* h = &hits_[k];
      if (((h[0] + h[1]) + (h[2] + h[3])) + ((h[4] + h[5]) + (h[6] + h[7])) == 0) continue;
      for (int m = k; m < k + 8; ++m)
        if (hits_[m] != 0) visit(m);
    }
    for (; k < n; ++k)
      if (hits_[k] != 0) visit(k);
  }

 private:
  FlightColumns<Real> f_;
  std::vector<Real> hits_;
};

}  // namespace edmill::engine
