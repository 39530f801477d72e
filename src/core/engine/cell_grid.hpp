// Neighbour grid in the inertial frame: a ball meets only balls of its own and the adjacent cells.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include "base/archive.hpp"
#include "base/errors.hpp"
#include "base/memory.hpp"
#include "base/vector.hpp"

namespace edmill::engine {

/// Which face of its cell a ball leaves through, and when.
struct Crossing {
  double delay;  ///< from now [s]; beyond `never` when no face is reached
  int axis;
  int step;  ///< -1 or +1

  static constexpr double never = 1e12;
};

/// The cell of a ball, by its number along each axis.
struct CellOfBall {
  std::array<std::int16_t, 3> at{};

  void archive(Archive& a) { a(at); }
};

/// The balls found in a search of cells. The capacity only grows.
struct FoundBalls {
  std::vector<int> balls;
  int count = 0;
};

/// The balls of each cell. The cell of each ball is stored by the owner, next to its other data,
/// where it costs no cache line of its own. Cells are thicker than the largest ball, by far more
/// than the rounding of crossing times: no late crossing hides a contact, and double suffices. The
/// outermost ones are unbounded, and surrounded by a layer of empty cells: all have neighbours.
class CellGrid {
 public:
  /// @param low, high  corners of the region that the balls' centres sweep [m]
  /// @param edge       least edge of a cell [m]
  CellGrid(const Vec3<double>& low, const Vec3<double>& high, double edge, int balls)
      : next_(balls, none) {
    EDMILL_REQUIRE(balls < static_cast<int>(Cell::crowded ^ Cell::empty),
        "numbers of balls that a cell can hold");
    std::size_t total = 1;
    for (int k = 0; k < 3; ++k) {
      const double extent = high[k] - low[k], count = std::floor(extent / edge);
      cells_[k] = count < 1 ? 1 : count > 512 ? 512 : static_cast<int>(count);  // fits CellOfBall
      const double thickness = extent / cells_[k];
      for (int cell = 0; cell < cells_[k]; ++cell) {
        const double lower = low[k] + cell * thickness;
        faces_[k].push_back({lower, lower + thickness});
      }
      faces_[k].front()[0] = -far_off;
      faces_[k].back()[1] = far_off;
      for (int cell = 0; cell < cells_[k] + 2; ++cell)
        at_[k].push_back(static_cast<int>(total) * (cell / 2) * 8 + (cell % 2 << k));
      total *= static_cast<std::size_t>(cells_[k] + 3) / 2;
    }
    content_.resize(8 * total);
  }

  int cells(int axis) const { return cells_[axis]; }
  bool single_cell() const { return cells_[0] * cells_[1] * cells_[2] == 1; }

  CellOfBall insert(int ball, const Vec3<double>& position) {
    CellOfBall cell;
    for (int k = 0; k < 3; ++k) {
      const auto above = [&](const Faces& faces) { return faces[1] > position[k]; };
      const auto begin = faces_[k].begin();
      cell.at[k] = static_cast<std::int16_t>(std::find_if(begin, faces_[k].end(), above) - begin);
    }
    link(ball, cell);
    return cell;
  }

  /// The ball leaves `cell`, which becomes the adjacent one.
  /// @throws ContractError if there is none, which only a saved state from elsewhere can cause
  void move(int ball, CellOfBall& cell, int axis, int step) {
    const int next = cell.at[axis] + step;
    EDMILL_REQUIRE(next >= 0 && next < cells_[axis], "a crossing into a cell of the grid");
    unlink(ball, cell);
    cell.at[axis] = static_cast<std::int16_t>(next);
    link(ball, cell);
  }

  /// When, and through which face, a ball in `cell`, now at `position`, leaves it.
  Crossing crossing(const CellOfBall& cell, const Vec3<double>& position,
      const Vec3<double>& velocity, const Vec3<double>& gravity) const {
    std::array<Passage, 3> by_axis;
    for (int k = 0; k < 3; ++k) {
      const Faces& faces = faces_[k][cell.at[k]];
      const double p = position[k], v = velocity[k], g = gravity[k];
      if (g == 0)
        by_axis[k] = drift(faces, p, v);
      else
        by_axis[k] = g > 0 ? fall(1, faces[1] - p, p - faces[0], v, g)
                           : fall(-1, p - faces[0], faces[1] - p, -v, -g);
    }
    int first = by_axis[1].delay < by_axis[0].delay;
    first = by_axis[2].delay < by_axis[first].delay ? 2 : first;
    return {by_axis[first].delay, first, by_axis[first].step};
  }

