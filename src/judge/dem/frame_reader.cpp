#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/errors.hpp"
#include "dem/contacts.hpp"

namespace edmill::dem {

namespace {

/// Indices in `names`; y and z follow x.
constexpr std::size_t id = 0, x = 1, vx = 4, wx = 7, mass = 10, radius = 11, diameter = 12,
                      scaled_x = 13, moment = 16, image_x = 17, count = 20;
/// Columns of a frame, under the names that codes give them.
constexpr std::array<const char*, 2> names[count] = {{"id", "ball"}, {"x", "xu"}, {"y", "yu"},
    {"z", "zu"}, {"vx"}, {"vy"}, {"vz"}, {"omegax", "wx"}, {"omegay", "wy"}, {"omegaz", "wz"},
    {"mass"}, {"radius"}, {"diameter"}, {"xs", "xsu"}, {"ys", "ysu"}, {"zs", "zsu"}, {"time", "t"},
    {"ix"}, {"iy"}, {"iz"}};

/// Splits a line at spaces, tabs, commas and semicolons; quotes are dropped.
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

// Binary dumps of LAMMPS: `dump custom FILE.bin`, revision 2 (since 2021), which names its columns.

constexpr int most_columns = 1000;
constexpr int longest_text = 100'000;  // names of all columns together [bytes]
constexpr std::string_view magic = "DUMPCUSTOM";

struct EndOfFile {};

/// Reads numbers in this machine's byte order. LAMMPS writes them in that of its own machine.
class Bytes {
 public:
  Bytes(std::istream& in, const std::string& name) : in_(in), name_(name) {}

  template <class T> T take() {
    T value;
    read(reinterpret_cast<char*>(&value), sizeof value);
    return value;
  }
  std::string text(int length) {
    if (length < 0 || length > longest_text)
      fail(fmt::format("a text of {} bytes", length), "a short one");
    std::string value(length, ' ');
    read(value.data(), value.size());
    return value;
  }
  [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
    throw InputError(fmt::format("{}: binary dump: found {}, expected {}", name_, found, expected));
  }
 private:
  void read(char* to, std::size_t bytes) {
    if (!in_.read(to, static_cast<std::streamsize>(bytes))) throw EndOfFile();
  }

