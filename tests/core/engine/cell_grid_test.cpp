// A ball's neighbours in the grid hold every ball that may touch it, at all times.
#include "engine/cell_grid.hpp"

#include <gtest/gtest.h>

#include <array>
#include <set>

#include "base/errors.hpp"
#include "casefile/random.hpp"

namespace edmill::engine {
namespace {

std::set<int> found_set(const FoundBalls& found) {
  return {found.balls.begin(), found.balls.begin() + found.count};
}

struct Point {
  Vec3<double> position, velocity;
  void fly(const Vec3<double>& gravity, double dt) {
    position += dt * velocity + dt * dt / 2 * gravity;
    velocity += dt * gravity;
  }
};

/// Points that fly freely, in and out of the region; each crosses its cells when the grid says so.
void fly_through_cells(std::uint64_t seed, const Vec3<double>& gravity, int count) {
  casefile::Random random(seed);
  const Vec3<double> low(-1, -0.5, 0), high(1, 0.7, 0.9);
  const double edge = 0.11;
  CellGrid grid(low, high, edge, count);
  std::vector<Point> points(count);
  std::vector<CellOfBall> cells(count);
  std::vector<double> due(count);  // of the next crossing, from now on
  std::vector<Crossing> next(count);
  const auto predict = [&](int i) {
    next[i] = grid.crossing(cells[i], points[i].position, points[i].velocity, gravity);
    due[i] = next[i].delay;
  };
  for (int i = 0; i < count; ++i) {
    for (int k = 0; k < 3; ++k) {
      points[i].position[k] = low[k] + (high[k] - low[k]) * random.uniform<double>();
      points[i].velocity[k] = 2 * random.uniform<double>() - 1;
    }
    if (i % 5 == 0) points[i].velocity[i % 3] = 0;
    cells[i] = grid.insert(i, points[i].position);
    predict(i);
  }
  FoundBalls found, fresh;
  int near_pairs = 0, crossings = 0;
  for (int step = 0; step < 60; ++step) {
    double left = 0.02;
    while (true) {
      const int first = static_cast<int>(std::min_element(due.begin(), due.end()) - due.begin());
      const double dt = std::min(left, due[first]);
      for (int i = 0; i < count; ++i) points[i].fly(gravity, dt), due[i] -= dt;
      left -= dt;
      if (left <= 0) break;
      ++crossings;
      grid.neighbours(cells[first], found);
      const auto before = found_set(found);
      grid.move(first, cells[first], next[first].axis, next[first].step);
      grid.neighbours(cells[first], found);
      grid.new_neighbours(cells[first], next[first].axis, next[first].step, fresh);
      // The new neighbours of the ball are exactly the balls of the new cells.
      const auto after = found_set(found), added = found_set(fresh);
      for (const int i : after) ASSERT_EQ(added.count(i) == 1, before.count(i) == 0);
      for (const int i : added) ASSERT_EQ(after.count(i), 1u);
      predict(first);
    }
    for (int i = 0; i < count; ++i) {
      grid.neighbours(cells[i], found);
      const auto near = found_set(found);
      ASSERT_EQ(static_cast<int>(near.size()), found.count) << "a ball was found twice";
      ASSERT_EQ(near.count(i), 1u);
      for (int j = 0; j < count; ++j) {
        if (norm<double>(points[i].position - points[j].position) > edge * (1 - 1e-9)) continue;
        ++near_pairs;
        ASSERT_EQ(near.count(j), 1u) << i << " and " << j << " in step " << step;
      }
    }
  }
  EXPECT_GT(near_pairs, 60 * count);
  EXPECT_GT(crossings, 60 * count / 10);
}

TEST(CellGrid, NeighboursHoldWhoeverIsNear) { fly_through_cells(1, {0, 0, 0}, 150); }

TEST(CellGrid, TheSameUnderGravity) {
  fly_through_cells(2, {0, -9.8, 0}, 150);
  fly_through_cells(3, {3, 2, -1}, 150);
}

TEST(CellGrid, TheSameWhereCellsAreCrowded) { fly_through_cells(4, {0, 1, 0}, 4000 / 4); }

/// As a saved state that somebody has changed can ask for it.
TEST(CellGrid, RefusesACrossingOutOfIt) {
  CellGrid grid({0, 0, 0}, {1, 1, 1}, 0.3, 1);
  auto cell = grid.insert(0, {0.1, 0.5, 0.9});
  for (const auto [axis, step] : {std::array{0, -1}, std::array{2, 1}}) {
    grid.fetch_new_cells(cell, axis, step);
    EXPECT_THROW(grid.move(0, cell, axis, step), ContractError);
  }
  grid.move(0, cell, 0, 1);
  FoundBalls found;
  grid.neighbours(cell, found);
  EXPECT_EQ(found_set(found), std::set<int>{0});
}

}  // namespace
}  // namespace edmill::engine
