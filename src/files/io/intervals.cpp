#include "base/statistics.hpp"
#include "io/summary.hpp"

namespace edmill::io {

Intervals::Rate Intervals::of(std::vector<double> amounts, double length) {
  for (auto& amount : amounts) amount /= length;
  const double half_width = numerics::estimate(amounts).half_width.value_or(0);
  return {std::move(amounts), half_width};
}

}  // namespace edmill::io
