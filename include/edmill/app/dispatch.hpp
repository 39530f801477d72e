// From a precision's name to the run in that scalar.
#pragma once

#include "edmill/app/run_case.hpp"

namespace edmill::app {

/// @pre `precision` is one of casefile::precisions()
int run_case(const std::string& precision, const casefile::CaseSpec& spec, const RunOptions& options);

}  // namespace edmill::app
