// Neighbour grid in the inertial frame: a ball meets only balls of its own and the adjacent cells.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "edmill/core/errors.hpp"
#include "edmill/core/vector.hpp"

namespace edmill::engine {

/// Which face of its cell a ball leaves through, and when.
template <class Real>
struct Crossing {
  bool happens = false;
  Real delay{};  ///< from now [s]
  int axis = 0;
  int step = 0;  ///< -1 or +1
};

/// Cells are never thinner than the largest ball plus a margin that dwarfs the rounding of crossing times, so
/// a crossing that is late by rounding hides no contact. The outermost cells are open to the outside.
template <class Real>
class CellGrid {
 public:
  /// @param low, high  corners of the region that the balls' centres sweep [m]
  /// @param edge       least edge of a cell [m]
  CellGrid(const Vec3<Real>& low, const Vec3<Real>& high, const Real& edge, int balls)
      : low_(low), next_(balls, -1), previous_(balls, -1), place_(balls) {
    for (int k = 0; k < 3; ++k) {
      const Real extent = high[k] - low[k];
      const double count = std::floor(static_cast<double>(extent / edge));
      cells_[k] = count < 1 ? 1 : count > 512 ? 512 : static_cast<int>(count);
      edge_[k] = extent / cells_[k];
    }
    first_.assign(static_cast<std::size_t>(cells_[0]) * cells_[1] * cells_[2], -1);
  }

  int cells(int axis) const { return cells_[axis]; }
  bool single_cell() const { return first_.size() == 1; }

  void insert(int ball, const Vec3<Real>& position) {
    for (int k = 0; k < 3; ++k) {
      const Real place = (position[k] - low_[k]) / edge_[k];
      int cell = place > 0 ? static_cast<int>(place) : 0;
      if (cell >= cells_[k]) cell = cells_[k] - 1;
      place_[ball][k] = cell;
    }
    link(ball);
  }

  void move(int ball, int axis, int step) {
    unlink(ball);
    place_[ball][axis] += step;
    link(ball);
  }

  /// When the ball, now at `position` with `velocity`, leaves its cell.
  Crossing<Real> crossing(int ball, const Vec3<Real>& position, const Vec3<Real>& velocity,
                          const Vec3<Real>& gravity) const {
    Crossing<Real> best;
    for (int k = 0; k < 3; ++k) {
      const int cell = place_[ball][k];
      const Real lower = low_[k] + cell * edge_[k];
      if (cell + 1 < cells_[k])
        consider(best, (lower + edge_[k]) - position[k], velocity[k], gravity[k], k, 1);
      if (cell > 0) consider(best, position[k] - lower, -velocity[k], -gravity[k], k, -1);
    }
    return best;
  }

  /// Calls `visit(other)` for every ball in the ball's cell and the adjacent ones, itself included.
  template <class Visit>
  void visit_neighbours(int ball, Visit&& visit) const {
    const auto [low, high] = neighbourhood(ball);
    visit_block(low, high, visit);
  }

  /// The same for the cells that became adjacent when the ball moved by `step` along `axis`.
  template <class Visit>
  void visit_new_neighbours(int ball, int axis, int step, Visit&& visit) const {
    auto [low, high] = neighbourhood(ball);
    const int face = place_[ball][axis] + step;
    if (face < 0 || face >= cells_[axis]) return;
    low[axis] = high[axis] = face;
    visit_block(low, high, visit);
  }

 private:
  using Place = std::array<int, 3>;

  /// Time to cover `distance` >= 0 with `speed` and constant `acceleration` towards it.
  static void consider(Crossing<Real>& best, const Real& distance, const Real& speed,
                       const Real& acceleration, int axis, int step) {
    using std::sqrt;
    const Real d = distance > 0 ? distance : Real(0);
    const Real discriminant = speed * speed + 2 * (acceleration * d);
    if (discriminant < 0) return;
    const Real root = sqrt(discriminant);
    Real delay;
    if (speed >= 0) {
      if (!(speed + root > 0)) return;
      delay = 2 * d / (speed + root);
    } else {
      if (!(acceleration > 0)) return;
      delay = (root - speed) / acceleration;
    }
    if (!best.happens || delay < best.delay) best = {true, delay, axis, step};
  }

  std::pair<Place, Place> neighbourhood(int ball) const {
    Place low = place_[ball], high = place_[ball];
    for (int k = 0; k < 3; ++k) {
      if (low[k] > 0) --low[k];
      if (high[k] + 1 < cells_[k]) ++high[k];
    }
    return {low, high};
  }

  template <class Visit>
  void visit_block(const Place& low, const Place& high, Visit&& visit) const {
    for (int z = low[2]; z <= high[2]; ++z)
      for (int y = low[1]; y <= high[1]; ++y)
        for (int x = low[0]; x <= high[0]; ++x)
          for (int other = first_[index({x, y, z})]; other >= 0; other = next_[other]) visit(other);
  }

  std::size_t index(const Place& p) const {
    return (static_cast<std::size_t>(p[2]) * cells_[1] + p[1]) * cells_[0] + p[0];
  }
  void link(int ball) {
    int& head = first_[index(place_[ball])];
    next_[ball] = head;
    previous_[ball] = -1;
    if (head >= 0) previous_[head] = ball;
    head = ball;
  }
  void unlink(int ball) {
    if (next_[ball] >= 0) previous_[next_[ball]] = previous_[ball];
    (previous_[ball] >= 0 ? next_[previous_[ball]] : first_[index(place_[ball])]) = next_[ball];
  }

  Vec3<Real> low_;
  std::array<Real, 3> edge_;
  Place cells_;
  std::vector<int> first_, next_, previous_;
  std::vector<Place> place_;
};

}  // namespace edmill::engine
