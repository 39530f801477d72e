// The commands `edmill audit` and `edmill compare`.
#pragma once

#include <string>

#include "app/audit.hpp"
#include "compare/comparison.hpp"

namespace edmill::cli {

struct AuditOptions : app::AuditOptions {
  std::string json, junit;  ///< files for the result; none when empty
  bool quiet = false;
};

/// @return an exit code: ok, outputs_differ for violations, too_few_data
int run_audit(const casefile::CaseSpec& spec, AuditOptions options);

struct CompareOptions : compare::Options {
  std::string json, junit;  ///< files for the result; none when empty
  bool quiet = false;
};

/// @return an exit code: ok, outputs_differ or too_few_data
int run_compare(const CompareOptions& options);

}  // namespace edmill::cli
