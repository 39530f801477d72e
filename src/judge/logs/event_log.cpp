#include "logs/event_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "base/clean_text.hpp"
#include "base/errors.hpp"
#include "casefile/quantity.hpp"
#include "io/input_file.hpp"
#include "io/json_file.hpp"

namespace edmill::logs {
namespace {

using casefile::Dimension;

constexpr int most = std::numeric_limits<int>::max();

/// Indices of the names in column_names().
enum Name : std::size_t {
  time_name,
  ball_name,
  partner_kind_name,
  partner_name,
  first_value,
  first_state = first_value + 4,
  name_count = first_state + 30,
};

/// The vectors of a body's state, in the order of their columns.
constexpr std::array<Vec3<double> BodyState::*, 5> state_vectors = {&BodyState::position,
    &BodyState::velocity_before, &BodyState::spin_before, &BodyState::velocity_after,
    &BodyState::spin_after};
constexpr std::array<bool Available::Body::*, 5> state_flags = {&Available::Body::position,
    &Available::Body::velocity_before, &Available::Body::spin_before,
    &Available::Body::velocity_after, &Available::Body::spin_after};

Dimension dimension_of(std::size_t name) {
  if (name == time_name) return Dimension::time;
  if (name < first_value) return Dimension::none;
  if (name < first_state) return name < first_value + 2 ? Dimension::speed : Dimension::energy;
  static constexpr std::array<Dimension, 5> of_vectors = {Dimension::length, Dimension::speed,
      Dimension::angular_speed, Dimension::speed, Dimension::angular_speed};
  return of_vectors[(name - first_state) % 15 / 3];
}

bool is_folder(const std::filesystem::path& place) {
  std::error_code ignored;
  return std::filesystem::is_directory(place, ignored);
}

}  // namespace

const std::vector<std::string>& column_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all{"time", "ball", "partner_kind", "partner"};
    for (std::size_t q = model::approach_speed; q < model::logged_count; ++q)
      all.emplace_back(model::logged_quantities[q].name);
    model::for_logged_vectors([&](const std::string& name) { all.push_back(name); });
    return all;
  }();
  return names;
}

std::vector<int> parse_walls(
    const std::string& text, const model::Partners& partners, const std::string& where) {
  std::vector<int> walls(partners.walls());
  std::string labels;
  std::istringstream in(text);
  char comma = ',';
  bool good = true;
  for (int k = 0; k < partners.walls(); ++k) {
    good = good && (k == 0 || (in >> comma && comma == ',')) && in >> walls[k];
    good = good && std::find(walls.begin(), walls.begin() + k, walls[k]) == walls.begin() + k;
    labels += (k == 0 ? "" : ", ") + partners[k].label;
  }
  if (!good || !(in >> std::ws).eof())
    throw InputError(fmt::format("{}: found {}, expected {} different numbers, one for each of: {}",
        where, io::in_quotes(text), partners.walls(), labels));
  return walls;
}

std::filesystem::path log_in(const std::filesystem::path& place) {
  if (!is_folder(place)) return place;
  const auto log = place / "collisions.csv";
  for (const auto* ending : {"", ".gz", ".zst"})
    if (const std::filesystem::path file = log.string() + ending; io::is_readable(file.string()))
      return file;
  return log;
}

EventLog::EventLog(const std::filesystem::path& place, const LogConventions& conventions, int balls,
    int walls, double beyond, bool is_good)
    : csv_(log_in(place),
          is_folder(place) ? "a collision log ([[output]] of type \"collisions\" in the case)"
                           : "a collision log"),
      columns_(name_count), is_good_(is_good), first_ball_(conventions.first_ball), balls_(balls),
      walls_(conventions.walls.value_or(std::vector<int>(walls))), beyond_(beyond) {
  read_header(conventions);
}

EventLog::EventLog(const std::filesystem::path& place)
    : EventLog(place, {}, most, 100, std::numeric_limits<double>::infinity(), true) {}

