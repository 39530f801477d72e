#include "edmill/compare/log_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/property_tree/json_parser.hpp>
#include <boost/property_tree/ptree.hpp>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "edmill/core/errors.hpp"

namespace edmill::compare {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t bad_lines_told = 10;

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 40;
  return text.size() <= longest ? fmt::format("'{}'", text) : fmt::format("'{}...'", text.substr(0, longest));
}

std::optional<double> start_of_statistics(const fs::path& summary) {
  if (!fs::exists(summary)) return std::nullopt;
  boost::property_tree::ptree tree;
  try {
    boost::property_tree::read_json(summary.string(), tree);
  } catch (const boost::property_tree::json_parser_error& error) {
    throw InputError(
        fmt::format("{}:{}: found {}, expected JSON", summary.string(), error.line(), error.message()));
  }
  const auto text = tree.get<std::string>("start_time", "");
  char* end = nullptr;
  const double start = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(start))
    throw InputError(
        fmt::format("{}: start_time: found {}, expected a time in s", summary.string(), in_quotes(text)));
  return start;
}

}  // namespace

LogReader::LogReader(const fs::path& place) : last_time_(-std::numeric_limits<double>::infinity()) {
  std::error_code ignored;
  const bool folder = fs::is_directory(place, ignored);
  file_ = (folder ? place / "collisions.csv" : place).string();
  in_.open(file_, std::ios::binary);
  if (!fs::is_regular_file(file_, ignored) || !in_)
    throw InputError(folder ? file_ +
                                  ": found no readable file, expected a collision log ([[output]] of type "
                                  "\"collisions\" in the case)"
                            : file_ + ": found no readable file, expected a collision log");
  read_header();
}

void LogReader::read_header() {
  const auto problem = [&](const std::string& text) {
    problems_.push_back(fmt::format("{}:{}: {}", file_, line_number_, text));
  };
  // Comments may come first, as in certified sequences.
  do {
    if (!std::getline(in_, line_))
      throw InputError(
          fmt::format("{}:{}: found the end of the file, expected a header", file_, line_number_ + 1));
    if (++line_number_ == 1 && line_.starts_with("\xef\xbb\xbf")) line_.erase(0, 3);  // a byte order mark
  } while (line_.starts_with('#'));
  split();
  header_.assign(fields_.begin(), fields_.end());
  const auto column = [&](std::string_view name) -> std::optional<std::size_t> {
    const auto place = std::find(header_.begin(), header_.end(), name);
    if (place == header_.end()) return std::nullopt;
    const auto again = std::find(place + 1, header_.end(), name);
    if (again != header_.end())
      problem(
          fmt::format("column {}: found '{}' again, expected it once", again - header_.begin() + 1, name));
    return place - header_.begin();
  };
  const auto needed = [&](std::string_view name) {
    const auto place = column(name);
    if (!place) problem(fmt::format("found no column '{}', expected it in the header", name));
    return place;
  };
  value_columns_[time] = needed("time");
  ball_column_ = needed("ball").value_or(0);
  kind_column_ = needed("partner_kind").value_or(0);
  partner_column_ = needed("partner").value_or(0);
  value_columns_[approach_speed] = needed("approach_speed");
  for (const Value v : {slip_speed, milling_dose, wall_work}) value_columns_[v] = column(value_names[v]);
  if (!problems_.empty()) throw InputError(problems_);
}

std::optional<Event> LogReader::next() {
  while (std::getline(in_, line_)) {
    ++line_number_;
    if (trimmed(line_).empty()) continue;
    const auto problems_before = problems_.size();
    if (auto event = parse(); event && problems_.size() == problems_before) return event;
    if (problems_.size() >= bad_lines_told) break;
  }
  if (in_.bad()) throw std::runtime_error(file_ + ": could not be read to its end");
  if (!problems_.empty()) throw InputError(problems_);
  return std::nullopt;
}

