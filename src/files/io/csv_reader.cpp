#include "io/csv_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "base/clean_text.hpp"
#include "base/errors.hpp"

namespace edmill::io {

namespace {

constexpr std::size_t problems_told = 10;

#if defined(__cpp_lib_to_chars)
std::from_chars_result read_number(std::string_view text, double& value) {
  return std::from_chars(text.data(), text.data() + text.size(), value);
}
#else
/// Replaces std::from_chars for double, which libc++ lacks before version 20. Refuses what only
/// strtod accepts.
std::from_chars_result read_number(std::string_view text, double& value) {
  const std::string copy(text);
  if (copy.empty() || copy.find_first_of("+xXpP") == 0 || copy.find_first_of("xX") != copy.npos)
    return {text.data(), std::errc::invalid_argument};
  char* end = nullptr;
  errno = 0;
  value = std::strtod(copy.c_str(), &end);
  if (end == copy.c_str()) return {text.data(), std::errc::invalid_argument};
  return {text.data() + (end - copy.c_str()),
      errno == ERANGE ? std::errc::result_out_of_range : std::errc()};
}
#endif

std::optional<double> usual_number(std::string_view text) {
  double value = 0;
  const auto [end, error] = read_number(text, value);
  if (error == std::errc::invalid_argument || end != text.data() + text.size()) return std::nullopt;
  // Too small counts as 0, too large is infinite.
  return error == std::errc::result_out_of_range ? std::strtod(std::string(text).c_str(), nullptr)
                                                 : value;
}

/// The separator of a header: the most frequent of comma, semicolon and tab; blanks without any.
char separator_of(std::string_view header) {
  std::string unquoted;
  for (bool quoted = false; const char c : header) {
    quoted = quoted != (c == '"');
    if (!quoted) unquoted += c;
  }
  const auto count = [&](char c) { return std::count(unquoted.begin(), unquoted.end(), c); };
  const char most = std::max({',', ';', '\t'}, [&](char a, char b) { return count(a) < count(b); });
  return count(most) == 0 && trimmed(unquoted).find(' ') != std::string::npos ? ' ' : most;
}

/// True if a text is a number with a decimal comma, and commas are not the separator.
bool has_decimal_comma(std::string_view text, char separator) {
  std::string with_point(text);
  const auto comma = with_point.find(',');
  if (separator == ',' || comma == std::string::npos) return false;
  with_point[comma] = '.';
  return number_in(with_point).has_value();
}

}  // namespace

std::optional<double> number_in(std::string_view text) {
  if (const auto value = usual_number(text)) return value;
  std::string usual(text.substr(text.starts_with('+') && !text.starts_with("+-") ? 1 : 0));
  if (const auto place = usual.find_first_of("dD"); place != std::string::npos) usual[place] = 'e';
  return usual == text ? std::nullopt : usual_number(usual);
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 40;
  return text.size() <= longest ? fmt::format("'{}'", text)
                                : fmt::format("'{}...'", text.substr(0, longest));
}

CsvReader::CsvReader(const std::filesystem::path& file, const std::string& expected)
    : file_(file.string()), in_(file_, expected) {
  do {
    if (!std::getline(in_, line_))
      throw InputError(fmt::format(
          "{}:{}: found the end of the file, expected a header", file_, line_number_ + 1));
    if (++line_number_ == 1 && line_.starts_with("\xef\xbb\xbf"))
      line_.erase(0, 3);  // a byte order mark
  } while (line_.starts_with('#'));
  if (line_.starts_with("\xff\xfe") || line_.starts_with("\xfe\xff"))
    throw InputError(fmt::format(
        "{}:1: found UTF-16, expected UTF-8: convert it with iconv -f utf-16 -t utf-8", file_));
  if (line_.starts_with("ITEM: "))
    throw InputError(fmt::format(
        "{}: found frames of a DEM code, expected {}: convert them with edmill import {}", file_,
        expected, file_));
  separator_ = separator_of(line_);
  if (!read_row()) throw_problems();
  header_.assign(fields_.begin(), fields_.end());
}

std::optional<std::size_t> CsvReader::column(std::string_view name) {
  const auto place = std::find(header_.begin(), header_.end(), name);
  if (place == header_.end()) return std::nullopt;
  const auto again = std::find(place + 1, header_.end(), name);
  if (again != header_.end())
    bad_line(fmt::format("column {}: found '{}' a second time, expected it once",
        again - header_.begin() + 1, name));
  return place - header_.begin();
}

std::optional<std::size_t> CsvReader::needed_column(std::string_view name) {
  const auto place = column(name);
  if (!place)
    bad_line(fmt::format(
        "the header has {} column '{}'", number_in(header_[0]) ? "numbers, but no" : "no", name));
  return place;
}

bool CsvReader::next_row() {
  while (problems_.size() < problems_told && std::getline(in_, line_)) {
    line_number_ += 1 + further_lines_;
    further_lines_ = 0;
    if (trimmed(line_).empty()) continue;
    if (!read_row()) continue;
    if (fields_.size() == header_.size()) return true;
    bad_line(fmt::format("found {} fields, expected {}", fields_.size(), header_.size()));
  }
  if (in_.bad()) throw std::runtime_error(file_ + ": could not be read to its end");
  return false;
}

std::optional<double> CsvReader::number(std::size_t column) {
  if (const auto value = number_in(fields_[column])) return value;
  return bad_field(column, "a number");
}

std::optional<double> CsvReader::finite(std::size_t column) {
  if (const auto value = number_in(fields_[column]); value && std::isfinite(*value)) return value;
  return bad_field(column, "a finite number");
}

std::optional<int> CsvReader::whole(
    std::size_t column, const std::string& expected, int smallest, int largest) {
  const auto text = fields_[column];
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc() && end == text.data() + text.size() && value >= smallest &&
      value <= largest)
    return value;
  return bad_field(column, expected);
}

