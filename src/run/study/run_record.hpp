// The record of a run in a study: enough for its tables, and to identify it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "io/summary.hpp"

namespace edmill::study {

struct RunRecord {
  std::string digest;  ///< of the case
  std::string status;  ///< done, inelastic_collapse, stalled, max_cpu_time, undecided, bad_case, error
                       ///< or interrupted
  std::string end_reason, message;
  double start_time = 0, end_time = 0;     ///< of the statistics [s]
  std::vector<std::uint64_t> collisions;   ///< with each partner; none of a run that could not start
  double milling_dose = 0, wall_work = 0;  ///< [J]
  std::optional<double> powder_mass, ball_mass;
  std::optional<double> dose_rate_half_width;  ///< of the run's own 95 % interval [W]
  std::optional<double> milling_time;          ///< to the case's target dose [s]
  double cpu_seconds = 0;

  bool done() const { return status == "done"; }
  /// Whether repeating the run would give the same result.
  bool lasting() const {
    return done() || status == model::name(model::EndReason::inelastic_collapse) ||
           status == model::name(model::EndReason::stalled) ||
           status == model::name(model::EndReason::undecided);
  }
};

RunRecord record_of(const io::Summary<double>& summary);

/// The record of a run that could not start.
RunRecord failed_run(const std::string& digest, const std::string& status, const std::string& message);

/// One line of JSON, with version and commit of this program.
std::string to_json(const RunRecord& record);
/// Nothing for a text that is not a record, or a record of another version or commit.
std::optional<RunRecord> from_json(const std::string& text);

/// A number that tables average.
struct Quantity {
  std::string name;
  /// Nothing where nothing defines it, such as rates of a wall that the run's vessel does not have.
  std::function<std::optional<double>(const RunRecord&)> of;
};
/// All of them, with the collision rates of so many walls.
std::vector<Quantity> quantities(int walls);
/// The one of a name, which is no collision rate.
Quantity quantity_named(const std::string& name);

}  // namespace edmill::study
