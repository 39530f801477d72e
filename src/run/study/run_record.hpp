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
  std::string status;  ///< done, bad_case, error, or the reason for an early end
  std::string message;
  io::Facts facts = io::Facts();  ///< of the summary; none of a run that could not start

  std::string end_reason() const { return facts.has("end_reason") ? facts.text("end_reason") : ""; }
  double cpu_seconds() const { return facts.find("cpu_seconds").value_or(0); }
  bool done() const { return status == "done"; }
  /// True if repeating the run would give the same result.
  bool lasting() const {
    return done() || status == model::name(model::EndReason::inelastic_collapse) ||
        status == model::name(model::EndReason::stalled) ||
        status == model::name(model::EndReason::undecided);
  }
};

/// @param summary  of a run that has ended
RunRecord record_of(io::Facts summary);

/// The record of a run that could not start.
RunRecord failed_run(
    const std::string& digest, const std::string& status, const std::string& message);

/// One line of JSON, with version and commit of this program.
std::string to_json(const RunRecord& record);
/// The record in a text; empty if it is not a record, or one of another version or commit.
std::optional<RunRecord> from_json(const std::string& text);

/// A number that tables average.
struct Quantity {
  std::string name, si_unit;  ///< of its column; "1" without a dimension
  std::string path;           ///< in the summary
  std::string interval = {};  ///< path of the half-width of a run's own interval; empty without one
  /// What reports and terminals display: a title, and the unit with its size in SI.
  const char *title = "", *unit = "";
  double size = 1;

  /// The value in a record; empty if undefined, as for a wall that the vessel lacks.
  std::optional<double> of(const RunRecord& record) const { return record.facts.find(path); }
};
/// The main results of a study, such as dose rate, specific dose rate and milling time.
const std::vector<Quantity>& main_quantities();
/// Columns of the table of runs that precede these: times, energies, the charge ratio.
std::vector<Quantity> amounts();
/// All quantities, including the rates of collisions and impacts with this many walls.
std::vector<Quantity> quantities(int walls);
/// The quantity with this name. @pre it is not a collision rate
Quantity quantity_named(const std::string& name);

}  // namespace edmill::study
