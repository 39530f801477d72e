// A CSV file with a header, read row by row in bounded memory; errors name file, line and column.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/input_file.hpp"

namespace edmill::io {

/// Text between quotes for a message, cut when long.
std::string in_quotes(std::string_view text);
/// Parses a number, also nan and infinity, with a leading sign or an exponent of Fortran.
std::optional<double> number_in(std::string_view text);

/// Fields are separated as the header is, and may be in quotes (RFC 4180). Comments (#) may precede
/// the header; blank lines are skipped. Reading ends after ten problems.
class CsvReader {
 public:
  /// @throws InputError when `file` is not readable or has no header
  /// @param expected  what the file should be, for messages: "a collision log"
  CsvReader(const std::filesystem::path& file, const std::string& expected);

  const std::string& file() const { return file_; }
  std::uint64_t line() const { return line_number_; }
  const std::vector<std::string>& header() const { return header_; }

  /// Index of a column; nothing when it is absent. A repeated name is a problem.
  std::optional<std::size_t> column(std::string_view name);
  /// Index of a required column; its absence is a problem.
  std::optional<std::size_t> needed_column(std::string_view name);

  /// Moves to the next row with the header's number of fields. @return false at the end
  bool next_row();
  std::string_view field(std::size_t column) const { return fields_[column]; }
  /// A finite number; anything else is a problem.
  std::optional<double> finite(std::size_t column);
  /// A number, nan and infinity among them; anything else is a problem.
  std::optional<double> number(std::size_t column);
  /// A whole number from `smallest` to `largest`; anything else is a problem.
  std::optional<int> whole(
      std::size_t column, const std::string& expected, int smallest, int largest);

  void bad_line(const std::string& problem);
  std::nullopt_t bad_field(std::size_t column, const std::string& expected);
  /// @throws InputError when there were problems
  void throw_problems() const;
 private:
  bool read_row();
  bool split();

  std::string file_;
  InputFile in_;
  char separator_ = ',';
  std::string line_;
  std::vector<std::string_view> fields_;  ///< of line_
  std::vector<std::string> header_;
  std::uint64_t line_number_ = 0;    ///< of the first line of the row
  std::uint64_t further_lines_ = 0;  ///< of the row, after line ends in quotes
  std::vector<std::string> problems_;
};

}  // namespace edmill::io
