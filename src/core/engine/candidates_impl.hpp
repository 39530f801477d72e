// Implementation of Candidates; included by the instantiation files only.
#pragma once

#include <boost/math/special_functions/cbrt.hpp>

#include "engine/ball_bounds.hpp"
#include "engine/candidates.hpp"

namespace edmill::engine {

namespace detail {

/// The region that the vessel sweeps, cut into cells that hold about one ball but are thicker than the
/// largest.
template <class Real>
CellGrid make_grid(const model::Mill<Real>& mill, const std::vector<model::BallProperties<Real>>& balls) {
  const auto region = mill.motion.swept(mill.vessel.half_sizes(), mill.vessel.reach());
  Real largest{0};
  for (const auto& b : balls) largest = b.radius > largest ? b.radius : largest;
  const double volume = static_cast<double>(mill.vessel.volume());
  // The C library's cube root is not the same on every machine; nor is long double.
  using boost::math::policies::promote_double;
  constexpr boost::math::policies::policy<promote_double<false>> portable;
  Real edge = 2 * largest * (1 + Real(1) / 1024);
  if (balls.size() <= 32) edge = 2 * (region.high - region.low).maxCoeff();
  const double spacing = 0.45 * boost::math::cbrt(volume / static_cast<double>(balls.size()), portable);
  if (edge < spacing) edge = Real(spacing);
  return CellGrid(vector_cast<double>(region.low), vector_cast<double>(region.high),
                  static_cast<double>(edge), static_cast<int>(balls.size()));
}

}  // namespace detail

template <class Real>
Candidates<Real>::Candidates(const model::Mill<Real>& mill,
                             const std::vector<model::BallProperties<Real>>& balls,
                             const LargeVector<dynamics::Flight<Real>>& flights, const Real& reach,
                             const Real& top_speed)
    : flights_(&flights),
      pairs_(model::mill_cast<double>(mill), 2 * static_cast<double>(smallest_radius(balls)),
             static_cast<double>(reach), static_cast<double>(top_speed)),
      stride_(all_alike(balls) ? 0 : 1),
      grid_(detail::make_grid(mill, balls)) {
  for (const auto& ball : balls) radii_.push_back(static_cast<double>(ball.radius));
  if constexpr (!is_double) double_flights_.resize(balls.size());
  if (grid_.single_cell()) columns_.emplace(static_cast<int>(balls.size()), stride_ == 0);
}

template <class Real>
CellOfBall Candidates<Real>::insert(int ball) {
  const CellOfBall cell = grid_.insert(ball, vector_cast<double>((*flights_)[ball].position));
  update(ball);
  return cell;
}

}  // namespace edmill::engine
