// A run whose scalar is chosen by name, for commands and other languages.
#pragma once

#include <atomic>
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "casefile/case_spec.hpp"
#include "edmill/contact_law.hpp"
#include "edmill/impact.hpp"
#include "io/checkpoint_file.hpp"
#include "io/facts.hpp"
#include "model/outcome.hpp"

namespace edmill::run {

/// Processor time of this thread: several runs can share a process.
inline double cpu_seconds() {
  timespec t{};
  if (clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t) != 0) clock_gettime(CLOCK_MONOTONIC, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Progress of a run.
struct Progress {
  double now;  ///< simulated time [s]
  std::optional<double>
      end;  ///< simulated time at the end [s]; empty if only other rules stop the run
  std::uint64_t collisions;  ///< since the start of the run
  double milling_dose;       ///< since the program started it, or resumed it [J]
};

/// A contact law of a program, with numbers as decimal texts in all digits of the run's scalar.
using LawInTexts = CustomLaw<std::string>;

/// Settings of a run besides its case.
struct RunSetup {
  const std::atomic<bool>* interrupt = nullptr;  ///< ends the run when it becomes true
  double max_cpu_time = std::numeric_limits<double>::infinity();  ///< of the run [s]
  std::function<void(const Progress&)> progress{};                ///< called now and then
  std::shared_ptr<const LawInTexts> ball_ball{}, ball_wall{};     ///< in place of the case's
};

class AnyRun;

/// An impact as passed to watchers.
struct SeenImpact {
  std::uint64_t index;
  double time;                                    ///< [s]
  std::function<Impact<double>()> in_double;      ///< rounded to double
  std::function<Impact<std::string>()> in_texts;  ///< in all digits of the scalar
};

class Watcher {
 public:
  virtual ~Watcher() = default;
  /// Just after the impact.
  virtual void on_impact(const SeenImpact& impact, AnyRun& run) = 0;
};

/// A case from its initial state to its results, in one scalar; numbers as doubles or exact texts.
class AnyRun {
 public:
  virtual ~AnyRun() = default;

  /// Makes the run write the outputs of the case, case.toml, final_state.csv and summary.json to a
  /// folder. Must be called before the run begins.
  /// @param checkpoint  of what checkpoints contain; with a state, the run continues from there
  /// @param without_locks  called if the file system cannot lock the folder against a second run
  /// @throws InputError when a file cannot be written, or for a folder in use or with a checkpoint
  virtual void write_to(const std::filesystem::path& folder,
      std::optional<io::Checkpoint> checkpoint = std::nullopt,
      const std::function<void(const std::filesystem::path&)>& without_locks = {}) = 0;
  /// Watchers receive every impact, in the order of attachment; they must outlive the run.
  virtual void attach(Watcher& watcher) = 0;

  /// Predicts the first contacts. @throws UndecidedError when no scalar can decide about one
  virtual void begin() = 0;
  /// Simulates to the end of the case.
  /// @throws UndecidedError when no scalar can decide; the summary covers the time up to then
  virtual void finish() = 0;
  /// Ends the run after the present impact; for watchers.
  virtual void stop(model::EndReason why) = 0;

  virtual int ball_count() const = 0;
  virtual std::string time() const = 0;  ///< [s] @pre the run has begun
  /// State of a ball now. @pre the run has begun
  virtual BallState<std::string> ball(int i) const = 0;
  virtual io::Facts facts() const = 0;           ///< of summary.json
  virtual std::string summary_json() const = 0;  ///< as in summary.json

  /// True if the run can be resumed from its checkpoint.
  virtual bool goes_on() const = 0;
  /// Moves the files into place and removes others of an earlier run. Called once, at the end.
  /// @param when_written  called when all is written; its result stays in the checkpoint until that
  /// goes
  virtual void commit(const std::function<std::string()>& when_written) = 0;
};

/// @param precision  name of the scalar, one of casefile::precisions()
/// @throws InputError when the balls find no room or the scalar cannot resolve the case
std::unique_ptr<AnyRun> make_run(
    const std::string& precision, const casefile::CaseSpec& spec, const RunSetup& setup = {});
template <class Real>
std::unique_ptr<AnyRun> make_run_in(const casefile::CaseSpec& spec, const RunSetup& setup);

}  // namespace edmill::run
