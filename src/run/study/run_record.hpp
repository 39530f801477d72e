// The record of a run in a study: enough for its tables, and to identify it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/facts.hpp"
#include "model/outcome.hpp"

namespace edmill::study {

struct RunRecord {
  std::string digest;  ///< of the case
  std::string status;  ///< done, inelastic_collapse, stalled, max_cpu_time, undecided, bad_case, error
                       ///< or interrupted
  std::string message;
  io::Facts facts = io::Facts();  ///< of the summary; none of a run that could not start

  std::string end_reason() const { return facts.has("end_reason") ? facts.text("end_reason") : ""; }
  double cpu_seconds() const { return facts.find("cpu_seconds").value_or(0); }
  bool done() const { return status == "done"; }
  /// Whether repeating the run would give the same result.
  bool lasting() const {
    return done() || status == model::name(model::EndReason::inelastic_collapse) ||
           status == model::name(model::EndReason::stalled) ||
           status == model::name(model::EndReason::undecided);
  }
};

/// @param summary  of a run that has ended
RunRecord record_of(io::Facts summary);

/// The record of a run that could not start.
RunRecord failed_run(const std::string& digest, const std::string& status, const std::string& message);

/// One line of JSON, with version and commit of this program.
std::string to_json(const RunRecord& record);
/// Nothing for a text that is not a record, or a record of another version or commit.
std::optional<RunRecord> from_json(const std::string& text);

/// A number that tables average.
struct Quantity {
  std::string name;
  std::string path;           ///< in the summary
  std::string interval = {};  ///< path of the half-width of a run's own interval; empty without one
  /// What pages and terminals show: a title, and the unit with its size in SI.
  const char *title = "", *unit = "";
  double size = 1;

  /// Nothing where nothing defines it, such as rates of a wall that the run's vessel does not have.
  std::optional<double> of(const RunRecord& record) const { return record.facts.find(path); }
};
/// Dose rate, specific dose rate and milling time: what a study is made for.
const std::vector<Quantity>& main_quantities();
/// What the table of runs has before these: times, energies, the charge ratio.
std::vector<Quantity> amounts();
/// All of them, with the rates of collisions and impacts with so many walls.
std::vector<Quantity> quantities(int walls);
/// The one of a name, which is no collision rate.
Quantity quantity_named(const std::string& name);

}  // namespace edmill::study
