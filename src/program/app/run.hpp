// Executes a run and writes its folder: results, the case, and the page on request.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "base/archive.hpp"
#include "casefile/case_spec.hpp"
#include "io/checkpoint_file.hpp"
#include "io/facts.hpp"
#include "model/outcome.hpp"
#include "run/any_run.hpp"

namespace edmill::app {

struct RunOptions : run::RunSetup {
  std::string folder;   ///< of the outputs
  bool report = false;  ///< write the page report.html, and the tables that it shows
  bool check = false;   ///< find what decides the dose rate; a report does where it takes seconds
  /// Finds what decides the dose rate of a run that has ended, as text (app/study.hpp).
  std::function<std::string(const casefile::CaseSpec&, const io::Facts&)> what_decides = {};
  /// Called when the run has results to keep: before that, an interrupted program may end at once.
  std::function<void()> begun = [] {};
  /// Called where the file system has no locks, which keep a second run out of the folder.
  std::function<void(const std::filesystem::path&)> without_locks = [](const auto&) {};
  /// Contents of checkpoints besides the state, if any are made. The run continues from a state.
  std::optional<io::Checkpoint> checkpoint;
};

struct RunResult {
  model::EndReason end_reason{};
  std::string error;     ///< why the run ended before its end; empty where it did not
  std::string table;     ///< of the results, for a terminal
  bool goes_on = false;  ///< it can be resumed
  std::string report;    ///< place of the page; empty without one

  void archive(Archive& a) {
    auto reason = static_cast<int>(end_reason);
    a(reason, error, table, goes_on, report);
    end_reason = static_cast<model::EndReason>(reason);
  }
};

/// Runs the case in one of casefile::precisions() and writes its folder.
/// @throws InterruptedError when the interrupt comes before the first event
RunResult run(const std::string& precision, casefile::CaseSpec spec, const RunOptions& options);

/// The part of a checkpoint that does not change during a run. @throws InputError for a case that
/// cannot be read again
io::Checkpoint first_checkpoint(const casefile::CaseSpec& spec, const std::string& precision,
    bool report, const std::string& interval);

/// Continues the run of `options.folder`. @param interval  empty to keep the previous one
/// @throws InputError when the checkpoint is not valid for this program
RunResult resume(const std::string& interval, RunOptions options);

}  // namespace edmill::app
