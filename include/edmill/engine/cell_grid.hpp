// Neighbour grid in the inertial frame: a ball meets only balls of its own and the adjacent cells.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <unordered_map>
#include <vector>

#include "edmill/core/archive.hpp"
#include "edmill/core/errors.hpp"
#include "edmill/core/vector.hpp"

namespace edmill::engine {

/// Which face of its cell a ball leaves through, and when.
struct Crossing {
  bool happens = false;
  double delay = 0;  ///< from now [s]
  int axis = 0;
  int step = 0;  ///< -1 or +1
};

/// Balls that a look at the cells found; its room only grows.
struct FoundBalls {
  std::vector<int> balls;
  int count = 0;
};

/// Cells are never thinner than the largest ball plus a margin that dwarfs the rounding of crossing times, so
/// a crossing that is late by rounding hides no contact; that is why double serves every scalar. The
/// outermost cells are open to the outside.
class CellGrid {
 public:
  /// @param low, high  corners of the region that the balls' centres sweep [m]
  /// @param edge       least edge of a cell [m]
  CellGrid(const Vec3<double>& low, const Vec3<double>& high, double edge, int balls)
      : low_(low), place_(balls) {
    for (int k = 0; k < 3; ++k) {
      const double extent = high[k] - low[k];
      const double count = std::floor(extent / edge);
      cells_[k] = count < 1 ? 1 : count > 512 ? 512 : static_cast<int>(count);
      edge_[k] = extent / cells_[k];
    }
    content_.resize(static_cast<std::size_t>(cells_[0]) * cells_[1] * cells_[2]);
  }

  int cells(int axis) const { return cells_[axis]; }
  bool single_cell() const { return content_.size() == 1; }

