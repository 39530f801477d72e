// Checks whether a file is a log as docs/log-format.md describes it, and describes its contents.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace edmill::app {

/// The description of a log; its JSON is the header of docs/log-format.schema.json.
struct LogDescription {
  struct Column {
    std::string name, unit;
  };
  std::string kind;                  ///< "impacts", or "contacts" that last
  std::vector<Column> columns;       ///< those of the format, in the order of the file
  std::vector<std::string> skipped;  ///< other columns
  std::uint64_t rows = 0;
  std::optional<double> first, last;  ///< times [s]
  int balls = 0, walls = 0;           ///< up to the highest number that occurs

  std::string text() const;
  std::string json() const;
};

/// True if a file is a table and not a case: its first line that is not a comment is the header of a CSV
/// file.
bool is_log(const std::string& file);

/// @throws InputError with the problems of the header, or the first ten of the rows
LogDescription describe_log(const std::string& file);

}  // namespace edmill::app
