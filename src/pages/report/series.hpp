// Tables of outputs, rates over time, and the intervals of their means.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "casefile/output_spec.hpp"
#include "plot/chart.hpp"

namespace edmill::report {

/// A table of an output, as numbers.
struct OutputTable {
  std::string file;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> texts;  ///< of each row, the first columns
  std::vector<std::vector<double>> numbers;     ///< of each row, the other columns; nan where it is empty
  std::optional<double> from, until;            ///< of the record, where the table says so [s]

  double duration() const { return from && until ? *until - *from : 0; }
  /// Index in `numbers` of the column whose name begins with this text ("total energy").
  /// @throws InputError when there is none
  std::size_t column(std::string_view name) const;
  /// Rows with this first text.
  std::vector<std::vector<double>> rows_of(std::string_view text) const;
};

/// @param expected  "a table of trends", for messages
/// @param texts     how many columns of text there are before the numbers
/// @throws InputError when it is no such table
OutputTable read_table(const std::filesystem::path& file, const std::string& expected, std::size_t texts = 0);

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
