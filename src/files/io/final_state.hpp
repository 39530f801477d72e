// final_state.csv: the state of every ball at the end of a run, from which another can start.
#pragma once

#include <fmt/format.h>

#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/instant.hpp"
#include "base/scalar.hpp"
#include "io/csv_reader.hpp"
#include "model/ball.hpp"

namespace edmill::io {

inline constexpr const char* final_state_header =
    "ball,position_x,position_y,position_z,velocity_x,velocity_y,velocity_z,spin_x,spin_y,spin_z,"
    "time,drive_period,drive_offset";

template <class Real> struct SavedState {
  Instant<Real> time;
  std::vector<model::BallState<Real>> states;
};

/// Columns: ball, position [m], velocity [m/s], spin [rad/s]; time [s] for reading, drive_period
/// and drive_offset [s] for an exact restart. Numbers round-trip.
template <class Real>
void write_final_state(
    std::ostream& out, const SavedState<Real>& saved, const DriveClock<Real>& clock) {
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

/// @throws InputError naming file and line of each deviation from this format
template <class Real> SavedState<Real> read_final_state(const std::string& path) {
  CsvReader csv(path, "a final_state.csv");
  const auto fail = [&](const std::string& found, const std::string& expected) {
    csv.bad_line("found " + found + ", expected " + expected);
    csv.throw_problems();
  };
  const auto header = fmt::format("{}", fmt::join(csv.header(), ","));
  if (header != final_state_header)
    fail("'" + header.substr(0, 120) + "'", std::string("'") + final_state_header + "'");
  SavedState<Real> saved;
  while (csv.next_row()) {
    csv.throw_problems();
    const auto ball = csv.field(0), period = csv.field(11);
    if (ball != std::to_string(saved.states.size()))
      fail("ball " + in_quotes(ball), "ball " + std::to_string(saved.states.size()));
    const auto real = [&](std::size_t k) {
      try {
        const Real value = from_text<Real>(std::string(csv.field(k)));
        using std::isfinite;
        if (isfinite(value)) return value;
      } catch (const std::invalid_argument&) {
      }
      csv.bad_field(k, "a finite number");
      csv.throw_problems();
      return Real(0);
    };
    const auto vector = [&](std::size_t k) {
      return Vec3<Real>(real(k), real(k + 1), real(k + 2));
    };
    if (period.empty() || period.size() > 15 ||
        period.find_first_not_of("0123456789") != period.npos)
      fail(in_quotes(period) + " as drive_period", "a whole number");
    const Instant<Real> time{std::stoll(std::string(period)), real(12)};
    if (time.offset < 0) fail(in_quotes(csv.field(12)) + " as drive_offset", "a time of 0 or more");
    if (saved.states.empty()) saved.time = time;
    if (!(time == saved.time)) fail("a time other than that of line 2", "one time for all balls");
    saved.states.push_back({vector(1), vector(4), vector(7)});
  }
  csv.throw_problems();
  if (saved.states.empty()) fail("a header alone", "a line for each ball");
  return saved;
}

}  // namespace edmill::io