void EventLog::read_header(const LogConventions& conventions) {
  const auto& names = column_names();
  auto theirs = names;
  const auto in_header = [&header = csv_.header()](const std::string& column) {
    return std::find(header.begin(), header.end(), column) != header.end();
  };
  std::vector<std::string> problems;
  for (const auto& [ours, given] : conventions.columns) {
    const auto name = std::find(names.begin(), names.end(), ours);
    const auto complain = [&problems, &ours = ours, &given = given](
                              const std::string& found, const std::string& expected) {
      problems.push_back(
          fmt::format("column '{}={}': found {}, expected {}", ours, given, found, expected));
    };
    if (name == names.end()) {
      complain(io::in_quotes(ours), "one of the names in docs/audit.md");
      continue;
    }
    const auto k = static_cast<std::size_t>(name - names.begin());
    std::string column(trimmed(given));
    const auto bracket = column.rfind('[');
    if (!column.empty() && column.back() == ']' && bracket != std::string::npos) {
      const auto unit = column.substr(bracket + 1, column.size() - bracket - 2);
      const auto quantity = casefile::parse_quantity("1 " + unit, dimension_of(k));
      if (const auto* value = std::get_if<casefile::Quantity>(&quantity);
          value && dimension_of(k) != Dimension::none)
        columns_[k].unit = value->to<double>();
      else
        complain("unit " + io::in_quotes(unit),
            dimension_of(k) == Dimension::none ? "no unit" : casefile::describe(dimension_of(k)));
      // The header may contain the unit as well.
      if (!in_header(column)) column = trimmed(column.substr(0, bracket));
    }
    theirs[k] = column;
    if (!in_header(column))
      complain("a column that " + csv_.file() + " does not have", "a name in its header");
  }
  if (!problems.empty()) throw InputError(problems);

  for (std::size_t k = 0; k < (is_good_ ? first_state : name_count); ++k) {
    const bool needed = k == partner_kind_name || k == first_value ? is_good_ : k <= partner_name;
    columns_[k].place = needed ? csv_.needed_column(theirs[k]) : csv_.column(theirs[k]);
  }
  csv_.throw_problems();
  const bool with_kind = columns_[partner_kind_name].place.has_value();
  if (!conventions.walls)
    for (int id = 0; id < static_cast<int>(walls_.size()); ++id)
      walls_[id] = with_kind ? id : -1 - id;
  available_.approach_speed = columns_[first_value].place.has_value();
  available_.slip_speed = columns_[first_value + 1].place.has_value();
  available_.milling_dose = columns_[first_value + 2].place.has_value();
  available_.wall_work = columns_[first_value + 3].place.has_value();
  for (std::size_t body = 0; body < 2; ++body)
    for (std::size_t part = 0; part < 5; ++part) {
      const auto* first = &columns_[first_state + 15 * body + 3 * part];
      available_.body[body].*state_flags[part] = first[0].place && first[1].place && first[2].place;
    }
}

bool EventLog::has(std::size_t quantity) const {
  return quantity == model::time || columns_[first_value + quantity - model::approach_speed].place;
}

std::optional<double> EventLog::number(const Column& column) {
  auto number = is_good_ ? csv_.finite(*column.place) : csv_.number(*column.place);
  if (number) *number *= column.unit;
  return number;
}

/// @return false when the field is not a number, which is reported
bool EventLog::read_value(std::size_t name, double& value, LoggedEvent& event) {
  const Column& column = columns_[name];
  if (!column.place) return true;
  const auto read = number(column);
  if (!read) return false;
  value = *read;
  if (!std::isfinite(value) && event.problem.empty())
    event.problem = fmt::format("found {} in column {}", value, column_names()[name]);
  return true;
}

