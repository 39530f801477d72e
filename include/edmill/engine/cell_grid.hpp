// Neighbour grid in the inertial frame: a ball meets only balls of its own and the adjacent cells.
#pragma once

#include <array>
#include <cmath>
#include <unordered_map>
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

/// Balls that a look at the cells found; its room only grows.
struct FoundBalls {
  std::vector<int> balls;
  int count = 0;
};

/// Cells are never thinner than the largest ball plus a margin that dwarfs the rounding of crossing times, so
/// a crossing that is late by rounding hides no contact. The outermost cells are open to the outside.
template <class Real>
class CellGrid {
 public:
  /// @param low, high  corners of the region that the balls' centres sweep [m]
  /// @param edge       least edge of a cell [m]
  CellGrid(const Vec3<Real>& low, const Vec3<Real>& high, const Real& edge, int balls)
      : low_(low), place_(balls) {
    for (int k = 0; k < 3; ++k) {
      const Real extent = high[k] - low[k];
      const double count = std::floor(static_cast<double>(extent / edge));
      cells_[k] = count < 1 ? 1 : count > 512 ? 512 : static_cast<int>(count);
      edge_[k] = extent / cells_[k];
    }
    content_.resize(static_cast<std::size_t>(cells_[0]) * cells_[1] * cells_[2]);
  }

  int cells(int axis) const { return cells_[axis]; }
  bool single_cell() const { return content_.size() == 1; }

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

  /// Finds every ball in the ball's cell and the adjacent ones, itself included.
  void neighbours(int ball, FoundBalls& found) const {
    const auto [low, high] = neighbourhood(ball);
    collect(low, high, found);
  }

  /// The same for the cells that became adjacent when the ball moved by `step` along `axis`.
  void new_neighbours(int ball, int axis, int step, FoundBalls& found) const {
    auto [low, high] = neighbourhood(ball);
    const int face = place_[ball][axis] + step;
    found.count = 0;
    if (face < 0 || face >= cells_[axis]) return;
    low[axis] = high[axis] = face;
    collect(low, high, found);
  }

 private:
  using Place = std::array<int, 3>;

  /// Time to cover `distance` >= 0 with `speed` and constant `acceleration` towards it.
  static void consider(Crossing<Real>& best, const Real& distance, const Real& speed,
                       const Real& acceleration, int axis, int step) {
    using std::sqrt;
    const Real d = distance > 0 ? distance : Real(0);
    if (acceleration == 0) {
      if (!(speed > 0)) return;
      const Real delay = d / speed;
      if (!best.happens || delay < best.delay) best = {true, delay, axis, step};
      return;
    }
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

  /// A cell holds its first balls itself; more than that are rare, and chained.
  struct Cell {
    static constexpr int inside = 3;
    int count = 0;
    std::array<int, inside> balls{};
  };

  /// Copies without asking how many there are: a branch for each of 27 mostly empty cells costs more.
  void collect(const Place& low, const Place& high, FoundBalls& found) const {
    constexpr std::size_t room = 28 * Cell::inside;
    if (found.balls.size() < room) found.balls.resize(room);
    int* out = found.balls.data();
    for (int z = low[2]; z <= high[2]; ++z)
      for (int y = low[1]; y <= high[1]; ++y) {
        const Cell* cell = &content_[index({low[0], y, z})];
        for (int x = low[0]; x <= high[0]; ++x, ++cell) {
          for (int k = 0; k < Cell::inside; ++k) out[k] = cell->balls[k];
          out += cell->count < Cell::inside ? cell->count : Cell::inside;
          if (cell->count > Cell::inside) [[unlikely]]
            out = append_chain(index({x, y, z}), out, found, room);
        }
      }
    found.count = static_cast<int>(out - found.balls.data());
  }

  int* append_chain(std::size_t cell, int* out, FoundBalls& found, std::size_t room) const {
    const auto& chain = overflow_.at(cell);
    const auto at = static_cast<std::size_t>(out - found.balls.data());
    if (found.balls.size() < at + chain.size() + room) found.balls.resize(at + chain.size() + room);
    out = found.balls.data() + at;
    for (const int ball : chain) *out++ = ball;
    return out;
  }

  std::size_t index(const Place& p) const {
    return (static_cast<std::size_t>(p[2]) * cells_[1] + p[1]) * cells_[0] + p[0];
  }
  void link(int ball) {
    const auto at = index(place_[ball]);
    Cell& cell = content_[at];
    if (cell.count < Cell::inside)
      cell.balls[cell.count] = ball;
    else
      overflow_[at].push_back(ball);
    ++cell.count;
  }
  void unlink(int ball) {
    const auto at = index(place_[ball]);
    Cell& cell = content_[at];
    int last;
    if (cell.count > Cell::inside) {
      auto& more = overflow_.at(at);
      last = more.back();
      more.pop_back();
      for (int& other : more)
        if (other == ball) other = last;
    } else {
      last = cell.balls[cell.count - 1];
    }
    // What stands beyond `count` is of no account, so no branch is needed for it.
    for (int& other : cell.balls) other = other == ball ? last : other;
    --cell.count;
  }

  Vec3<Real> low_;
  std::array<Real, 3> edge_;
  Place cells_;
  std::vector<Cell> content_;
  std::unordered_map<std::size_t, std::vector<int>> overflow_;
  std::vector<Place> place_;
};

}  // namespace edmill::engine
