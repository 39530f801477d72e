// A table of an output, as numbers.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace edmill::report {

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

}  // namespace edmill::report
