// Bins of equal ratio, in every scalar.
#pragma once

#include <algorithm>
#include <type_traits>
#include <vector>

#include "base/scalar_list.hpp"
#include "casefile/quantity.hpp"

namespace edmill::output {

/// Edges low 10^(k / per_decade), up to high, where the last bin may be shorter. They are made in a wider
/// scalar: the same bits everywhere.
/// @pre 0 < low < high, per_decade > 0
template <class Real>
std::vector<Real> log_edges(const casefile::Quantity& low, const casefile::Quantity& high,
                            std::uint64_t per_decade) {
  using Fine = std::conditional_t<std::is_void_v<Wider<Real>>, Real, Wider<Real>>;
  const Fine first = low.to<Fine>(), last = high.to<Fine>();
  const Fine short_of_last = last * (1 - Fine(1) / 1000000000);  // what rounding would leave is no bin
  std::vector<Real> edges{low.to<Real>()};
  for (std::uint64_t k = 1;; ++k) {
    using std::pow;
    const Fine edge = first * pow(Fine(10), Fine(k) / Fine(per_decade));
    if (edge > short_of_last) break;
    edges.push_back(static_cast<Real>(edge));
  }
  edges.push_back(high.to<Real>());
  return edges;
}

/// 0 below the first edge, k from edge k - 1 up to below edge k, edges.size() from the last edge on.
template <class Real>
std::size_t bin_of(const std::vector<Real>& edges, const Real& value) {
  return static_cast<std::size_t>(std::upper_bound(edges.begin(), edges.end(), value) - edges.begin());
}

}  // namespace edmill::output
