// What is wrong with a log: the values or mistakes that explain its violations. docs/audit.md, "Causes"
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "audit/audit.hpp"
#include "identify/parameters.hpp"
#include "identify/time_stepping.hpp"

namespace edmill::identify {

/// A number as the log has it.
struct Found {
  std::string key;
  Dimension dimension;
  double value, half_width, nominal;  ///< SI
  std::string equation = {};          ///< of a term
  std::string in_place_of = {};       ///< of a number that the case has not; `nominal` is none then
};

/// One to three values or mistakes that explain nine tenths of the violations or more.
struct Cause {
  std::vector<Found> values;
  std::vector<std::string> mistakes;   ///< "mill, sign of gamma: ..."
  std::uint64_t explains = 0, of = 0;  ///< violations
  double gain = 0;                     ///< of Schwarz's criterion over no cause
  /// For logs without states: how many impacts a run with the cause follows, and how many rounding lets it.
  std::uint64_t follows = 0, could_follow = 0;
  std::vector<std::string> alike;  ///< other causes that this log cannot distinguish from it

  /// "mill.arm = 100.500 +- 0.001 mm in place of 100 mm"
  std::string text() const;
};

/// What was tried, for the answer "none of these".
struct SearchedFor {
  std::size_t numbers = 0, mistakes = 0, parts = 0;  ///< numbers of the case, and terms of the equations
  std::vector<std::string> stages;                   ///< "single causes", "two causes together"
};

struct Identification {
  std::uint64_t events = 0, violations = 0;  ///< that were searched
  std::uint64_t noted = 0;                   ///< violations that the audit's notes explain
  std::vector<Cause> causes;                 ///< the best first; empty where nothing explains the log
  /// For logs without places: how many impacts a run of the case follows, and whether rounding alone ends
  /// that.
  std::optional<std::uint64_t> follows;
  bool follows_all = false;
  bool too_few = false;      ///< impacts that can be checked or followed; no cause was sought
  bool interrupted = false;  ///< the search ended before it was through; better causes may exist
  SearchedFor tried;
  TimeStepping stepping;
};

/// Called with the name of each stage of a search when it begins.
using Progress = std::function<void(const std::string& stage)>;

/// Searches the first events of a log: one value or mistake at a time, then two and three together.
/// @param options  of the audit; its log is read again
/// @throws InputError
Identification identify(const casefile::CaseSpec& spec, const audit::Options& options,
                        const Progress& progress = {});

/// As lines of the audit's report.
std::string table(const Identification& found);
/// As the entry "identified" of the audit's document. docs/files.md, "Audit"
void put_json(io::JsonText& json, const Identification& found);

}  // namespace edmill::identify
