// From a precision's name to the run in that scalar.
#pragma once

#include "cli/run_case.hpp"

namespace edmill::cli {

/// @pre `precision` is one of casefile::precisions()
int run_case(const std::string& precision, const casefile::CaseSpec& spec, const RunOptions& options);

}  // namespace edmill::cli