  /// Prefetches the cells that `neighbours` reads; those at the corners cover all of the bricks.
  void fetch_cells(const CellOfBall& cell) const {
    const auto [x, y, z] = cell.at;
    for (const int w : {0, 2})
      for (const int v : {0, 2})
        for (const int u : {0, 2}) fetch(&content_[at_[0][x + u] + at_[1][y + v] + at_[2][z + w]]);
  }
  /// Fetches what a move from `cell` by `step` along `axis` and `new_neighbours` after it read.
  void fetch_new_cells(const CellOfBall& cell, int axis, int step) const {
    const int place = cell.at[axis] + 1 + 2 * step;
    if (place < 0 || place >= cells_[axis] + 2) return;  // `move` will refuse it
    fetch(&content_[index(cell)]);
    const auto [one, other] = across(axis);
    const int layer = at_[axis][place];
    for (const int u : {0, 2})
      for (const int v : {0, 2})
        fetch(&content_[layer + at_[one][cell.at[one] + u] + at_[other][cell.at[other] + v]]);
  }

  void neighbours(const CellOfBall& cell, FoundBalls& found) const {
    const auto [x, y, z] = cell.at;
    collect<3>(&at_[0][x], &at_[1][y], &at_[2][z], found);
  }

  /// Finds the balls of the cells, one layer, that became adjacent by a move of `step` to `cell`.
  void new_neighbours(const CellOfBall& cell, int axis, int step, FoundBalls& found) const {
    const auto [one, other] = across(axis);
    const int layer = at_[axis][cell.at[axis] + 1 + step];
    collect<1>(&layer, &at_[one][cell.at[one]], &at_[other][cell.at[other]], found);
  }

  /// Saves or loads the balls of each cell in their order, because searches use this order.
  void archive(Archive& a) {
    std::vector<std::pair<std::size_t, Cell>> occupied;  // most are empty
    for (std::size_t at = 0; at < content_.size(); ++at)
      if (content_[at].second != Cell::empty) occupied.emplace_back(at, content_[at]);
    if (a.loading()) occupied.clear();
    a(occupied, next_);
    if (!a.loading()) return;
    std::fill(content_.begin(), content_.end(), Cell());
    for (const auto& [at, cell] : occupied) {
      if (at >= content_.size())
        throw InputError("the saved state contains a cell outside of the grid");
      content_[at] = cell;
    }
  }
  /// True if each ball is in the grid once, in the cell `cell_of(ball)`; for use after loading.
  bool holds_all(const auto& cell_of) const {
    std::vector<bool> seen(next_.size());
    std::size_t count = 0;
    const auto is_here = [&](std::uint32_t ball, std::size_t place) {
      if (ball >= seen.size() || seen[ball]) return false;
      const CellOfBall& cell = cell_of(static_cast<int>(ball));
      seen[ball] = true;
      ++count;
      return has(cell) && static_cast<std::size_t>(index(cell)) == place;
    };
    for (std::size_t place = 0; place < content_.size(); ++place) {
      const Cell& cell = content_[place];
      if (cell.second == Cell::empty) continue;
      if (!is_here(cell.first, place)) return false;
      if (cell.second == Cell::crowded) {
        int length = 1;
        for (int ball = next_[cell.first]; ball != none; ball = next_[ball], ++length)
          if (!is_here(static_cast<std::uint32_t>(ball), place)) return false;
        if (length < 3) return false;
      } else if (cell.second != Cell::single && !is_here(cell.second, place)) {
        return false;
      }
    }
    return count == seen.size();
  }
 private:
  using Faces = std::array<double, 2>;     ///< lower and upper of a cell along an axis [m]
  static constexpr double far_off = 1e30;  ///< of the outermost faces [m]; as a delay [s]: never
  static constexpr int none = -1;

  /// The two other axes.
  static std::array<int, 2> across(int axis) { return {axis == 0 ? 1 : 0, axis == 2 ? 1 : 2}; }

  // The selections below are unpredictable; they read tables, since branches would be mispredicted.

  /// Passage through one of the two faces across an axis.
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

  /// Along an axis with gravity, which points to `step`: a ball that moves against it may reach the
  /// far face first, and falls to the near one otherwise.
  static Passage fall(int step, double ahead, double behind, double speed, double gravity) {
    const double far = std::max(behind, 0.0), near = std::max(ahead, 0.0);
    const double square = speed * speed, turning = square - 2 * (gravity * far);
    const bool against = speed < 0;
    const bool back = against & (turning >= 0);
    const double distances[] = {near, far}, squares[] = {square + 2 * (gravity * near), turning};
    const double root = std::sqrt(squares[back]), size = std::fabs(speed);
    const bool rises_first = against & !back;  // where root - speed is free of cancellation
    const double numerators[] = {2 * distances[back], root + size};
    const double denominators[] = {size + root, gravity}, denominator = denominators[rises_first];
    const double delay = numerators[rises_first] / denominator;
    return {denominator > 0 ? delay : far_off, back ? -step : step};
  }

  /// A cell stores up to two balls; in a crowded cell, which is rare, they form a list from its
  /// first one. The two highest bits of `second` are a signed number, that of the balls less two.
  struct Cell {
    static constexpr std::uint32_t single = 3u << 30, empty = 2u << 30, crowded = empty | 1u << 29;
    std::uint32_t first = 0, second = empty;

