#include "compare/log_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "io/json_file.hpp"
#include "model/parts/partners.hpp"

namespace edmill::compare {

namespace {

namespace fs = std::filesystem;

/// What counts from the summary of a run: the begin of the statistics, and walls that it names.
void read_summary(const fs::path& summary, LogScan& scan) {
  if (!fs::exists(summary)) return;
  const auto root = io::read_json(summary, "the summary of a run");
  const auto found = root.find("start_time");
  if (found == root.end() || !found->is_number())
    throw InputError(fmt::format("{}: start_time: found {}, expected a time in s", summary.string(),
                                 found == root.end() ? "nothing" : io::in_quotes(found->dump())));
  scan.statistics_start = found->get<double>();
  const auto counts = root.value("collisions", nlohmann::json::object());
  int walls = 0;
  while (counts.contains(model::partner_key(walls, walls + 1))) ++walls;
  scan.walls = std::max(scan.walls, walls);
}

bool is_folder(const fs::path& place) {
  std::error_code ignored;
  return fs::is_directory(place, ignored);
}

}  // namespace

fs::path log_in(const fs::path& place) {
  if (!is_folder(place)) return place;
  const auto log = place / "collisions.csv";
  for (const auto* ending : {"", ".gz", ".zst"})
    if (const fs::path file = log.string() + ending; io::is_readable(file.string())) return file;
  return log;
}

LogReader::LogReader(const fs::path& place)
    : csv_(log_in(place), is_folder(place) ? "a collision log ([[output]] of type \"collisions\" in the case)"
                                           : "a collision log") {
  columns_[model::time] = csv_.needed_column("time");
  ball_column_ = csv_.needed_column("ball").value_or(0);
  kind_column_ = csv_.needed_column("partner_kind").value_or(0);
  partner_column_ = csv_.needed_column("partner").value_or(0);
  columns_[model::approach_speed] = csv_.needed_column("approach_speed");
  for (const auto q : {model::slip_speed, model::milling_dose, model::wall_work})
    columns_[q] = csv_.column(model::logged_quantities[q].name);
  csv_.throw_problems();
}

std::optional<Event> LogReader::next() {
  while (csv_.next_row())
    if (auto event = parse()) return event;
  csv_.throw_problems();
  return std::nullopt;
}

std::optional<Event> LogReader::parse() {
  Event event;
  event.line = csv_.line();
  for (std::size_t q = 0; q < model::logged_count; ++q) {
    event[q] = std::numeric_limits<double>::quiet_NaN();
    if (!columns_[q]) continue;
    const auto number = csv_.finite(*columns_[q]);
    if (!number) return std::nullopt;
    event[q] = *number;
  }
  if (event.time < last_time_) {
    csv_.bad_field(*columns_[model::time],
                   fmt::format("no time before {} s, that of the line above", last_time_));
    return std::nullopt;
  }
  const auto kind = csv_.field(kind_column_);
  event.with_wall = kind == "wall";
  if (!event.with_wall && kind != "ball") {
    csv_.bad_field(kind_column_, "ball or wall");
    return std::nullopt;
  }
  constexpr int most = std::numeric_limits<int>::max(), most_walls = 100;
  const auto ball = csv_.whole(ball_column_, "the number of a ball", 0, most);
  const auto partner = event.with_wall
                           ? csv_.whole(partner_column_, "the number of a wall", 0, most_walls - 1)
                           : csv_.whole(partner_column_, "the number of a ball", 0, most);
  if (!ball || !partner) return std::nullopt;
  event.ball = *ball;
  event.partner = *partner;
  if (!event.with_wall && event.ball == event.partner) {
    csv_.bad_field(partner_column_, "another ball than the first");
    return std::nullopt;
  }
  last_time_ = event.time;
  return event;
}

LogScan scan_log(const fs::path& place) {
  LogReader reader(place);
  LogScan scan;
  scan.file = reader.file();
  for (std::size_t q = 0; q < model::logged_count; ++q) scan.has[q] = reader.has(q);
  while (const auto event = reader.next()) {
    if (scan.events++ == 0) scan.first = event->time;
    scan.last = event->time;
    if (event->with_wall) scan.walls = std::max(scan.walls, event->partner + 1);
    for (std::size_t q = 0; q < model::logged_count; ++q)
      if (scan.has[q]) scan.mean_magnitude[q] += std::abs((*event)[q]);
  }
  if (scan.events > 0)
    for (double& mean : scan.mean_magnitude) mean /= static_cast<double>(scan.events);
  if (is_folder(place)) read_summary(place / "summary.json", scan);
  return scan;
}

}  // namespace edmill::compare
