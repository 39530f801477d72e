#include "dem/frame_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "base/errors.hpp"
#include "dem/binary_dump.hpp"
#include "io/csv_reader.hpp"

namespace edmill::dem {

namespace {

/// What a frame must have of each ball, under the names that codes give it.
struct Needed {
  std::array<const char*, 2> names;
  bool required = true;
};
/// Places in `needed`; y and z follow x.
constexpr std::size_t id = 0, x = 1, vx = 4, wx = 7, mass = 10, radius = 11, diameter = 12, scaled_x = 13,
                      moment = 16, count = 17;
constexpr Needed needed[count] = {{{"id", "ball"}},
                                  {{"x", "xu"}, false},
                                  {{"y", "yu"}, false},
                                  {{"z", "zu"}, false},
                                  {{"vx"}},
                                  {{"vy"}},
                                  {{"vz"}},
                                  {{"omegax", "wx"}},
                                  {{"omegay", "wy"}},
                                  {{"omegaz", "wz"}},
                                  {{"mass"}, false},
                                  {{"radius"}, false},
                                  {{"diameter"}, false},
                                  {{"xs", "xsu"}, false},
                                  {{"ys", "ysu"}, false},
                                  {{"zs", "zsu"}, false},
                                  {{"time", "t"}, false}};

/// Apart by spaces, tabs, commas or semicolons, in quotes or without.
std::vector<std::string> words(const std::string& line) {
  constexpr const char* separators = " \t,;\"";
  std::vector<std::string> list;
  for (std::size_t begin = line.find_first_not_of(separators); begin != std::string::npos;) {
    const auto end = std::min(line.find_first_of(separators, begin), line.size());
    list.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(separators, end);
  }
  return list;
}

struct Units {
  const char* name;
  double length, time, mass;
};
constexpr Units known_units[] = {
    {"si", 1, 1, 1}, {"cgs", 1e-2, 1, 1e-3}, {"micro", 1e-6, 1e-6, 1e-15}, {"nano", 1e-9, 1e-9, 1e-21}};

int facets_of(const std::string& word, const std::string& deck) {
  int facets = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), facets);
  if (error != std::errc() || *end != 0 || facets < 3)
    throw InputError(
        fmt::format("{}: found {} facets, expected a number from 3 on", deck, io::in_quotes(word)));
  return facets;
}

}  // namespace

DeckFacts facts_of_deck(const std::string& deck) {
  DeckFacts facts;
  io::InputFile in(deck, "a deck of LAMMPS, LIGGGHTS or YADE");
  for (std::string line; std::getline(in, line);) {
    const auto w = words(line);
    if (w.size() == 3 && w[0] == "#" && w[1] == "frame") facts.in_vessel = w[2] == "vessel";
    if (w.size() == 3 && w[0] == "#" && w[1] == "facets") facts.facets = facets_of(w[2], deck);
    if (w.size() < 2 || w[0] == "#") continue;
    if (w[0] == "timestep") facts.time_step = std::strtod(w[1].c_str(), nullptr);
    if (w[0] == "units") facts.units = w[1];
    if (w.size() == 3 && w[0] == "O.dt" && w[1] == "=") facts.time_step = std::strtod(w[2].c_str(), nullptr);
  }
  return facts;
}

FrameReader::FrameReader(const std::string& file, const DumpFormat& format, std::size_t balls)
    : name_(file),
      in_(file, "a dump of LAMMPS or LIGGGHTS"),
      format_(format),
      count_(balls),
      last_time_(-std::numeric_limits<double>::infinity()) {}

bool FrameReader::line() {
  if (!std::getline(in_, line_)) return false;
  ++line_number_;
  if (!line_.empty() && line_.back() == '\r') line_.pop_back();
  return true;
}

void FrameReader::fail(const std::string& found, const std::string& expected) const {
  throw InputError(fmt::format("{}:{}: found {}, expected {}", name_, line_number_, found, expected));
}

double FrameReader::number(std::string_view text) const {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    fail(fmt::format("'{}'", text.substr(0, 40)), "a number");
  return value;
}

