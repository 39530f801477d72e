// Candidate partners of a ball: those in neighbouring cells, or of all, that pass the pair filter.
#pragma once

#include <optional>
#include <type_traits>
#include <vector>

#include "base/memory.hpp"
#include "engine/cell_grid.hpp"
#include "engine/flight_columns.hpp"
#include "model/case.hpp"

namespace edmill::engine {

template <class Real> using Balls = std::vector<model::BallProperties<Real>>;

/// Pairs are filtered, and cells crossed, in double: bounds and margins cover the rounding.
template <class Real> class Candidates {
 public:
  /// A ball's flight as seen now, in double.
  using DoubleState = dynamics::PairSearch<double>::State;

  /// @param flights           of all balls; must outlive this
  /// @param reach, top_speed  largest distance of a ball from the origin [m], and speed [m/s]
  Candidates(const model::Mill<Real>& mill, const Balls<Real>& balls,
      const LargeVector<dynamics::Flight<Real>>& flights, const Real& reach, const Real& top_speed);

  bool uses_cells() const { return !columns_; }
  const CellGrid& grid() const { return grid_; }
  const dynamics::PairFilter<double>& filter() const { return pairs_.filter(); }

  /// @return the cell that the ball begins in
  CellOfBall insert(int ball);
  /// Must be called when a ball has a new flight.
  void update(int ball) {
    if constexpr (!is_double)
      double_flights_[ball] = dynamics::flight_cast<double>((*flights_)[ball]);
    if (columns_) columns_->set(ball, flights()[ball], radii_[ball * stride_]);
  }
  void raise_top_speed(const Real& speed) { pairs_.raise_top_speed(static_cast<double>(speed)); }

  DoubleState state(int ball, const Instant<Real>& now) const {
    return pairs_.state(flights()[ball], dynamics::instant_cast<double>(now));
  }

  /// Moves a ball to the adjacent cell, updates `cell`, and finds the balls of its new neighbours.
  void cross(int ball, CellOfBall& cell, int axis, int step, FoundBalls& near) {
    grid_.move(ball, cell, axis, step);
    grid_.new_neighbours(cell, axis, step, near);
  }

  /// Finds the candidates for a contact. @param near  result of `neighbours` @return their number
  int find(int ball, const DoubleState& state, const Instant<Real>& now, FoundBalls& near) {
    if (columns_) return columns_->filter(query(ball, state, now), result_);
    return find_among(ball, state, now, near);
  }
  /// Finds candidates among the balls of `near` alone.
  int find_among(int ball, const DoubleState& state, const Instant<Real>& now, FoundBalls& near) {
    result_.make_room(near.count);
    return filter_pairs(flights(), radii_.data(), stride_, query(ball, state, now), ball,
        near.balls.data(), near.count, result_);
  }
  /// Places of the candidates found among the balls filtered.
  const int* places() { return result_.candidates(); }
  int ball_at(int place, const FoundBalls& near) const {
    return columns_ ? place : near.balls[place];
  }
  double delay(int place) const { return result_.delay(place); }

  const dynamics::Flight<double>* flights() const {
    if constexpr (is_double)
      return flights_->data();
    else
      return double_flights_.data();
  }

  void archive(Archive& a) { a(grid_); }
 private:
  static constexpr bool is_double = std::is_same_v<Real, double>;

  PairFilterQuery query(int ball, const DoubleState& state, const Instant<Real>& now) const {
    return {state, radii_[ball * stride_], dynamics::instant_cast<double>(now), pairs_.filter()};
  }

  const LargeVector<dynamics::Flight<Real>>* flights_;
  dynamics::PairSearch<double> pairs_;
  LargeVector<dynamics::Flight<double>> double_flights_;  ///< empty when the scalar is double
  std::vector<double> radii_;                             ///< rounded too
  int stride_;  ///< 0 if all balls are identical: then the first radius is used for every ball
  CellGrid grid_;
  std::optional<FlightColumns> columns_;  ///< instead of the grid when that has one cell
  PairFilterResult result_;               ///< scratch
};

}  // namespace edmill::engine
