// Runs of one deck with contacts of several durations, extrapolated to contacts of none.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace edmill::dem {

struct LimitPoint {
  std::string log;
  double contact_time = 0;               ///< median of single contacts with walls [s]
  double dose_rate = 0, half_width = 0;  ///< [W]
};

struct Limit {
  std::vector<LimitPoint> points;
  double value = 0, half_width = 0;  ///< dose rate at contact time zero, with its 95 % interval [W]
  double slope = 0;                  ///< [W/s]
  std::optional<LimitPoint> edmill;  ///< contact time 0

  double ratio() const { return value / edmill->dose_rate; }
  double ratio_half_width() const;
};

/// @param logs  of contacts, two or more of different contact times
/// @param run   folder of a run of edmill, or its collision log; none when empty
/// @param from  time from which on both count [s]
/// @throws InputError when a log cannot be read, or contact times do not differ
Limit limit_of(const std::vector<std::string>& logs, const std::string& run, double from);

std::string table(const Limit& limit);
std::string to_json(const Limit& limit);
/// A drawing of the points, the line and edmill's value.
std::string to_svg(const Limit& limit);

}  // namespace edmill::dem
