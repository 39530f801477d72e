#include "dem/frame_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>

#include "base/errors.hpp"

namespace edmill::dem {

namespace {

/// What a frame must have of each ball, under the names that codes give it.
struct Needed {
  std::array<const char*, 3> names;
  bool required = true;
};
enum : std::size_t {
  id,
  x,
  y,
  z,
  vx,
  vy,
  vz,
  wx,
  wy,
  wz,
  mass,
  radius,
  diameter,
  scaled_x,
  scaled_y,
  scaled_z,
  count
};
constexpr Needed needed[count] = {{{"id"}},
                                  {{"x", "xu"}, false},
                                  {{"y", "yu"}, false},
                                  {{"z", "zu"}, false},
                                  {{"vx"}},
                                  {{"vy"}},
                                  {{"vz"}},
                                  {{"omegax"}},
                                  {{"omegay"}},
                                  {{"omegaz"}},
                                  {{"mass"}, false},
                                  {{"radius"}, false},
                                  {{"diameter"}, false},
                                  {{"xs", "xsu"}, false},
                                  {{"ys", "ysu"}, false},
                                  {{"zs", "zsu"}, false}};

std::vector<std::string> words(const std::string& line) {
  std::istringstream in(line);
  std::vector<std::string> list;
  for (std::string word; in >> word;) list.push_back(word);
  return list;
}

struct Units {
  const char* name;
  double length, time, mass;
};
constexpr Units known_units[] = {
    {"si", 1, 1, 1}, {"cgs", 1e-2, 1, 1e-3}, {"micro", 1e-6, 1e-6, 1e-15}, {"nano", 1e-9, 1e-9, 1e-21}};

}  // namespace

DeckFacts facts_of_deck(const std::string& deck) {
  DeckFacts facts;
  io::InputFile in(deck, "a deck of LAMMPS, LIGGGHTS or YADE");
  for (std::string line; std::getline(in, line);) {
    const auto w = words(line);
    if (w.size() == 3 && w[0] == "#" && w[1] == "frame") facts.in_vessel = w[2] == "vessel";
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

void FrameReader::read_columns() {
  auto columns = words(line_);
  columns.erase(columns.begin(), columns.begin() + 2);
  if (columns == names_) return;
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

void FrameReader::place(const std::vector<double>& values, model::BallState<double>& state) const {
  const auto at = [&](std::size_t what) { return values[static_cast<std::size_t>(places_[what])]; };
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    state.position[axis] =
        length_ * (places_[x + k] >= 0 ? at(x + k) : low_[k] + size_[k] * at(scaled_x + k));
    state.velocity[axis] = speed_ * at(vx + k);
    state.spin[axis] = at(wx + k) / time_;
  }
}

bool FrameReader::read_balls(Frame& frame) {
  std::vector<long> ids(count_);
  std::vector<double> values(names_.size());
  std::vector<model::BallState<double>> balls(count_);
  std::vector<double> masses, radii;
  for (std::size_t k = 0; k < count_; ++k) {
    if (!line() || in_.eof()) return false;  // cut off
    std::size_t column = 0;
    for (std::size_t begin = 0; begin < line_.size();) {
      begin = line_.find_first_not_of(" \t", begin);
      if (begin == std::string::npos) break;
      const auto end = std::min(line_.find_first_of(" \t", begin), line_.size());
      if (column == values.size()) fail("more values than columns", fmt::format("{}", names_.size()));
      const bool used = std::find(places_.begin(), places_.end(), static_cast<int>(column)) != places_.end();
      if (used) values[column] = number(std::string_view(line_).substr(begin, end - begin));
      ++column;
      begin = end;
    }
    if (column < values.size())
      fail(fmt::format("{} values", column), fmt::format("{}, one for each column", names_.size()));
    const double own = values[static_cast<std::size_t>(places_[id])];
    if (!(std::abs(own) < 1e15)) fail(fmt::format("ball {}", own), "the number of a ball");
    ids[k] = static_cast<long>(own);
    place(values, balls[k]);
    if (places_[mass] >= 0) masses.push_back(mass_ * values[static_cast<std::size_t>(places_[mass])]);
    const std::size_t size = places_[radius] >= 0 ? radius : diameter;
    if (places_[size] >= 0)
      radii.push_back(length_ * values[static_cast<std::size_t>(places_[size])] / (size == radius ? 1 : 2));
  }
  std::vector<std::size_t> order(count_);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return ids[a] < ids[b]; });
  std::vector<long> sorted;
  frame.balls.resize(count_);
  for (std::size_t k = 0; k < count_; ++k) {
    sorted.push_back(ids[order[k]]);
    frame.balls[k] = balls[order[k]];
    if (k > 0 && sorted[k] == sorted[k - 1])
      fail(fmt::format("ball {} twice in a frame", sorted[k]), "each once");
  }
  if (ids_.empty()) {
    ids_ = sorted;
    for (const std::size_t k : order) {
      if (!masses.empty()) masses_.push_back(masses[k]);
      if (!radii.empty()) radii_.push_back(radii[k]);
    }
  } else if (ids_ != sorted) {
    fail("other balls than in the first frame", "the same in all");
  }
  return true;
}

bool FrameReader::next(Frame& frame) {
  std::optional<double> step, time;
  std::string units = format_.units;
  while (line()) {
    if (line_.empty()) continue;
    if (!line_.starts_with("ITEM:"))
      fail(fmt::format("'{}'", line_.substr(0, 40)), "a line that begins with ITEM:");
    if (line_.starts_with("ITEM: TIMESTEP")) {
      if (!line()) return false;
      step = number(line_);
    } else if (line_.starts_with("ITEM: TIME")) {
      if (!line()) return false;
      time = number(line_);
    } else if (line_.starts_with("ITEM: UNITS")) {
      if (!line()) return false;
      format_.units = units = line_;
    } else if (line_.starts_with("ITEM: NUMBER OF ATOMS")) {
      if (!line()) return false;
      if (number(line_) != static_cast<double>(count_))
        fail(fmt::format("{} balls", line_), fmt::format("{}, as in the case", count_));
    } else if (line_.starts_with("ITEM: BOX BOUNDS")) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (!line()) return false;
        const auto ends = words(line_);
        if (ends.size() < 2) fail(fmt::format("'{}'", line_.substr(0, 40)), "two bounds");
        low_[k] = number(ends[0]), size_[k] = number(ends[1]) - low_[k];
      }
    } else if (line_.starts_with("ITEM: ATOMS")) {
      const auto* found = std::find_if(std::begin(known_units), std::end(known_units),
                                       [&](const Units& u) { return units == u.name; });
      if (found == std::end(known_units)) fail("units '" + units + "'", "si, cgs, micro or nano");
      length_ = found->length, time_ = found->time, mass_ = found->mass, speed_ = length_ / time_;
      read_columns();
      if (!time && !(step && format_.time_step))
        fail("a frame without time", "ITEM: TIME in it, or the time step: --timestep or --deck");
      if (!read_balls(frame)) return false;
      frame.time = time ? *time * time_ : *step * *format_.time_step;
      if (!(frame.time > last_time_))
        fail(fmt::format("a frame at {} s", frame.time), fmt::format("one after {} s", last_time_));
      last_time_ = frame.time;
      return true;
    } else {
      line();  // an item of no interest has one line
    }
  }
  return false;
}

}  // namespace edmill::dem
