// The file `checkpoint`: everything that is needed to continue an unfinished run. docs/files.md
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/archive.hpp"

namespace edmill::io {

struct Checkpoint {
  std::string case_file, case_text,
      initial_state;                   ///< of the case: name, text, path of its initial state
  std::vector<std::string> overrides;  ///< "section.key=value"
  std::string case_digest, precision;
  std::optional<std::uint64_t> right_digits;  ///< of a run in digits that were asked for
  bool report = false;                        ///< whether the page was requested
  std::string interval;                       ///< between checkpoints, as given
  std::string state;                          ///< of the run
  std::string result;  ///< of a run in place: only its temporary files are left to remove

  void archive(Archive& a) {
    a(case_file, case_text, initial_state, overrides, case_digest, precision, right_digits, report,
        interval, state, result);
  }
};

/// Replaces the folder's checkpoint; a kill at any moment leaves the old one or the new one.
/// @throws std::runtime_error when it was not written; the old one is then kept
void write_checkpoint(const std::filesystem::path& folder, Checkpoint checkpoint);

/// @throws InputError when it is absent, damaged, or of another version or commit
Checkpoint read_checkpoint(const std::filesystem::path& folder);

/// @throws InputError when an unfinished run has left one, from which it could continue
void require_no_checkpoint(const std::filesystem::path& folder);

std::filesystem::path checkpoint_place(const std::filesystem::path& folder);

}  // namespace edmill::io