    void archive(Archive& a) { a(first, second); }
  };

  bool has(const CellOfBall& cell) const {
    bool inside = true;
    for (int k = 0; k < 3; ++k) inside = inside && cell.at[k] >= 0 && cell.at[k] < cells_[k];
    return inside;
  }
  int index(const CellOfBall& cell) const {
    return at_[0][cell.at[0] + 1] + at_[1][cell.at[1] + 1] + at_[2][cell.at[2] + 1];
  }

  /// Finds the balls in a block of cells, three in y and z, given by the parts of their index along
  /// each axis. Copies whole cells, for a branch for each of 27 mostly empty ones would cost more.
  template <int nx> void collect(const int* x, const int* y, const int* z, FoundBalls& near) const {
    constexpr int rows = 9, cells = nx * rows;
    constexpr std::size_t room = 2 * cells + 4;
    if (near.balls.size() < room) near.balls.resize(room);
    int* const out = near.balls.data();
    std::int64_t surplus = 0, seen = 0;
    std::array<std::ptrdiff_t, nx> along;
    for (int k = 0; k < nx; ++k) along[k] = x[k];
#pragma GCC unroll 9
    for (int row = 0; row < rows; ++row) {
      const Cell* first = &content_[y[row % 3] + z[row / 3]];
#pragma GCC unroll 3
      for (int k = 0; k < nx; ++k) {
        std::uint64_t both;
        std::memcpy(&both, &first[along[k]], sizeof(both));
        std::memcpy(out + (2 * (nx * row + k) + surplus), &both, sizeof(both));
        // The second ball in the upper half, whatever the order of bytes.
        const auto cell = static_cast<std::int64_t>(
            std::endian::native == std::endian::little ? both : std::rotl(both, 32));
        surplus += cell >> 62;
        seen |= cell;
      }
    }
    near.count = 2 * cells + static_cast<int>(surplus);
    if (!(seen >> 32 & (Cell::crowded ^ Cell::empty))) [[likely]]
      return;
    std::array<int, cells> chains;
    int count = 0;
    for (int row = 0; row < rows; ++row)
      for (int k = 0; k < nx; ++k) {
        const Cell& cell = content_[x[k] + y[row % 3] + z[row / 3]];
        chains[count] = static_cast<int>(cell.first);
        count += cell.second == Cell::crowded;
      }
    for (int k = 0; k < count; ++k) append_chain(chains[k], near);
  }

  void append_chain(int first, FoundBalls& found) const {
    for (int ball = first; ball != none; ball = next_[ball]) {
      // The reader rounds the count up to a multiple of four.
      const auto used = static_cast<std::size_t>(found.count);
      if (found.balls.size() < used + 5) found.balls.resize(2 * used + 5);
      found.balls[used] = ball;
      ++found.count;
    }
  }

  void link(int ball, const CellOfBall& where) {
    Cell& cell = content_[index(where)];
    const bool single = cell.second == Cell::single;
    if (single | (cell.second == Cell::empty)) [[likely]] {
      const std::uint32_t firsts[] = {static_cast<std::uint32_t>(ball), cell.first};
      const std::uint32_t seconds[] = {Cell::single, static_cast<std::uint32_t>(ball)};
      cell = {firsts[single], seconds[single]};
    } else {
      if (cell.second != Cell::crowded) next_[cell.first] = static_cast<int>(cell.second);
      next_[ball] = static_cast<int>(cell.first);
      cell = {static_cast<std::uint32_t>(ball), Cell::crowded};
    }
  }
  void unlink(int ball, const CellOfBall& where) {
    Cell& cell = content_[index(where)];
    if (cell.second == Cell::crowded) [[unlikely]]
      return unchain(ball, cell);
    cell.first = cell.first == static_cast<std::uint32_t>(ball) ? cell.second : cell.first;
    cell.second = cell.second == Cell::single ? Cell::empty : Cell::single;
  }
  void unchain(int ball, Cell& cell) {
    if (cell.first == static_cast<std::uint32_t>(ball)) {
      cell.first = next_[ball];
    } else {
      int before = static_cast<int>(cell.first);
      while (next_[before] != ball) before = next_[before];
      next_[before] = next_[ball];
    }
    next_[ball] = none;
    int& second = next_[cell.first];
    if (next_[second] != none) return;
    cell.second = second;
    second = none;
  }

  std::array<int, 3> cells_;
  std::array<std::vector<Faces>, 3> faces_;  ///< of the cells along each axis
  /// Parts of a cell's index in `content_` by its number along each axis, where 0 is the layer that
  /// stays empty. Two by two by two cells are a brick that fills a cache line.
  std::array<std::vector<int>, 3> at_;
  LargeVector<Cell> content_;
  LargeVector<int> next_;  ///< for each ball: the next one in the same crowded cell
};

}  // namespace edmill::engine
