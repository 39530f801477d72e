// The folder of `edmill run`, as the report reads it: summary, case, tables, rates over time.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "casefile/case_spec.hpp"
#include "io/facts.hpp"
#include "model/parts/partners.hpp"
#include "plot/chart.hpp"

namespace edmill::report {

/// A rate of a run, or of several.
struct RateOf {
  double value;
  std::optional<double> half_width;  ///< of the 95 % interval

  RateOf in_units_of(double unit) const {
    return {value / unit, half_width ? std::optional(*half_width / unit) : std::nullopt};
  }
};

/// A rate of a summary with its interval; nothing if the summary does not have it.
std::optional<RateOf> rate_in(const io::Facts& summary, const std::string& path);

/// A table of an output, as numbers.
struct OutputTable {
  std::string file;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> texts;  ///< of each row, the first columns
  std::vector<std::vector<double>>
      numbers;          ///< of each row, the other columns; nan where it is empty
  double duration = 0;  ///< of the record, where the table says so [s]

  /// Index in `numbers` of the column whose name begins with this text ("total energy").
  /// @throws InputError when there is none
  std::size_t column(std::string_view name) const;
  /// Rows with this first text.
  std::vector<std::vector<double>> rows_of(std::string_view text) const;
};

/// summary.json and case.toml of a run, and the tables of the case.
struct RunFolder {
  std::filesystem::path place;
  io::Facts facts;          ///< of summary.json
  casefile::CaseSpec spec;  ///< with the outputs of the report if the run had them
  model::Partners partners;
  std::string name = {};  ///< among runs that are compared

  using Fits = std::function<bool(const casefile::OutputSpec&)>;
  /// The last output of the case that has this type, satisfies `fits`, is CSV (or X3D), is not
  /// appended to others, and whose file exists and is not empty; null if there is none.
  const casefile::OutputSpec* output(std::string_view type, const Fits& fits) const;
  /// The table of such an output, whose first columns, `texts` of them, are text; by default of all
  /// impacts.
  /// @param expected  "a table of trends", for messages
  /// @throws InputError when it is no such table
  std::optional<OutputTable> table(
      std::string_view type, const std::string& expected, std::size_t texts = 0,
      const Fits& fits = [](const auto& o) { return o.only.empty(); }) const;
  std::filesystem::path file_of(const casefile::OutputSpec& o) const {
    return place / o.folder / o.file;
  }
};

/// @throws InputError when a file is missing or wrong
RunFolder read_run_folder(const std::filesystem::path& place);

/// @param expected  "a table of trends", for messages
/// @param texts     how many columns of text there are before the numbers
/// @throws InputError when it is no such table
OutputTable read_table(
    const std::filesystem::path& file, const std::string& expected, std::size_t texts = 0);

/// An interval of time with the mean of a rate over it.
struct Interval {
  double begin, end, rate;  ///< [s], [s], [unit/s]
};
/// Successive intervals.
using Series = std::vector<Interval>;

/// A column of a table whose rows are of intervals that follow each other.
/// @param start  of the run [s]: the first interval begins there unless the table begins later
Series intervals_of(
    const casefile::OutputSpec& output, const OutputTable& table, std::size_t column, double start);
/// The column of a variable's rate in a table of trends; nothing where it has none.
std::optional<std::size_t> place_of_rate(const casefile::OutputSpec& output, int variable);

/// Intervals merged so that there are at most `most` of them; the last can be shorter.
Series coarser(const Series& series, std::size_t most);

/// Points of a line through the midpoints of the intervals.
plot::Points points_of(const Series& series);

/// Rate of a variable of all impacts, or of those with one partner, over at most `most` intervals;
/// nothing when no table has it.
std::optional<Series> rate_of(
    const RunFolder& run, const char* variable, std::size_t most, int partner = -1);

}  // namespace edmill::report
