// Checks another code's collision log against the physics of a case. docs/audit.md
#pragma once

#include <atomic>
#include <functional>

#include "audit/equations.hpp"
#include "casefile/case_spec.hpp"

namespace edmill::audit {

using BallStates = std::vector<model::BallState<double>>;

struct Options {
  std::filesystem::path log;  ///< a CSV file, or a folder of `edmill run`
  logs::LogConventions conventions;
  double tolerance = 1e-9;              ///< relative
  std::optional<double> gap_tolerance;  ///< largest gap or overlap of bodies in contact [m]
                                        ///< (default: by the relative tolerance)
  bool from_start = false;              ///< the log begins at the case's initial state
  std::size_t examples = 3;             ///< of each kind
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(double time, std::uint64_t events)> progress;  ///< called regularly
};

/// Options from the section [audit] of a case; `log` is left empty. @throws InputError
Options options_of(const casefile::CaseSpec& spec);

/// A probable cause of violations, with its evidence.
struct Diagnosis {
  std::string name;      ///< "unseen_wall"
  std::string text;      ///< a sentence
  std::uint64_t events;  ///< violations that it explains
  std::uint64_t of;      ///< number of violations of that kind
};

using logs::Verdict;
std::string_view name_of(Verdict verdict);

struct Audit {
  Tolerances tolerances;
  std::string case_name, log_name;
  std::uint64_t events = 0;
  double first = 0, last = 0;  ///< times [s]
  Available available;
  Findings findings{3};
  Energies energies;
  std::vector<Check> not_made;  ///< because columns are missing
  std::vector<Diagnosis> diagnoses;
  std::uint64_t undecided = 0;  ///< questions about missed impacts that no scalar could answer
  bool interrupted = false;
  Verdict verdict = Verdict::too_few;
};

/// @param the_case, states  of the case; the states are its initial ones
/// @throws InputError with the problems of the log and of the options for it
Audit audit(const Case& the_case, const BallStates& states, const Options& options);

struct EventsAtHand {
  std::string file;
  Available available;
  std::vector<LoggedEvent> events;
};
/// Reads the first events of a log, `most` at the most. @throws InputError
EventsAtHand read_events(const Case& the_case, const Options& options, std::size_t most);
/// Audits events already read; `options.log` and `options.from_start` are ignored.
Audit audit(const Case& the_case, const EventsAtHand& log, const Options& options);
Tolerances tolerances_of(const Case& the_case, const Options& options);

/// Fraction of the checks made that found a violation of this kind; nan if none were made.
double share_of(const Audit& audit, Kind kind);
std::string table(const Audit& audit);

}  // namespace edmill::audit
