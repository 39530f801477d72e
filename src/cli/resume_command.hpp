// The command `edmill resume`.
#pragma once

#include <string>

#include "cli/run_case.hpp"

namespace edmill::cli {

/// Description of a run in its checkpoints, at its start.
io::Checkpoint first_checkpoint(const casefile::CaseSpec& spec, const std::vector<std::string>& overrides,
                                const std::string& precision, bool report, const std::string& interval);

/// Continues the run of `options.folder` from its checkpoint. @param interval  empty to keep the previous one
/// @return an exit code, as of `edmill run`
/// @throws InputError when the checkpoint is not valid for this program
int run_resume(const std::string& interval, RunOptions options);

}  // namespace edmill::cli
