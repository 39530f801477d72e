// The command `edmill compare`.
#pragma once

#include <string>

#include "edmill/compare/comparison.hpp"

namespace edmill::app {

struct CompareOptions : compare::Options {
  std::string json;  ///< file for the result; none when empty
  bool quiet = false;
};

/// @return an exit code: ok, outputs_differ or too_few_data
int run_compare(const CompareOptions& options);

}  // namespace edmill::app
