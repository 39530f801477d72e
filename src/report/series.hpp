// Rates over time, and the intervals of their means.
#pragma once

#include <optional>
#include <vector>

#include "casefile/output_spec.hpp"
#include "plot/chart.hpp"
#include "report/output_table.hpp"

namespace edmill::report {

/// The mean of a rate over each of successive intervals.
struct Series {
  std::vector<double> begin, end, rate;  ///< [s], [s], [unit/s]
};

/// A rate in a table of trends.
/// @param start  initial time of the run, at which the first interval begins unless the table begins later
/// [s]
/// @return nothing when the table has no such column
std::optional<Series> series_of(const casefile::OutputSpec& output, const OutputTable& table, int variable,
                                double start);

/// Drops a last interval that is shorter than the first: its rate has another variance.
Series whole(Series series);

/// Intervals merged so that there are at most `most` of them; the last can be shorter.
Series coarser(const Series& series, std::size_t most);

/// Points of a line through the midpoints of the intervals.
plot::Points points_of(const Series& series);

}  // namespace edmill::report
