// The folder of a run: locks, checkpoints, and how results are put in place. docs/files.md
#pragma once

#include <filesystem>
#include <functional>
#include <list>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "casefile/case_spec.hpp"
#include "io/atomic_file.hpp"
#include "io/checkpoint_file.hpp"
#include "io/output_folder.hpp"

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
  /// The state to resume from, of the same case and program; empty at the start of a run.
  std::string_view restored;
};

/// Description of a run's files for archives: RO-Crate 1.1.
inline constexpr const char* crate_file = "ro-crate-metadata.json";

/// The folder that a run writes to. While this object lives, other processes cannot use it.
class RunFolder {
 public:
  /// @param checkpoint  of a run that makes them; with a state, the run continues there
  /// @throws InputError for a folder that is unusable, in use, or has the checkpoint of another run
  RunFolder(std::filesystem::path place, const casefile::CaseSpec& spec,
      std::optional<io::Checkpoint> checkpoint = std::nullopt);
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;
  /// Removes temporary files unless a checkpoint needs them.
  ~RunFolder();

  const std::filesystem::path& place() const { return place_; }
  /// True if the file system locks the folder against other processes.
  bool locked() const { return locks_.front().held(); }
  bool has_checkpoint() const { return checkpoint_.has_value(); }
  /// Instructions to the driver about checkpoints. They must not outlive this folder.
  Checkpoints checkpoints();

  /// Writes a file of the run itself, which `commit` puts in place. @throws std::runtime_error
  void write(const std::string& name, const std::function<void(std::ostream&)>& put);
  /// Describes these files, relative to the folder, and the program that made them, with the date
  /// of SOURCE_DATE_EPOCH if the environment has it, else today's (UTC).
  void write_crate(const std::string& case_digest, const std::string& precision,
      const std::vector<std::filesystem::path>& files);
  /// Moves these complete results into place, then the run's own; removes others of earlier runs.
  void commit(std::vector<io::WholeFile*> files);
  /// Removes the checkpoint of a run that has ended. @param result  kept there until then
  void remove_checkpoint(const std::string& result);
 private:
  void take(const std::filesystem::path& folder);
  void remove_leftovers() const;

  std::filesystem::path place_;
  std::vector<std::filesystem::path> folders_;  ///< including those of the outputs
  std::vector<io::FolderLock> locks_;           ///< in the same order
  std::optional<io::Checkpoint> checkpoint_;
  std::list<io::AtomicFile> own_files_;
};

/// "10 min" of wall-clock time, "0.5 s simulated". @throws InputError
CheckpointInterval parse_checkpoint_interval(const std::string& text);

}  // namespace edmill::run