  std::istream& in_;
  const std::string& name_;
};

/// Reads the format. The older one, without column names, begins with the step, 0 or more.
void read_format(Bytes& in) {
  const auto length = in.take<std::int64_t>();
  if (length >= 0 ||
      in.text(static_cast<int>(-std::max<std::int64_t>(length, -longest_text))) != magic)
    in.fail("the format of LAMMPS before 2021, which does not name its columns, or another file",
        "a dump custom of a later LAMMPS, or the text that its binary2txt makes");
  if (const auto one = in.take<std::int32_t>(); one != 1)
    in.fail("numbers in the byte order of another machine", "that of this machine");
  if (const auto revision = in.take<std::int32_t>(); revision != 2)
    in.fail(fmt::format("revision {}", revision), "2");
}

/// Reads the values of all rows. No more memory is allocated than the frame can need.
std::vector<double> read_values(Bytes& in, std::size_t size) {
  std::vector<double> values;
  const auto chunks = in.take<std::int32_t>();
  for (std::int32_t chunk = 0; chunk < chunks; ++chunk) {
    const auto count = in.take<std::int32_t>();
    if (count < 0 || static_cast<std::size_t>(count) > size - values.size())
      in.fail(fmt::format("a part of {} values", count), fmt::format("at most {}", size));
    for (std::int32_t k = 0; k < count; ++k) values.push_back(in.take<double>());
  }
  if (values.size() != size)
    in.fail(fmt::format("{} values", values.size()), fmt::format("{}", size));
  return values;
}

}  // namespace

DeckFacts facts_of_deck(const std::string& deck) {
  DeckFacts facts;
  io::InputFile in(deck, "a deck of LAMMPS, LIGGGHTS or YADE");
  std::string line;
  int number = 1;
  for (; std::getline(in, line); ++number) {
    const auto w = words(line);
    if (w.size() == 3 && w[0] == "#" && w[1] == "frame") facts.in_vessel = w[2] == "vessel";
    if (w.size() == 3 && w[0] == "#" && w[1] == "facets") {
      const double facets = io::number_in(w[2]).value_or(0);
      if (!(facets >= 3 && facets <= 1e6 && facets == std::floor(facets)))
        throw InputError(
            fmt::format("{}: found {} facets, expected at least 3", deck, io::in_quotes(w[2])));
      facts.facets = static_cast<int>(facets);
    }
    if (w.size() < 2 || w[0].starts_with("#")) continue;
    if (w[0] == "units") facts.units = w[1];
    const bool assigned = w.size() > 2 && w[0] == "O.dt" && w[1] == "=";
    if (w[0] != "timestep" && !assigned) continue;
    const auto step = io::number_in(w[assigned ? 2 : 1]);
    const bool is_known = step && *step > 0 && std::isfinite(*step);
    const bool is_other = facts.time_step && facts.time_step != step;
    if ((!is_known || is_other) && facts.no_time_step.empty())
      facts.no_time_step = fmt::format("{}:{}: found {}, expected {}: give --timestep", deck,
          number, io::in_quotes(line), is_known ? "one time step" : "a time step as a number");
    facts.time_step = step.value_or(0);
  }
  return facts;
}

FrameReader::FrameReader(const std::string& file, const DumpFormat& format, std::size_t balls)
    : name_(file), in_(file, "a dump of LAMMPS or LIGGGHTS"), format_(format), count_(balls),
      last_time_(-std::numeric_limits<double>::infinity()) {}

bool FrameReader::line() {
  if (!std::getline(in_, line_)) return false;
  ++line_number_;
  if (!line_.empty() && line_.back() == '\r') line_.pop_back();
  return true;
}

void FrameReader::fail(const std::string& found, const std::string& due) const {
  throw InputError(fmt::format("{}:{}: found {}, expected {}", name_, line_number_, found, due));
}

double FrameReader::number(const std::string& text, bool is_finite) const {
  const auto value = io::number_in(text);
  if (!value || (is_finite && !std::isfinite(*value)))
    fail(fmt::format("'{}'", text.substr(0, 40)), "a number");
  return *value;
}

/// Sets the units, which are known by now, and the columns of the rows that follow.
void FrameReader::set_columns(const std::vector<std::string>& columns) {
  static constexpr Units known[] = {{"si", 1, 1, 1}, {"cgs", 1e-2, 1, 1e-3}, {"mm", 1e-3, 1, 1},
      {"micro", 1e-6, 1e-6, 1e-15}, {"nano", 1e-9, 1e-9, 1e-21}};
  const auto* units = std::find_if(std::begin(known), std::end(known),
      [&](const auto& one) { return one.name == format_.units; });
  if (units == std::end(known)) fail("units '" + format_.units + "'", "si, cgs, mm, micro or nano");
  units_ = *units;
  if (!columns.empty() && columns == names_) return;
  names_ = columns;
  places_.assign(count, -1);
  std::vector<std::string> missing;
  for (std::size_t k = 0; k < count; ++k) {
    for (const char* name : names[k])
      if (const auto found = name ? std::find(names_.begin(), names_.end(), name) : names_.end();
          found != names_.end())
        places_[k] = static_cast<int>(found - names_.begin());
    const bool is_required = k == id || (k >= vx && k < mass);
    if (is_required && places_[k] < 0) missing.emplace_back(names[k][0]);
  }
  for (std::size_t k = 0; k < 3; ++k)
    if (places_[x + k] < 0 && places_[scaled_x + k] < 0) missing.emplace_back(names[x + k][0]);
  if (!missing.empty())
    fail(fmt::format("columns without {}", fmt::join(missing, ", ")),
        "all of id x y z vx vy vz omegax omegay omegaz");
  for (std::size_t k = 0; k < 3; ++k) {
    const bool is_scaled = places_[x + k] < 0;
    const auto& place = names_[places_[(is_scaled ? scaled_x : x) + k]];
    if (place.ends_with('u')) places_[image_x + k] = -1;  // unwrapped already
    if (is_tilted_ && (is_scaled || places_[image_x + k] >= 0))
      fail(fmt::format(
               "the column {} of a triclinic box", is_scaled ? place : names[image_x + k][0]),
          "xu yu zu of such a box: dump them");
  }
}

FrameReader::FrameRow FrameReader::row() const {
  std::vector<double> values;
  for (const auto& word : words(line_)) {
    const auto column = static_cast<int>(values.size());
    if (values.size() == names_.size())
      fail("more values than columns", fmt::format("{}", names_.size()));
    const bool is_known = std::count(places_.begin(), places_.end(), column) > 0;
    values.push_back(is_known ? number(word) : 0);
  }
  if (values.size() < names_.size())
    fail(fmt::format("{} values", values.size()),
        fmt::format("{}, one for each column", names_.size()));
  return row_of(values);
}

FrameReader::FrameRow FrameReader::row_of(const std::vector<double>& values) const {
  const auto at = [&](std::size_t what) { return values[places_[what]]; };
  if (!(std::abs(at(id)) < 1e15)) fail(fmt::format("ball {}", at(id)), "the number of a ball");
  const double length = units_.length, time = units_.time;
  FrameRow row;
  row.id = static_cast<long>(at(id));
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = k;
    row.state.position[axis] =
        length * (places_[x + k] >= 0 ? at(x + k) : low_[k] + size_[k] * at(scaled_x + k));
    if (places_[image_x + k] >= 0) row.state.position[axis] += length * size_[k] * at(image_x + k);
    row.state.velocity[axis] = length / time * at(vx + k);
    row.state.spin[axis] = at(wx + k) / time;
  }
  if (places_[mass] >= 0) row.mass = units_.mass * at(mass);
  if (places_[radius] >= 0) row.radius = length * at(radius);
  if (places_[radius] < 0 && places_[diameter] >= 0) row.radius = length * at(diameter) / 2;
  if (places_[moment] >= 0) row.time = time * at(moment);
  return row;
}

