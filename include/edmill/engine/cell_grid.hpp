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
#include "edmill/core/memory.hpp"
#include "edmill/core/vector.hpp"

namespace edmill::engine {

/// Which face of its cell a ball leaves through, and when.
struct Crossing {
  double delay;  ///< from now [s]; beyond `never` when no face is reached
  int axis;
  int step;  ///< -1 or +1

  static constexpr double never = 1e12;
};

/// Balls that a look at the cells found; its room only grows.
struct FoundBalls {
  std::vector<int> balls;
  int count = 0;
};

/// Cells are never thinner than the largest ball plus a margin that dwarfs the rounding of crossing times, so
/// a crossing that is late by rounding hides no contact; that is why double serves every scalar. The
/// outermost cells are open to the outside. Around them lies a layer of cells that stay empty, so that every
/// cell with balls has neighbours on all sides.
class CellGrid {
 public:
  /// @param low, high  corners of the region that the balls' centres sweep [m]
  /// @param edge       least edge of a cell [m]
  CellGrid(const Vec3<double>& low, const Vec3<double>& high, double edge, int balls) : place_(balls) {
    std::size_t total = 1;
    for (int k = 0; k < 3; ++k) {
      const double extent = high[k] - low[k];
      const double count = std::floor(extent / edge);
      cells_[k] = count < 1 ? 1 : count > 512 ? 512 : static_cast<int>(count);
      const double thickness = extent / cells_[k];
      for (int cell = 0; cell < cells_[k]; ++cell) {
        const double lower = low[k] + cell * thickness;
        faces_[k].push_back({lower, lower + thickness});
      }
      faces_[k].front()[0] = -far_off;
      faces_[k].back()[1] = far_off;
      stride_[k] = static_cast<int>(total);
      total *= static_cast<std::size_t>(cells_[k]) + 2;
    }
    content_.resize(total);
    for (int k = 0, n = 0, in_face[3] = {0, 0, 0}; k < 27; ++k) {
      const std::array<int, 3> step{k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
      const int offset = step[0] * stride_[0] + step[1] * stride_[1] + step[2] * stride_[2];
      around_[n++] = offset;
      for (int axis = 0; axis < 3; ++axis)
        if (step[axis] == 0) abreast_[axis][in_face[axis]++] = offset;
    }
  }

  int cells(int axis) const { return cells_[axis]; }
  bool single_cell() const { return cells_[0] * cells_[1] * cells_[2] == 1; }

  void insert(int ball, const Vec3<double>& position) {
    Place& place = place_[ball];
    place.index = 0;
    for (int k = 0; k < 3; ++k) {
      const auto above = [&](const Faces& faces) { return faces[1] > position[k]; };
      place.cell[k] =
          static_cast<int>(std::find_if(faces_[k].begin(), faces_[k].end(), above) - faces_[k].begin());
      place.index += (place.cell[k] + 1) * stride_[k];
    }
    link(ball);
  }

  void move(int ball, int axis, int step) {
    unlink(ball);
    place_[ball].cell[axis] += step;
    place_[ball].index += step * stride_[axis];
    link(ball);
  }

  /// When the ball, now at `position` with `velocity`, leaves its cell.
  Crossing crossing(int ball, const Vec3<double>& position, const Vec3<double>& velocity,
                    const Vec3<double>& gravity) const {
    std::array<Passage, 3> by_axis;
    for (int k = 0; k < 3; ++k) {
      const Faces& faces = faces_[k][place_[ball].cell[k]];
      if (gravity[k] == 0)
        by_axis[k] = drift(faces, position[k], velocity[k]);
      else if (gravity[k] > 0)
        by_axis[k] = fall(1, faces[1] - position[k], position[k] - faces[0], velocity[k], gravity[k]);
      else
        by_axis[k] = fall(-1, position[k] - faces[0], faces[1] - position[k], -velocity[k], -gravity[k]);
    }
    int first = by_axis[1].delay < by_axis[0].delay;
    first = by_axis[2].delay < by_axis[first].delay ? 2 : first;
    return {by_axis[first].delay, first, by_axis[first].step};
  }

  /// Asks memory for the cells that `neighbours` reads, rows of three.
  void fetch_cells(int ball) const {
    const Cell* here = &content_[place_[ball].index];
    for (std::size_t row = 0; row < around_.size(); row += 3) {
      fetch(here + around_[row]);
      fetch(here + around_[row + 2]);
    }
  }
  /// Asks memory for where the ball is: what `fetch_cells` reads.
  void fetch_place(int ball) const { fetch(&place_[ball]); }

  /// Finds every ball in the ball's cell and the adjacent ones, itself included.
  void neighbours(int ball, FoundBalls& found) const { collect(place_[ball].index, around_, found); }

  /// The same for the cells that became adjacent when the ball moved by `step` along `axis`.
  void new_neighbours(int ball, int axis, int step, FoundBalls& found) const {
    collect(place_[ball].index + step * stride_[axis], abreast_[axis], found);
  }

  /// Which balls are where, and their order in each cell: it is that of the searches.
  void archive(Archive& a) {
    std::vector<std::pair<int, std::vector<int>>> overflow(overflow_.begin(), overflow_.end());
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
  static constexpr double far_off = 1e30;  ///< of the outermost faces [m]; as a delay [s], never

  using Faces = std::array<double, 2>;  ///< lower and upper of a cell along an axis [m]

  struct Place {
    std::array<int, 3> cell;
    int index;  ///< in `content_`

    void archive(Archive& a) { a(cell, index); }
  };

  // What is selected below is a coin toss, so selections are look-ups: a branch would be mispredicted.

  /// Through one of the two faces across an axis.
  struct Passage {
    double delay;
    int step;
  };

  /// Along an axis without gravity.
  static Passage drift(const Faces& faces, double position, double speed) {
    const bool up = speed > 0;
    const double delay = std::max((faces[up] - position) / speed, 0.0);
    return {speed == 0 ? far_off : delay, 2 * up - 1};
  }

  /// Along an axis with gravity, which points to `step`: a ball that moves against it may reach the far face
  /// first, and falls to the near one otherwise.
  static Passage fall(int step, double ahead, double behind, double speed, double gravity) {
    const double far = std::max(behind, 0.0), near = std::max(ahead, 0.0);
    const double square = speed * speed, turning = square - 2 * (gravity * far);
    const bool against = speed < 0;
    const bool back = against & (turning >= 0);
    const double distances[] = {near, far}, squares[] = {square + 2 * (gravity * near), turning};
    const double root = std::sqrt(squares[back]), size = std::fabs(speed);
    const bool rises_first = against & !back;  // where root - speed is free of cancellation
    const double numerators[] = {2 * distances[back], root + size}, denominators[] = {size + root, gravity};
    const double denominator = denominators[rises_first];
    const double delay = numerators[rises_first] / denominator;
    return {denominator > 0 ? delay : far_off, back ? -step : step};
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
  template <std::size_t count>
  void collect(int centre, const std::array<int, count>& offsets, FoundBalls& found) const {
    constexpr std::size_t room = 28 * Cell::inside + 4;
    if (found.balls.size() < room) found.balls.resize(room);
    int* out = found.balls.data();
    const Cell* here = &content_[centre];
    int seen = 0;
#pragma GCC unroll 27
    for (std::size_t k = 0; k < count; ++k) {
      const Cell* cell = here + offsets[k];
      std::memcpy(out, cell, sizeof(Cell));
      out += cell->count & 3;
      seen |= cell->count;
    }
    found.count = static_cast<int>(out - found.balls.data());
    if (seen & crowded) [[unlikely]]
      for (const int offset : offsets) append_chain(centre + offset, found);
  }

  void append_chain(int at, FoundBalls& found) const {
    if (!(content_[at].count & crowded)) return;
    const auto& chain = overflow_.at(at);
    const auto used = static_cast<std::size_t>(found.count);
    // The reader rounds the count up to a multiple of four.
    if (found.balls.size() < used + chain.size() + 4) found.balls.resize(used + chain.size() + 4);
    std::copy(chain.begin(), chain.end(), found.balls.begin() + found.count);
    found.count += static_cast<int>(chain.size());
  }

  void link(int ball) {
    const int at = place_[ball].index;
    Cell& cell = content_[at];
    if (cell.count < Cell::inside) [[likely]] {
      cell.balls[cell.count++] = ball;
    } else {
      overflow_[at].push_back(ball);
      cell.count = Cell::inside | crowded;
    }
  }
  void unlink(int ball) {
    const int at = place_[ball].index;
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

  std::array<int, 3> cells_;
  std::array<std::vector<Faces>, 3> faces_;  ///< of the cells along each axis
  std::array<int, 3> stride_;
  std::array<int, 27> around_;                 ///< offsets of a cell and its neighbours in `content_`
  std::array<std::array<int, 9>, 3> abreast_;  ///< the same in one layer across each axis
  LargeVector<Cell> content_;
  std::unordered_map<int, std::vector<int>> overflow_;
  LargeVector<Place> place_;
};

}  // namespace edmill::engine