  void insert(int ball, const Vec3<double>& position) {
    for (int k = 0; k < 3; ++k) {
      const double place = (position[k] - low_[k]) / edge_[k];
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
  Crossing crossing(int ball, const Vec3<double>& position, const Vec3<double>& velocity,
                    const Vec3<double>& gravity) const {
    Crossing best;
    for (int k = 0; k < 3; ++k) {
      const double lower = low_[k] + place_[ball][k] * edge_[k];
      const double above = (lower + edge_[k]) - position[k], below = position[k] - lower;
      const bool falls_up = gravity[k] > 0;
      if (gravity[k] == 0)
        drift(best, ball, k, above, below, velocity[k]);
      else if (falls_up)
        fall(best, ball, k, 1, above, below, velocity[k], gravity[k]);
      else
        fall(best, ball, k, -1, below, above, -velocity[k], -gravity[k]);
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

  /// Which balls are where, and their order in each cell: it is that of the searches.
  void archive(Archive& a) {
    std::vector<std::pair<std::size_t, std::vector<int>>> overflow(overflow_.begin(), overflow_.end());
    std::vector<std::pair<std::size_t, Cell>> occupied;  // most are empty
    for (std::size_t at = 0; at < content_.size(); ++at)
      if (content_[at].count > 0) occupied.emplace_back(at, content_[at]);
    a(occupied, overflow, place_);
    if (!a.loading()) return;
    overflow_ = {overflow.begin(), overflow.end()};
    std::fill(content_.begin(), content_.end(), Cell());
    for (const auto& [at, cell] : occupied) content_.at(at) = cell;
  }

 private:
  using Place = std::array<int, 3>;

  bool is_inner_face(int ball, int axis, int step) const {
    const int next = place_[ball][axis] + step;
    return (next >= 0) & (next < cells_[axis]);
  }

  static void keep_earlier(Crossing& best, bool reached, double delay, int axis, int step) {
    if (reached && (!best.happens || delay < best.delay)) best = {true, delay, axis, step};
  }

  /// Along an axis without gravity.
  void drift(Crossing& best, int ball, int axis, double above, double below, double speed) const {
    const bool up = speed > 0;
    const int step = up ? 1 : -1;
    const double distance = up ? above : below;
    const double size = up ? speed : -speed;
    const bool reached = (size > 0) & is_inner_face(ball, axis, step);
    keep_earlier(best, reached, (distance > 0 ? distance : 0.0) / size, axis, step);
  }

  /// Along an axis with gravity, which points to `step`: a ball that moves against it may reach the far face
  /// first, and falls to the near one otherwise. Which of them is a coin toss, so one formula serves both.
  void fall(Crossing& best, int ball, int axis, int step, double ahead, double behind, double speed,
            double gravity) const {
    const double far = behind > 0 ? behind : 0.0, near = ahead > 0 ? ahead : 0.0;
    const double square = speed * speed, turning = square - 2 * (gravity * far);
    const bool against = speed < 0;
    const bool back = against & (turning >= 0) & is_inner_face(ball, axis, -step);
    const double distance = back ? far : near;
    const double root = std::sqrt(back ? turning : square + 2 * (gravity * near));
    const double size = against ? -speed : speed;
    const bool rises_first = against & !back;  // where root - speed is free of cancellation
    const double numerator = rises_first ? root + size : 2 * distance;
    const double denominator = rises_first ? gravity : size + root;
    const bool reached = (back | is_inner_face(ball, axis, step)) & (denominator > 0);
    keep_earlier(best, reached, numerator / denominator, axis, back ? -step : step);
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
  struct alignas(16) Cell {
    static constexpr int inside = 3;
    std::array<int, inside> balls{};
    int count = 0;  ///< of those inside; `crowded` is added when there are more

    void archive(Archive& a) { a(balls, count); }
  };
  static constexpr int crowded = 4;

  /// Copies whole cells without asking how full they are: a branch for each of 27 mostly empty ones costs
  /// more.
  void collect(const Place& low, const Place& high, FoundBalls& found) const {
    constexpr std::size_t room = 28 * Cell::inside + 4;
    if (found.balls.size() < room) found.balls.resize(room);
    int* out = found.balls.data();
    int seen = 0;
    for (int z = low[2]; z <= high[2]; ++z)
      for (int y = low[1]; y <= high[1]; ++y) {
        const Cell* cell = &content_[index({low[0], y, z})];
        for (int x = low[0]; x <= high[0]; ++x, ++cell) {
          std::memcpy(out, cell, sizeof(Cell));
          out += cell->count & 3;
          seen |= cell->count;
        }
      }
    found.count = static_cast<int>(out - found.balls.data());
    if (seen & crowded) [[unlikely]]
      append_chains(low, high, found);
  }

  void append_chains(const Place& low, const Place& high, FoundBalls& found) const {
    for (int z = low[2]; z <= high[2]; ++z)
      for (int y = low[1]; y <= high[1]; ++y)
        for (int x = low[0]; x <= high[0]; ++x) {
          const auto at = index({x, y, z});
          if (!(content_[at].count & crowded)) continue;
          const auto& chain = overflow_.at(at);
          const auto used = static_cast<std::size_t>(found.count);
          // The reader rounds the count up to a multiple of four.
          if (found.balls.size() < used + chain.size() + 4) found.balls.resize(used + chain.size() + 4);
          std::copy(chain.begin(), chain.end(), found.balls.begin() + found.count);
          found.count += static_cast<int>(chain.size());
        }
  }

  std::size_t index(const Place& p) const {
    return (static_cast<std::size_t>(p[2]) * cells_[1] + p[1]) * cells_[0] + p[0];
  }
  void link(int ball) {
    const auto at = index(place_[ball]);
    Cell& cell = content_[at];
    if (cell.count < Cell::inside) [[likely]] {
      cell.balls[cell.count++] = ball;
    } else {
      overflow_[at].push_back(ball);
      cell.count = Cell::inside | crowded;
    }
  }
  void unlink(int ball) {
    const auto at = index(place_[ball]);
    Cell& cell = content_[at];
    int last;
    if (cell.count & crowded) [[unlikely]] {
      auto& more = overflow_.at(at);
      last = more.back();
      more.pop_back();
      for (int& other : more)
        if (other == ball) other = last;
      if (more.empty()) cell.count = Cell::inside;
    } else {
      last = cell.balls[--cell.count];
    }
    // What stands beyond `count` is of no account, so no branch is needed for it.
    for (int& other : cell.balls) other = other == ball ? last : other;
  }

  Vec3<double> low_;
  std::array<double, 3> edge_;
  Place cells_;
  std::vector<Cell> content_;
  std::unordered_map<std::size_t, std::vector<int>> overflow_;
  std::vector<Place> place_;
};

}  // namespace edmill::engine