void FrameReader::finish(std::vector<FrameRow> rows, double time, Frame& frame) {
  if (rows.size() != count_)
    fail(
        fmt::format("{} balls in a frame", rows.size()), fmt::format("{}, as in the case", count_));
  std::sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  if (const auto twice = std::adjacent_find(
          rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.id == b.id; });
      twice != rows.end())
    fail(fmt::format("ball {} twice in a frame", twice->id), "each once");
  std::vector<long> ids;
  frame.balls.clear();
  for (const auto& row : rows) {
    // Beyond the speed in any mill, the code has become unstable; squares stay finite.
    constexpr double fastest = 1e6;
    const auto& s = row.state;
    const double sizes = row.mass.value_or(1) + row.radius.value_or(1);
    if (!(norm(s.velocity) < fastest && std::isfinite(s.position.sum() + s.spin.sum() + sizes)))
      fail(fmt::format("ball {} with a velocity of {:.4g}, {:.4g}, {:.4g} m/s at {:.6g} s", row.id,
               s.velocity[0], s.velocity[1], s.velocity[2], time),
          "finite values and less than 1e6 m/s: the code has become unstable");
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
  if (!next_) {
    // A binary dump begins with a length, negated, or a step, whose lowest byte is most often 0.
    const int first = in_.peek();
    const bool is_binary = first == 0 || first == 256 - static_cast<int>(magic.size());
    next_ = is_binary  ? &FrameReader::next_of_binary
        : first == 'I' ? &FrameReader::next_of_dump
                       : &FrameReader::next_of_table;
  }
  return (this->*next_)(frame);
}

