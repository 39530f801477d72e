// How the program ends: exit codes, errors, signals, and standard streams that fail.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <string_view>

#include "model/outcome.hpp"

namespace edmill::cli {

enum ExitCode : int {
  ok = 0,
  internal_error = 1,
  bad_input = 2,
  inelastic_collapse = 3,
  undecided = 4,
  some_runs_failed = 5,
  outputs_differ = 6,
  too_few_data = 7,
  stalled = 8,
  interrupted = 128,  ///< plus the number of the signal, which the caller adds
};

/// The exit code of a run that ended for this reason.
constexpr ExitCode code_of(model::EndReason reason) {
  return reason == model::EndReason::undecided         ? undecided
      : reason == model::EndReason::stalled            ? stalled
      : reason == model::EndReason::interrupted        ? interrupted
      : reason == model::EndReason::inelastic_collapse ? inelastic_collapse
                                                       : ok;
}

struct ExitCodeText {
  std::string_view code, meaning;
};

inline constexpr ExitCodeText exit_codes[] = {{"0", "done"},
    {"1", "any other error, e.g. a full disk, or a standard output that cannot be written"},
    {"2",
        "bad input: one line for each problem, with file, line, key, what was found and what was "
        "expected"},
    {"3", "the run ended in inelastic collapse; its results are on disk"},
    {"4",
        "a decision that no scalar could make; the message reproduces it, the results so far are "
        "on disk. certify: the widest two scalars do not agree on that many events or digits, or a "
        "rule and not the equations orders two simultaneous contacts. prove: the same, or more "
        "bits than allowed"},
    {"5", "some runs of a sweep or an optimisation failed; the tables say which and why"},
    {"6",
        "compare: a quantity differs, or fewer events agree than --events requires. audit: the log "
        "violates the physics of the case. prove --check: the certificate belongs to another case"},
    {"7", "compare: too few data to decide. audit: no events, or no columns that could be checked"},
    {"8",
        "the run has stalled: bodies that cannot separate hit each other while the simulated time "
        "does not advance; its results are on disk"},
    {"129, 130, 138, 143, 152",
        "interrupted by SIGHUP, SIGINT, SIGUSR1, SIGTERM or SIGXCPU: 128 and its number; the "
        "results so far are on disk, if there has been an event"}};

/// In one line; control characters are escaped.
void print_problem(const std::string& problem);

/// Says why a command has no result. @return the exit code
int tell_undecided(const std::string& why);

/// Executes a command as the whole program, with streams, signals and errors. @return the exit code
int as_program(const std::function<int()>& command);

/// Becomes true at the first signal after `listen_for_signals`, or when another rank has seen one;
/// a second SIGINT or SIGTERM ends the program at once.
std::atomic<bool>& interrupt_flag();

/// From now on SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGUSR1 set the flag and do not end the program.
void listen_for_signals();

/// Adds the signal number to the code `interrupted`; returns any other code unchanged.
int plus_signal(int exit_code);

/// 128 plus the signal number if a signal has arrived, otherwise the code.
int after_signals(int exit_code);

}  // namespace edmill::cli
