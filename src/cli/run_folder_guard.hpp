// Guards the folder of a run: its lock, its checkpoint, and the temporary files of killed runs.
#pragma once

#include <filesystem>
#include <vector>

#include "cli/run_case.hpp"
#include "io/output_folder.hpp"
#include "run/simulate.hpp"

namespace edmill::cli {

/// Keeps other runs out of a folder while a run writes there.
class RunFolderGuard {
 public:
  /// @throws InputError when the folder cannot be used, or holds the checkpoint of another run
  RunFolderGuard(const casefile::CaseSpec& spec, const RunOptions& options);
  RunFolderGuard(const RunFolderGuard&) = delete;
  RunFolderGuard& operator=(const RunFolderGuard&) = delete;
  /// Without a checkpoint temporary files are of no further use.
  ~RunFolderGuard();

  const std::filesystem::path& place() const { return place_; }
  /// Instructions to the driver about checkpoints. They must not outlive this folder.
  run::Checkpoints checkpoints();
  void remove_checkpoint();

 private:
  void remove_temporaries(const std::string& kept);

  std::filesystem::path place_;
  const casefile::CaseSpec& spec_;
  std::optional<io::Checkpoint> checkpoint_;
  std::optional<io::FolderLock> lock_;
};

/// "10 min" of wall-clock time, "0.5 s simulated". @throws InputError
run::CheckpointInterval parse_checkpoint_interval(const std::string& text);

}  // namespace edmill::cli
