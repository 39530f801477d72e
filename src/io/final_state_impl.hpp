// Implementation of final_state.hpp; included by the instantiation files only.
#pragma once

#include <algorithm>
#include <sstream>

#include "base/errors.hpp"
#include "base/scalar.hpp"
#include "io/csv_reader.hpp"
#include "io/final_state.hpp"

namespace edmill::io {

inline constexpr const char* final_state_header =
    "ball,position_x,position_y,position_z,velocity_x,velocity_y,velocity_z,spin_x,spin_y,spin_z,time,drive_"
    "period,"
    "drive_offset";

template <class Real>
void write_final_state(std::ostream& out, const SavedState<Real>& saved, const DriveClock<Real>& clock) {
  out << final_state_header << "\n";
  const std::string instant = to_text<Real>(clock.seconds(saved.time)) + "," +
                              std::to_string(saved.time.period) + "," + to_text<Real>(saved.time.offset);
  for (std::size_t k = 0; k < saved.states.size(); ++k) {
    const auto& s = saved.states[k];
    out << k;
    for (const auto* v : {&s.position, &s.velocity, &s.spin})
      for (int axis = 0; axis < 3; ++axis) out << "," << to_text<Real>((*v)[axis]);
    out << "," << instant << "\n";
  }
}

template <class Real>
SavedState<Real> read_final_state(const std::string& path) {
  InputFile in(path, "a final_state.csv");
  const auto fail = [&](std::size_t line, const std::string& found, const std::string& expected) {
    throw InputError(path + ":" + std::to_string(line) + ": found " + found + ", expected " + expected);
  };
  std::string line;
  if (!std::getline(in, line)) fail(1, "no readable text", "the header of a final_state.csv");
  if (!line.empty() && line.back() == '\r') line.pop_back();
  const char separator = separator_of(line);
  std::string header = line;
  std::replace(header.begin(), header.end(), separator, ',');
  if (header != final_state_header)
    fail(1, "'" + line.substr(0, 120) + "'", std::string("'") + final_state_header + "'");
  SavedState<Real> saved;
  for (std::size_t number = 2; std::getline(in, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty()) continue;
    std::vector<std::string> fields;
    std::istringstream parts(line);
    for (std::string field; std::getline(parts, field, separator);) fields.push_back(field);
    if (fields.size() != 13) fail(number, std::to_string(fields.size()) + " fields", "13");
    if (fields[0] != std::to_string(saved.states.size()))
      fail(number, "ball '" + fields[0] + "'", "ball " + std::to_string(saved.states.size()));
    const auto real = [&](std::size_t k) {
      try {
        const Real value = from_text<Real>(fields[k]);
        using std::isfinite;
        if (isfinite(value)) return value;
      } catch (const std::invalid_argument&) {
      }
      fail(number, "'" + fields[k] + "' in field " + std::to_string(k + 1),
           has_decimal_comma(fields[k], separator) ? "a decimal point in place of the comma"
                                                   : "a finite number");
      return Real(0);
    };
    const auto vector = [&](std::size_t k) { return Vec3<Real>(real(k), real(k + 1), real(k + 2)); };
    const bool whole = !fields[11].empty() && fields[11].size() < 16 &&
                       fields[11].find_first_not_of("0123456789") == std::string::npos;
    if (!whole) fail(number, "'" + fields[11] + "' as drive_period", "a whole number");
    const Instant<Real> time{std::stoll(fields[11]), real(12)};
    if (time.offset < 0) fail(number, "'" + fields[12] + "' as drive_offset", "a time of 0 or more");
    if (saved.states.empty()) saved.time = time;
    if (!(time == saved.time)) fail(number, "another time than in line 2", "one time for all balls");
    saved.states.push_back({vector(1), vector(4), vector(7)});
  }
  if (saved.states.empty()) fail(2, "no balls", "a line for each ball");
  return saved;
}

}  // namespace edmill::io
