// The command `edmill compare`.
#pragma once

#include <string>

#include "check/comparison.hpp"

namespace edmill::cli {

struct CompareOptions : compare::Options {
  std::string json;  ///< file for the result; none when empty
  bool quiet = false;
};

/// @return an exit code: ok, outputs_differ or too_few_data
int run_compare(const CompareOptions& options);

}  // namespace edmill::cli
