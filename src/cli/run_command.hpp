// A run with the files beside its results: the case, and the page on request.
#pragma once

#include "cli/run_case.hpp"

namespace edmill::cli {

/// @pre `precision` is one of casefile::precisions()
/// @return an exit code, as of run_case
int run_and_report(const std::string& precision, casefile::CaseSpec spec, RunOptions options);

}  // namespace edmill::cli
