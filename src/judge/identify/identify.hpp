// Causes of the violations of a log: values and mistakes that explain them. docs/audit.md, "Causes"
#pragma once

#include "audit/audit.hpp"
#include "identify/assumed.hpp"

namespace edmill::identify {

using audit::EventsAtHand, audit::Options;

// Signs of time steps and of soft contacts. docs/audit.md, "Codes with time steps"

/// The end of a contact at which its line is logged.
enum class LoggedAt { begin, end };

struct SoftContacts {
  double duration;   ///< median [s]
  double low, high;  ///< quartiles [s]
  LoggedAt at;
  std::uint64_t contacts;  ///< number of contacts that show it
  double exponent;         ///< of duration ~ speed^exponent: 0 for a linear spring, -1/5 for Hertz
  double spring;           ///< stiffness of a linear spring with this duration [N/m]
  double modulus;          ///< effective modulus E* of Hertz's contacts with this duration [Pa]
};

struct TimeStepping {
  std::optional<double> step;           ///< all times are multiples of it [s]
  std::optional<double> step_by_depth;  ///< from overlaps: contacts are found up to a step late [s]
  std::optional<SoftContacts> soft;
  std::optional<double> first_order_step;  ///< of an integrator, from flights under gravity [s]
  std::optional<double> jitter;            ///< root mean square of the errors of single times [s]
  bool second_order = false;               ///< flights under gravity show no error of first order

  bool found() const { return step || step_by_depth || soft || first_order_step || jitter; }
};

/// @param log  in the case's order of times
TimeStepping time_stepping(const EventsAtHand& log, const Case& the_case, const Options& options);

std::string table(const TimeStepping& found);

/// One to three values or mistakes that explain nine tenths of the violations or more.
struct Cause {
  std::vector<Found> found = {};       ///< mistakes first
  std::uint64_t explains = 0, of = 0;  ///< violations
  std::string others = {};  ///< kinds of the violations that it does not explain, if known
  double gain = 0;          ///< improvement of Schwarz's criterion by the cause
  /// For logs without states: impacts that a run reproduces, and could in spite of rounding.
  std::uint64_t follows = 0, could_follow = 0;
  std::vector<std::string> alike = {};  ///< other causes that this log cannot distinguish from it

  /// "mill.arm = 100.500 +- 0.001 mm in place of 100 mm"
  std::string text() const;
};

/// Extent of a search. `single`: one value or mistake for the whole log. `all`: also causes in
/// parts of the log, two and three causes together, and runs of the case.
enum class Search { single, all };

struct SearchedFor {
  std::size_t numbers = 0, mistakes = 0, parts = 0;  ///< of the case, and terms
  std::vector<std::string> stages;                   ///< "single causes", "two causes together"
};

struct Identification {
  std::uint64_t events = 0, violations = 0;  ///< used in the search
  std::vector<Cause> causes;  ///< the best first; empty where nothing explains the log
  /// For logs without positions: impacts that a run reproduces, and if only rounding limits it.
  std::optional<std::uint64_t> follows;
  bool follows_all = false;
  Search search = Search::all;
  bool too_few = false;      ///< impacts that can be checked or reproduced; there was no search
  bool interrupted = false;  ///< the search was stopped early; better causes may exist
  SearchedFor tried;
  TimeStepping stepping;
};

/// Called with the name of each stage of a search when it begins.
using Progress = std::function<void(const std::string& stage)>;

/// Searches the first events of a log. @param options of the audit; its log is read again
/// @throws InputError
Identification identify(const CaseSpec& spec, const Options& options, Search search = Search::all,
    const Progress& progress = {});

/// Searches causes for a log without states: runs the case with other values, from its own initial
/// state, and compares the impacts with those of the log. docs/audit.md, "Causes"
/// @param is_interrupted  called between runs; true ends the search
/// @return how many the case reproduces, and the best cause that reproduces nine tenths
Identification replay(const Assumed& nominal, const Assumptions& assumptions,
    const EventsAtHand& log, const std::function<bool()>& is_interrupted);

std::string table(const Identification& found);

}  // namespace edmill::identify
