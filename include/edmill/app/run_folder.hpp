// The folder of a run: its lock, its checkpoint, and what killed runs have left in it.
#pragma once

#include <filesystem>
#include <vector>

#include "edmill/app/run_case.hpp"
#include "edmill/driver/simulate.hpp"
#include "edmill/record/output_folder.hpp"

namespace edmill::app {

class RunFolder {
 public:
  /// @throws InputError when the folder cannot be used, or holds the checkpoint of another run
  RunFolder(const casefile::CaseSpec& spec, const RunOptions& options);
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;
  /// Without a checkpoint there is nothing that temporary files could be kept for.
  ~RunFolder();

  const std::filesystem::path& place() const { return place_; }
  /// What the driver is to do about checkpoints. It must not outlive this folder.
  driver::Checkpoints checkpoints();
  void remove_checkpoint();

 private:
  void remove_temporaries(const std::string& kept);

  std::filesystem::path place_;
  const casefile::CaseSpec& spec_;
  std::optional<record::Checkpoint> checkpoint_;
  std::optional<record::FolderLock> lock_;
};

/// "10 min" by the clock on the wall, "0.5 s simulated". @throws InputError
observe::CheckpointInterval parse_checkpoint_interval(const std::string& text);

}  // namespace edmill::app
