// The command `edmill run` for one scalar: build, simulate, write, print.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "casefile/case_spec.hpp"
#include "cli/exit_codes.hpp"
#include "io/checkpoint_file.hpp"

namespace edmill::cli {

struct RunOptions {
  std::string folder;  ///< of the outputs
  bool quiet = false;
  bool report = false;  ///< write the page report.html, and the tables that it shows
  const std::atomic<bool>* interrupt = nullptr;
  /// Called when the run has results to keep; before that a signal may end the program at once.
  std::function<void()> listen = [] {};
  /// Called when the results are in place, while a killed run could still continue from its checkpoint.
  std::function<void()> when_written = [] {};
  std::string case_text;  ///< for case.toml
  /// Content of the checkpoints besides the state, if the run makes any; with a state, it continues from
  /// there.
  std::optional<io::Checkpoint> checkpoint;
};

/// @return an exit code
/// @throws InterruptedError when the interrupt comes before the first event
template <class Real>
int run_case(const casefile::CaseSpec& spec, const RunOptions& options);

/// Where a file system has no locks, nothing keeps a second run out of the folder: the user has to.
void tell_of_missing_locks(const std::filesystem::path& folder);

/// The case in SI with its derived numbers, for `edmill check`, which makes the checks of a run.
/// @throws InputError when its balls do not fit
/// @throws UndecidedError when no scalar can decide about a first contact
std::string describe_case(const casefile::CaseSpec& spec);

/// An SVG of how the vessel moves. @throws InputError when the file cannot be written
void draw_mill(const casefile::CaseSpec& spec, const std::filesystem::path& file);

}  // namespace edmill::cli
