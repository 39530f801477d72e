// The commands `edmill sweep` and `edmill optimize`.
#pragma once

#include "app/study.hpp"

namespace edmill::cli {

/// @return an exit code; `ok` for an interrupted study too, whose signal the caller knows
int run_sweep(const app::StudyOptions& options);
int run_optimize(const app::StudyOptions& options);

}  // namespace edmill::cli