void FrameReader::set_units(const std::string& units) {
  const auto* found = std::find_if(std::begin(known_units), std::end(known_units),
                                   [&](const Units& u) { return units == u.name; });
  if (found == std::end(known_units)) fail("units '" + units + "'", "si, cgs, micro or nano");
  length_ = found->length, time_ = found->time, mass_ = found->mass, speed_ = length_ / time_;
}

void FrameReader::read_columns(const std::vector<std::string>& columns) {
  if (!columns.empty() && columns == names_) return;
  names_ = columns;
  places_.assign(count, -1);
  std::vector<std::string> missing;
  for (std::size_t k = 0; k < count; ++k) {
    for (const char* name : needed[k].names)
      if (const auto found = name ? std::find(names_.begin(), names_.end(), name) : names_.end();
          found != names_.end())
        places_[k] = static_cast<int>(found - names_.begin());
    if (needed[k].required && places_[k] < 0) missing.emplace_back(needed[k].names[0]);
  }
  for (std::size_t k = 0; k < 3; ++k)
    if (places_[x + k] < 0 && places_[scaled_x + k] < 0) missing.push_back(needed[x + k].names[0]);
  if (!missing.empty())
    fail(fmt::format("no column {}", fmt::join(missing, ", ")),
         "all of id x y z vx vy vz omegax omegay omegaz");
}

FrameReader::Row FrameReader::row() const {
  std::vector<double> values(names_.size());
  std::size_t column = 0;
  for (const auto& word : words(line_)) {
    if (column == values.size()) fail("more values than columns", fmt::format("{}", names_.size()));
    const bool used = std::find(places_.begin(), places_.end(), static_cast<int>(column)) != places_.end();
    if (used) values[column] = number(word);
    ++column;
  }
  if (column < values.size())
    fail(fmt::format("{} values", column), fmt::format("{}, one for each column", names_.size()));
  return row_of(values);
}

FrameReader::Row FrameReader::row_of(const std::vector<double>& values) const {
  const auto at = [&](std::size_t what) { return values[static_cast<std::size_t>(places_[what])]; };
  if (!(std::abs(at(id)) < 1e15)) fail(fmt::format("ball {}", at(id)), "the number of a ball");
  Row row;
  row.id = static_cast<long>(at(id));
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    row.state.position[axis] =
        length_ * (places_[x + k] >= 0 ? at(x + k) : low_[k] + size_[k] * at(scaled_x + k));
    row.state.velocity[axis] = speed_ * at(vx + k);
    row.state.spin[axis] = at(wx + k) / time_;
  }
  if (places_[mass] >= 0) row.mass = mass_ * at(mass);
  if (places_[radius] >= 0) row.radius = length_ * at(radius);
  if (places_[radius] < 0 && places_[diameter] >= 0) row.radius = length_ * at(diameter) / 2;
  if (places_[moment] >= 0) row.time = time_ * at(moment);
  return row;
}

void FrameReader::finish(std::vector<Row> rows, double time, Frame& frame) {
  if (rows.size() != count_)
    fail(fmt::format("{} balls in a frame", rows.size()), fmt::format("{}, as in the case", count_));
  std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.id < b.id; });
  std::vector<long> ids;
  frame.balls.clear();
  for (const auto& row : rows) {
    if (!ids.empty() && ids.back() == row.id)
      fail(fmt::format("ball {} twice in a frame", row.id), "each once");
    ids.push_back(row.id);
    frame.balls.push_back(row.state);
  }
  if (ids_.empty()) {
    ids_ = ids;
    for (const auto& row : rows) {
      if (row.mass) masses_.push_back(*row.mass);
      if (row.radius) radii_.push_back(*row.radius);
    }
  } else if (ids_ != ids) {
    fail("other balls than in the first frame", "the same in all");
  }
  frame.time = time;
  if (!(time > last_time_))
    fail(fmt::format("a frame at {} s", time), fmt::format("one after {} s", last_time_));
  last_time_ = time;
}

bool FrameReader::next(Frame& frame) {
  if (kind_ == Kind::unknown)
    kind_ = begins_binary_dump(in_.peek()) ? Kind::binary : in_.peek() == 'I' ? Kind::dump : Kind::table;
  if (kind_ == Kind::binary) return next_of_binary(frame);
  return kind_ == Kind::dump ? next_of_dump(frame) : next_of_table(frame);
}

