// The commands `edmill run`, `edmill demo` and `edmill resume`.
#pragma once

#include <string>
#include <vector>

#include "casefile/case_spec.hpp"

namespace edmill::cli {

struct RunCommand {
  std::string folder;      ///< of the results; out/<name of the case> when empty
  std::string precision;   ///< scalar of the run; that of the case when empty
  std::string shadow;      ///< a wider scalar to compare with; none when empty
  std::string checkpoint;  ///< how often to save the state; when empty, never, or as before
  std::vector<std::string> overrides;
  bool report = false, quiet = false;
  bool estimate = false;  ///< estimate the cost of the run, and do not run
};

/// @return an exit code
int run_case(casefile::CaseSpec spec, const RunCommand& command);
int run_resume(const RunCommand& command);

/// Adds the settings of --until-precision: the stop rule, and an end time far off unless one is set.
/// @throws InputError when it is no part of 1
void until_precision(const std::string& precision, const casefile::CaseSpec& spec,
                     std::vector<std::string>& settings);

}  // namespace edmill::cli