double FrameReader::time_of(std::optional<double> time, std::optional<double> step) const {
  if (!time && !(step && format_.time_step))
    fail("a frame without time", "its time in it, or the time step: --timestep or --deck");
  return time ? *time * units_.time : *step * *format_.time_step;
}

bool FrameReader::next_of_binary(Frame& frame) try {
  Bytes in(in_, name_);
  read_format(in);
  const auto step = static_cast<double>(in.take<std::int64_t>());
  if (const auto balls = in.take<std::int64_t>();
      balls < 0 || static_cast<std::size_t>(balls) != count_)
    in.fail(fmt::format("{} balls", balls), fmt::format("{}, as in the case", count_));
  const auto triclinic = in.take<std::int32_t>();
  for (int k = 0; k < 6; ++k) in.take<std::int32_t>();  // kinds of boundaries
  for (std::size_t axis = 0; axis < 3; ++axis) {
    low_[axis] = in.take<double>();
    size_[axis] = in.take<double>() - low_[axis];
  }
  if (triclinic != 0) in.fail("a box whose edges are not at right angles", "a rectangular box");
  const auto columns = in.take<std::int32_t>();
  if (columns < 1 || columns > most_columns)
    in.fail(fmt::format("{} columns", columns), fmt::format("1 to {}", most_columns));
  const auto units = in.text(in.take<std::int32_t>());
  const auto time = in.take<char>() != 0 ? std::optional(in.take<double>()) : std::nullopt;
  const auto titles = in.text(in.take<std::int32_t>());
  const auto values = read_values(in, count_ * columns);
  ++line_number_;  // of the frame
  if (!units.empty()) format_.units = units;
  set_columns(words(titles));
  if (names_.size() != static_cast<std::size_t>(columns))
    fail(fmt::format("{} names for {} columns", names_.size(), columns), "one for each");
  std::vector<FrameRow> rows;
  for (auto begin = values.begin(); begin != values.end(); begin += columns)
    rows.push_back(row_of({begin, begin + columns}));
  finish(std::move(rows), time_of(time, step), frame);
  return true;
} catch (const EndOfFile&) {
  return false;
}

/// Reads consecutive rows with the same time as a frame; the last frame ends with the file.
bool FrameReader::next_of_table(Frame& frame) {
  while (names_.empty()) {
    if (!line()) return false;
    if (words(line_).empty() || line_.starts_with("#")) continue;
    set_columns(words(line_));
    if (places_[moment] < 0)
      fail("columns without time", "time id x y z vx vy vz omegax omegay omegaz");
  }
  std::vector<FrameRow> rows;
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
      auto columns = words(line_);
      columns.erase(columns.begin(), columns.begin() + 2);
      set_columns(columns);
      const double at = time_of(time, step);
      std::vector<FrameRow> rows;
      while (rows.size() < count_) {
        if (!line() || in_.eof()) return false;  // cut off
        rows.push_back(row());
      }
      finish(std::move(rows), at, frame);
      return true;
    }
    const bool bounds = item.starts_with("BOX BOUNDS");  // other items have one line
    for (std::size_t k = 0; k < (bounds ? 3 : 1); ++k) {
      if (!line()) return false;
      if (!bounds) continue;
      const auto ends = words(line_);
      if (ends.size() < 2) fail(fmt::format("'{}'", line_.substr(0, 40)), "two bounds");
      low_[k] = number(ends[0], true);
      size_[k] = number(ends[1], true) - low_[k];
      is_tilted_ = (k > 0 && is_tilted_) || (ends.size() > 2 && number(ends[2], true) != 0);
    }
    if (item.starts_with("TIMESTEP")) step = number(line_, true);
    if (item == "TIME") time = number(line_, true);
    if (item == "UNITS") format_.units = line_;
    if (item.starts_with("NUMBER OF ATOMS") && number(line_) != static_cast<double>(count_))
      fail(fmt::format("{} balls", line_), fmt::format("{}, as in the case", count_));
  }
  return false;
}

}  // namespace edmill::dem
