// Checks a case as a run would, with its derived numbers in SI; checks a log by docs/log-format.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "casefile/case_spec.hpp"

namespace edmill::app {

struct CheckedCase {
  std::string file;
  /// Names and values; an empty name continues the entry before.
  std::vector<std::pair<std::string, std::string>> facts;

  std::string text() const;
};

/// @throws InputError when its balls do not fit, UndecidedError when no scalar decides a contact
CheckedCase check(const casefile::CaseSpec& spec);

/// An SVG of how the vessel moves. @throws InputError when the file cannot be written
void draw_mill(const casefile::CaseSpec& spec, const std::filesystem::path& file);

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

/// True if the first line that is no comment is the header of a CSV file, and not of a case.
bool is_log(const std::string& file);

/// @throws InputError with the problems of the header, or the first ten of the rows
LogDescription describe_log(const std::string& file);

}  // namespace edmill::app