double FrameReader::time_of(std::optional<double> time, std::optional<double> step) const {
  if (!time && !(step && format_.time_step))
    fail("a frame without time", "its time in it, or the time step: --timestep or --deck");
  return time ? *time * time_ : *step * *format_.time_step;
}

bool FrameReader::next_of_binary(Frame& frame) {
  BinaryFrame read;
  if (!read_binary_frame(in_, name_, count_, read)) return false;
  ++line_number_;  // of the frame
  if (!read.units.empty()) format_.units = read.units;
  set_units(format_.units);
  low_ = read.low, size_ = read.size;
  read_columns(words(read.columns));
  if (names_.size() != read.rows.front().size())
    fail(fmt::format("{} names for {} columns", names_.size(), read.rows.front().size()), "one for each");
  std::vector<Row> rows;
  for (const auto& values : read.rows) {
    for (const int place : places_)
      if (place >= 0 && !std::isfinite(values[static_cast<std::size_t>(place)]))
        fail("a value that is no number", "a number");
    rows.push_back(row_of(values));
  }
  const double time = time_of(read.time, static_cast<double>(read.step));
  finish(std::move(rows), time, frame);
  return true;
}

/// Rows of one time are a frame; the last frame ends with the file.
bool FrameReader::next_of_table(Frame& frame) {
  while (names_.empty()) {
    if (!line()) return false;
    if (words(line_).empty() || line_.starts_with("#")) continue;
    set_units(format_.units);
    read_columns(words(line_));
    if (places_[moment] < 0) fail("no column time", "time id x y z vx vy vz omegax omegay omegaz");
  }
  std::vector<Row> rows;
  if (waiting_) rows.push_back(*std::exchange(waiting_, std::nullopt));
  while (line()) {
    if (words(line_).empty()) continue;
    const auto next = row();
    if (!rows.empty() && *next.time != *rows.front().time) {
      waiting_ = next;
      break;
    }
    rows.push_back(next);
  }
  if (rows.empty() || (!waiting_ && rows.size() < count_)) return false;  // cut off
  const double time = *rows.front().time;
  finish(std::move(rows), time, frame);
  return true;
}

bool FrameReader::next_of_dump(Frame& frame) {
  std::optional<double> step, time;
  while (line()) {
    if (line_.empty()) continue;
    if (!line_.starts_with("ITEM: "))
      fail(fmt::format("'{}'", line_.substr(0, 40)), "a line that begins with ITEM:");
    const std::string item = line_.substr(6);
    if (item.starts_with("ATOMS")) {
      set_units(format_.units);
      auto columns = words(line_);
      columns.erase(columns.begin(), columns.begin() + 2);
      read_columns(columns);
      const double at = time_of(time, step);
      std::vector<Row> rows;
      while (rows.size() < count_) {
        if (!line() || in_.eof()) return false;  // cut off
        rows.push_back(row());
      }
      finish(std::move(rows), at, frame);
      return true;
    }
    const bool bounds = item.starts_with("BOX BOUNDS");  // an item of no interest has one line, too
    for (std::size_t k = 0; k < (bounds ? 3 : 1); ++k) {
      if (!line()) return false;
      if (bounds) read_bounds(k);
    }
    if (item.starts_with("TIMESTEP")) step = number(line_);
    if (item == "TIME") time = number(line_);
    if (item == "UNITS") format_.units = line_;
    if (item.starts_with("NUMBER OF ATOMS") && number(line_) != static_cast<double>(count_))
      fail(fmt::format("{} balls", line_), fmt::format("{}, as in the case", count_));
  }
  return false;
}

void FrameReader::read_bounds(std::size_t axis) {
  const auto ends = words(line_);
  if (ends.size() < 2) fail(fmt::format("'{}'", line_.substr(0, 40)), "two bounds");
  low_[axis] = number(ends[0]), size_[axis] = number(ends[1]) - low_[axis];
}

}  // namespace edmill::dem
