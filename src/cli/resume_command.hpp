// The command `edmill resume`.
#pragma once

#include <string>

#include "cli/run_case.hpp"

namespace edmill::cli {

/// What the checkpoints of a run say of it, at its start.
io::Checkpoint first_checkpoint(const casefile::CaseSpec& spec, const std::vector<std::string>& overrides,
                                const std::string& precision, bool report, const std::string& interval);

/// Goes on with the run of `options.folder` from its checkpoint. @param interval  empty for the one it had
/// @return an exit code, as of `edmill run`
/// @throws InputError when the checkpoint does not serve
int run_resume(const std::string& interval, RunOptions options);

}  // namespace edmill::cli
