// The description of a run's files for archives: RO-Crate 1.1, ro-crate-metadata.json.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace edmill::io {

inline constexpr const char* crate_file = "ro-crate-metadata.json";

struct Crate {
  std::string case_digest, precision;
  std::vector<std::filesystem::path> files;  ///< relative to the folder of the run
};

/// JSON-LD with the files, their kinds and the program that made them. The date is that of SOURCE_DATE_EPOCH
/// if the environment has it, else today's (UTC).
std::string crate_text(const Crate& crate);

}  // namespace edmill::io
