// Collision logs, of edmill or of another code, read line by line.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>

#include "io/csv_reader.hpp"
#include "model/impact_record.hpp"

namespace edmill::compare {

using Event = model::ImpactRecord<double>;
/// Of each quantity of model::logged_quantities.
template <class T>
using OfEach = std::array<T, model::logged_count>;

/// The log that a path names: that file, or in the folder of a run collisions.csv, which may be compressed.
std::filesystem::path log_in(const std::filesystem::path& place);

/// Columns may be in any order; unknown ones are skipped. Bounded memory.
class LogReader {
 public:
  /// @param place  a CSV file, or a folder that holds collisions.csv
  /// @throws InputError with every problem of the header
  explicit LogReader(const std::filesystem::path& place);

  /// @param quantity  of model::logged_quantities
  bool has(std::size_t quantity) const { return columns_[quantity].has_value(); }

  /// The next event, in order of time; nothing at the end. Bad lines are skipped until there are ten of
  /// them or the file ends.
  /// @throws InputError with the bad lines: file, line, column, found, expected
  std::optional<Event> next();

  const std::string& file() const { return csv_.file(); }

 private:
  std::optional<Event> parse();

  io::CsvReader csv_;
  OfEach<std::optional<std::size_t>> columns_;
  std::size_t ball_column_ = 0, kind_column_ = 0, partner_column_ = 0;
  double last_time_ = -std::numeric_limits<double>::infinity();
};

/// Result of one pass over a log.
struct LogScan {
  std::string file;
  std::uint64_t events = 0;
  int walls = 0;               ///< that the summary beside the log counts, or else up to the last one met
  double first = 0, last = 0;  ///< times [s]
  OfEach<double> mean_magnitude{};  ///< of each column; 0 for an absent one
  OfEach<bool> has{};
  /// From the summary.json beside a log in a folder, when there is one.
  std::optional<double> statistics_start;  ///< [s]
};

/// @throws InputError with the problems of the log and its summary
LogScan scan_log(const std::filesystem::path& place);

}  // namespace edmill::compare
