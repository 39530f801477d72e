// The table of a law.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace edmill::model {

/// Points by ascending argument, and their values.
template <class Number>
using LawTable = std::vector<std::array<Number, 2>>;

/// Straight lines between the points, constant below the first and above the last one.
/// @pre there are points
template <class Number>
Number value_at(const LawTable<Number>& points, const Number& argument) {
  std::size_t k = 0;
  while (k < points.size() && points[k][0] < argument) ++k;
  if (k == 0) return points.front()[1];
  if (k == points.size()) return points.back()[1];
  const auto &low = points[k - 1], &high = points[k];
  const Number share = (argument - low[0]) / (high[0] - low[0]);
  return low[1] * (1 - share) + high[1] * share;
}

}  // namespace edmill::model
