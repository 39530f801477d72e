// A run with what belongs beside its results: the case, and the page when it was asked for.
#pragma once

#include "cli/run_case.hpp"

namespace edmill::cli {

/// @pre `precision` is one of casefile::precisions()
/// @return an exit code, as of run_case
int run_and_report(const std::string& precision, casefile::CaseSpec spec, RunOptions options);

}  // namespace edmill::cli
