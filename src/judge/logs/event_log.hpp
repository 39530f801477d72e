// Collision logs of edmill and other codes: columns mapped, units converted, in order of time.
#pragma once

#include <array>
#include <cmath>
#include <deque>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/vector.hpp"
#include "io/csv_reader.hpp"
#include "model/impact_record.hpp"
#include "model/parts/partners.hpp"

namespace edmill::logs {

/// Uncertainty of a logged time by rounding [s]: half a unit in the last place for each of whole
/// drive periods and what exceeds them, their sum, a change of unit, and the way back to periods.
inline double rounding_of(double time) {
  return 2 * std::numeric_limits<double>::epsilon() * std::abs(time);
}

inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// A body of an impact: position, and velocity and spin before and after. Inertial frame, SI.
struct BodyState {
  Vec3<double> position{0, 0, 0}, velocity_before{0, 0, 0}, spin_before{0, 0, 0},
      velocity_after{0, 0, 0}, spin_after{0, 0, 0};
};

/// An impact, with the states of its bodies if the log has them.
struct LoggedEvent : model::ImpactRecord<double> {
  std::array<BodyState, 2> body{};  ///< the ball and, for balls, its partner
  double earlier_by = 0;      ///< time by which it precedes an earlier line [s]; 0 if it does not
  std::string problem{};      ///< why the event cannot be checked: "found nan in column vx_before"
  bool unknown_body = false;  ///< the problem is a ball or wall that does not exist

  std::size_t count() const { return with_wall ? 1 : 2; }  ///< of balls
  int ball_at(std::size_t place) const { return place == 0 ? ball : partner; }
};

struct Available {
  struct Body {
    bool position = false, velocity_before = false, spin_before = false, velocity_after = false,
         spin_after = false;
  };
  std::array<Body, 2> body;
  bool approach_speed = false, slip_speed = false, milling_dose = false, wall_work = false;

  /// Whether the log has these columns for all bodies of an event.
  bool positions(bool with_wall) const { return both(with_wall, &Body::position); }
  bool velocities_before(bool with_wall) const { return both(with_wall, &Body::velocity_before); }
  bool velocities_after(bool with_wall) const { return both(with_wall, &Body::velocity_after); }
  bool spins(bool with_wall) const {
    return both(with_wall, &Body::spin_before) && both(with_wall, &Body::spin_after);
  }
 private:
  bool both(bool with_wall, bool Body::*part) const {
    return body[0].*part && (with_wall || body[1].*part);
  }
};

struct LogConventions {
  std::vector<std::pair<std::string, std::string>> columns;  ///< ours, theirs: "t [ms]"
  int first_ball = 0;                                        ///< number of the first ball
  /// Numbers of the walls by id; by default 0, 1, ..., or without a column partner_kind -1, -2, ...
  std::optional<std::vector<int>> walls;
};

/// Parses the numbers of the walls in a log, "-1, -2, -3".
/// @throws InputError naming `where` unless there is a different whole number for each wall
std::vector<int> parse_walls(
    const std::string& text, const model::Partners& partners, const std::string& where);

/// The log file of a path: the file itself, or collisions.csv, perhaps compressed, in a folder.
std::filesystem::path log_in(const std::filesystem::path& place);

/// Reads a log in bounded memory. It reads ahead by `window` events, so that those slightly out of
/// order come in order of time. Columns may be in any order; unknown ones are skipped.
class EventLog {
 public:
  static constexpr std::size_t window = 256;

  /// Opens a log for an audit, which needs few columns; events have their own problems.
  /// @param place  a CSV file, or a folder that contains collisions.csv
  /// @param balls, walls  their numbers in the case
  /// @param beyond        a time of this magnitude or more is invalid [s]
  /// @throws InputError with every problem of the mapping and the header
  /// @param is_good       as in the other constructor
  EventLog(const std::filesystem::path& place, const LogConventions& conventions, int balls,
      int walls, double beyond, bool is_good = false);
  /// Opens a log that must be free of errors: in order of time, with finite values and the columns
  /// partner_kind and approach_speed. States are not read; any numbers of bodies are accepted.
  explicit EventLog(const std::filesystem::path& place);

  /// The next event; nothing at the end. Bad lines are skipped up to the tenth.
  /// @throws InputError with the bad lines: file, line, column, found, expected
  std::optional<LoggedEvent> next();

  /// @param quantity  of model::logged_quantities
  bool has(std::size_t quantity) const;
  const Available& available() const { return available_; }
  const std::string& file() const { return csv_.file(); }
 private:
  struct Column {
    std::optional<std::size_t> place;
    double unit = 1;  ///< in SI
  };
  void read_header(const LogConventions& conventions);
  std::optional<LoggedEvent> read();
  std::optional<double> number(const Column& column);
  bool read_bodies(LoggedEvent& event);
  bool read_value(std::size_t name, double& value, LoggedEvent& event);

  io::CsvReader csv_;
  std::vector<Column> columns_;  ///< in the order of the names
  Available available_;
  bool is_good_;  ///< errors in the log are refused
  int first_ball_, balls_;
  std::vector<int> walls_;  ///< their numbers in the log, by id
  double beyond_;
  double latest_ = -std::numeric_limits<double>::infinity();
  std::deque<LoggedEvent> ahead_;  ///< in order of time
  bool at_end_ = false;
};

enum class Verdict { agree, differ, too_few, not_compared };

/// Names of the columns that an audit knows, in the order of edmill's own log.
const std::vector<std::string>& column_names();

/// A value for each quantity of model::logged_quantities.
template <class T> using OfEach = std::array<T, model::logged_count>;

struct LogScan {
  std::string file;
  std::uint64_t events = 0;
  int walls = 0;               ///< number in the summary beside the log, or up to the last one met
  double first = 0, last = 0;  ///< times [s]
  OfEach<double> mean_magnitude{};  ///< of each column; 0 for an absent one
  OfEach<bool> has{};
  /// From the summary.json beside a log in a folder, when there is one.
  std::optional<double> statistics_start;  ///< [s]
};

/// @throws InputError with the problems of the log and its summary
LogScan scan_log(const std::filesystem::path& place);

}  // namespace edmill::logs