/// Splits the row that begins in line_ into fields. A row whose line ends within quotes continues.
bool CsvReader::read_row() {
  constexpr std::size_t longest = 1 << 20;
  for (std::string more; !split(); ++further_lines_) {
    if (line_.size() > longest || !std::getline(in_, more)) {
      bad_line("a quotation mark is not closed");
      return false;
    }
    line_ += '\n' + more;
  }
  for (auto& field : fields_) {
    if (field.size() < 2 || !field.starts_with('"') || !field.ends_with('"')) continue;
    char* const text = line_.data() + (field.data() - line_.data());
    std::size_t size = 0;
    for (std::size_t k = 1; k + 1 < field.size(); ++k) {
      text[size++] = field[k];
      if (field[k] == '"' && field[k + 1] == '"') ++k;
    }
    field = {text, size};
  }
  return true;
}

/// @return false when a quote is open at the end of line_
bool CsvReader::split() {
  fields_.clear();
  if (separator_ == ' ') {  // any number of blanks
    line_ = trimmed(line_);
    std::replace(line_.begin(), line_.end(), '\t', ' ');
    line_.erase(std::unique(line_.begin(), line_.end(),
                    [](char a, char b) { return a == ' ' && b == ' '; }),
        line_.end());
  }
  for (std::size_t begin = 0, end = 0; end != std::string::npos; begin = end + 1) {
    auto from = line_.find_first_not_of(' ', begin);
    if (from != std::string::npos && line_[from] == '"') {
      from = line_.find('"', from + 1);
      while (from != std::string::npos && line_.compare(from + 1, 1, "\"") == 0)
        from = line_.find('"', from + 2);
      if (from == std::string::npos) return false;
    } else {
      from = begin;
    }
    end = line_.find(separator_, from);
    fields_.push_back(trimmed(std::string_view(line_).substr(begin, end - begin)));
  }
  return true;
}

void CsvReader::bad_line(const std::string& problem) {
  problems_.push_back(fmt::format("{}:{}: {}", file_, line_number_, problem));
}

std::nullopt_t CsvReader::bad_field(std::size_t column, const std::string& expected) {
  const bool comma = has_decimal_comma(fields_[column], separator_);
  bad_line(fmt::format("column {} ({}): found {}, expected {}", column + 1, header_[column],
      in_quotes(fields_[column]), comma ? "a decimal point in place of the comma" : expected));
  return std::nullopt;
}

void CsvReader::throw_problems() const {
  if (!problems_.empty()) throw InputError(problems_);
}

}  // namespace edmill::io