bool EventLog::read_bodies(LoggedEvent& event) {
  const auto& kind_column = columns_[partner_kind_name].place;
  const std::size_t partner_column = *columns_[partner_name].place;
  const std::string_view kind = kind_column ? csv_.field(*kind_column) : "";
  if (kind_column && kind != "wall" && kind != "ball") {
    csv_.bad_field(*kind_column, "ball or wall");
    return false;
  }
  const int least = is_good_ ? 0 : -most;
  const bool good_wall = is_good_ && kind == "wall";
  const char* const expected = good_wall ? "the number of a wall"
      : is_good_                         ? "the number of a ball"
                                         : "the number of a ball or a wall";
  const auto ball = csv_.whole(*columns_[ball_name].place, "the number of a ball", least, most);
  const auto partner = csv_.whole(
      partner_column, expected, least, good_wall ? static_cast<int>(walls_.size()) - 1 : most);
  if (!ball || !partner) return false;
  const auto wall = std::find(walls_.begin(), walls_.end(), *partner);
  event.with_wall = kind_column ? kind == "wall" : wall != walls_.end();
  event.ball = *ball - first_ball_;
  event.partner =
      event.with_wall ? static_cast<int>(wall - walls_.begin()) : *partner - first_ball_;
  const auto is_ball = [&](int k) { return k >= 0 && k < balls_; };
  const bool other = is_ball(event.partner) && event.partner != event.ball;
  event.unknown_body = !is_ball(event.ball) || !(event.with_wall ? wall != walls_.end() : other);
  if (!event.unknown_body) return true;
  if (is_good_) csv_.bad_field(partner_column, "another ball than the first");
  event.problem =
      fmt::format("found ball {} with {} {}", *ball, event.with_wall ? "wall" : "ball", *partner);
  return !is_good_;
}

std::optional<LoggedEvent> EventLog::read() {
  while (csv_.next_row()) {
    LoggedEvent event;
    event.line = csv_.line();
    const auto time = number(columns_[time_name]);
    if (!time || !read_bodies(event)) continue;
    event.time = *time;
    if (is_good_ && event.time < latest_) {
      csv_.bad_field(*columns_[time_name].place,
          fmt::format("a time not before {} s, that of the line above", latest_));
      continue;
    }
    if (!(std::abs(event.time) < beyond_)) {
      event.problem = std::isfinite(event.time) ? fmt::format("found a time beyond {:g} s", beyond_)
                                                : "found a time that is not finite";
      event.unknown_body = false;
      event.time = latest_;  // that of the line before
    }
    bool good = true;
    for (std::size_t q = model::approach_speed; q < model::logged_count && good; ++q) {
      event[q] = unknown;
      good = read_value(first_value + q - model::approach_speed, event[q], event);
    }
    for (std::size_t body = 0; body < event.count() && good; ++body)
      for (std::size_t part = 0; part < 5; ++part) {
        if (!(available_.body[body].*state_flags[part])) continue;
        auto& state = event.body[body].*state_vectors[part];
        for (std::size_t axis = 0; axis < 3; ++axis)
          good = good && read_value(first_state + 15 * body + 3 * part + axis, state[axis], event);
      }
    if (!good) continue;
    if (event.time < latest_) event.earlier_by = latest_ - event.time;
    // Rounding alone does not change the order of two lines.
    if (event.earlier_by <= rounding_of(latest_))
      event.time += std::exchange(event.earlier_by, 0.0);
    latest_ = std::max(latest_, event.time);
    return event;
  }
  return std::nullopt;
}

std::optional<LoggedEvent> EventLog::next() {
  while (!at_end_ && ahead_.size() < (is_good_ ? 1 : window)) {
    auto event = read();
    at_end_ = !event;
    if (at_end_) break;
    const auto later = [](double time, const LoggedEvent& other) { return time < other.time; };
    ahead_.insert(
        std::upper_bound(ahead_.begin(), ahead_.end(), event->time, later), std::move(*event));
  }
  if (ahead_.empty()) {
    csv_.throw_problems();
    return std::nullopt;
  }
  LoggedEvent event = std::move(ahead_.front());
  ahead_.pop_front();
  return event;
}

LogScan scan_log(const std::filesystem::path& place) {
  EventLog reader(place);
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
  const auto summary = place / "summary.json";
  if (log_in(place) == place || !std::filesystem::exists(summary)) return scan;
  const auto root = io::read_json(summary, "the summary of a run");
  const auto found = root.find("start_time");
  if (found == root.end() || !found->is_number())
    throw InputError(fmt::format("{}: start_time: {}, expected a time in s", summary.string(),
        found == root.end() ? "missing" : "found " + io::in_quotes(found->dump())));
  scan.statistics_start = found->get<double>();
  const auto counts = root.value("collisions", nlohmann::json::object());
  int walls = 0;
  while (counts.contains(model::partner_key(walls, walls + 1))) ++walls;
  scan.walls = std::max(scan.walls, walls);
  return scan;
}

}  // namespace edmill::logs