std::optional<Event> LogReader::parse() {
  split();
  if (fields_.size() != header_.size()) {
    bad_line(fmt::format("found {} fields, expected {}", fields_.size(), header_.size()));
    return std::nullopt;
  }
  Event event;
  event.line = line_number_;
  for (std::size_t v = 0; v < value_count; ++v) {
    event.values[v] = std::numeric_limits<double>::quiet_NaN();
    if (!value_columns_[v]) continue;
    const auto number = parse_number(*value_columns_[v]);
    if (!number) return std::nullopt;
    event.values[v] = *number;
  }
  if (event.values[time] < last_time_) {
    bad_field(*value_columns_[time], fmt::format("no time before {} s, that of the line above", last_time_));
    return std::nullopt;
  }
  const auto kind = fields_[kind_column_];
  event.with_wall = kind == "wall";
  if (!event.with_wall && kind != "ball") {
    bad_field(kind_column_, "ball or wall");
    return std::nullopt;
  }
  constexpr int most = std::numeric_limits<int>::max();
  const auto ball = parse_id(ball_column_, "the number of a ball", most);
  const auto partner = event.with_wall ? parse_id(partner_column_, "a wall: 0, 1 or 2", 2)
                                       : parse_id(partner_column_, "the number of a ball", most);
  if (!ball || !partner) return std::nullopt;
  event.ball = *ball;
  event.partner = *partner;
  if (!event.with_wall && event.ball == event.partner) {
    bad_field(partner_column_, "another ball than the first");
    return std::nullopt;
  }
  last_time_ = event.values[time];
  return event;
}

std::optional<double> LogReader::parse_number(std::size_t column) {
  const auto text = fields_[column];
  double value = 0;
  auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc::result_out_of_range)  // too small counts as 0, too large is infinite
    value = std::strtod(std::string(text).c_str(), nullptr);
  else if (error != std::errc() || end != text.data() + text.size())
    value = std::numeric_limits<double>::quiet_NaN();
  if (std::isfinite(value)) return value;
  bad_field(column, "a finite number");
  return std::nullopt;
}

std::optional<int> LogReader::parse_id(std::size_t column, const std::string& expected, int largest) {
  const auto text = fields_[column];
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc() && end == text.data() + text.size() && value >= 0 && value <= largest)
    return value;
  bad_field(column, expected);
  return std::nullopt;
}

void LogReader::split() {
  fields_.clear();
  std::string_view rest = line_;
  for (auto comma = rest.find(','); comma != std::string_view::npos; comma = rest.find(',')) {
    fields_.push_back(trimmed(rest.substr(0, comma)));
    rest.remove_prefix(comma + 1);
  }
  fields_.push_back(trimmed(rest));
}

void LogReader::bad_line(const std::string& problem) {
  problems_.push_back(fmt::format("{}:{}: {}", file_, line_number_, problem));
}

void LogReader::bad_field(std::size_t column, const std::string& expected) {
  bad_line(fmt::format("column {} ({}): found {}, expected {}", column + 1, header_[column],
                       in_quotes(fields_[column]), expected));
}

LogScan scan_log(const fs::path& place) {
  LogReader reader(place);
  LogScan scan;
  scan.file = reader.file();
  for (std::size_t v = 0; v < value_count; ++v) scan.has[v] = reader.has(static_cast<Value>(v));
  while (const auto event = reader.next()) {
    if (scan.events++ == 0) scan.first = event->values[time];
    scan.last = event->values[time];
    for (std::size_t v = 0; v < value_count; ++v)
      if (scan.has[v]) scan.mean_magnitude[v] += std::abs(event->values[v]);
  }
  if (scan.events > 0)
    for (double& mean : scan.mean_magnitude) mean /= static_cast<double>(scan.events);
  std::error_code ignored;
  if (fs::is_directory(place, ignored)) scan.statistics_start = start_of_statistics(place / "summary.json");
  return scan;
}

}  // namespace edmill::compare
