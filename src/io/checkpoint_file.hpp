// The file `checkpoint`: everything that an unfinished run needs to go on. docs/files.md
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/archive.hpp"

namespace edmill::io {

struct Checkpoint {
  std::string case_file, case_text, initial_state;  ///< of the case: name, text, path of its initial state
  std::vector<std::string> overrides;               ///< "section.key=value"
  std::string case_digest, precision;
  bool report = false;         ///< whether the page was asked for
  std::string interval;        ///< between checkpoints, as it was given
  std::string temporary_mark;  ///< of the files that the run goes on with
  std::string state;           ///< of the run

  void archive(Archive& a) {
    a(case_file, case_text, initial_state, overrides, case_digest, precision, report, interval,
      temporary_mark, state);
  }
};

/// Replaces the folder's checkpoint; a kill at any moment leaves the old one or the new one.
/// @throws std::runtime_error when it was not written; the old one is then still there
void write_checkpoint(const std::filesystem::path& folder, Checkpoint checkpoint);

/// @throws InputError when there is none, when it is damaged, or when another version or commit wrote it
Checkpoint read_checkpoint(const std::filesystem::path& folder);

/// Where a folder's checkpoint stands.
std::filesystem::path checkpoint_place(const std::filesystem::path& folder);

}  // namespace edmill::io
