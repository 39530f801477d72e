// One case from its initial state to its summary, without files and without the terminal.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/instant.hpp"
#include "casefile/build_case.hpp"
#include "engine/observer.hpp"
#include "io/final_state.hpp"
#include "io/summary.hpp"

namespace edmill::run {

/// How often checkpoints are made.
struct CheckpointInterval {
  double seconds;          ///< above 0
  bool simulated = false;  ///< of simulated time; otherwise of wall-clock time
};

/// States of a run from which it can be resumed.
struct Checkpoints {
  std::optional<CheckpointInterval> every;
  /// Called with a state of the run each time that one is due, and when the run is interrupted.
  std::function<void(const std::string& state)> save;
  /// The state to resume from; empty at the start of a run. It must be of the same case and program.
  std::string_view restored;
};

template <class Real>
struct Guests {
  std::vector<engine::Observer<Real>*> observers;  ///< notified of every impact, in this order
  const std::atomic<bool>* interrupt = nullptr;    ///< ends the run when it becomes true
  Checkpoints checkpoints{};                       ///< they include the observers
};

template <class Real>
struct Result {
  io::Summary<Real> summary;
  io::SavedState<Real> saved;  ///< at the end of the run
};

/// Runs `built` to the end given in `spec`. A decision that no scalar could make is reported in the summary.
/// @pre `built` was made of `spec`
/// @throws InterruptedError when the interrupt comes before the first event
template <class Real>
Result<Real> simulate(const casefile::CaseSpec& spec, const casefile::InitialCase<Real>& built,
                      const Guests<Real>& guests);

/// What of a run is not to be trusted, and why.
/// @param wanted_precision  of the dose rate, relative
std::vector<io::Warning> warnings_of(const io::Facts& summary, const std::optional<double>& wanted_precision);

}  // namespace edmill::run
