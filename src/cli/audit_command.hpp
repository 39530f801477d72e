// The command `edmill audit`.
#pragma once

#include <string>
#include <vector>

#include "casefile/case_spec.hpp"
#include "check/audit.hpp"

namespace edmill::cli {

/// Options of the command line; they override the case's section [audit].
struct AuditOptions {
  std::string log;
  std::vector<std::string> columns;  ///< "ours=theirs [unit]"
  std::optional<double> tolerance, gap_tolerance;
  std::optional<int> first_ball;
  std::string walls;
  bool from_start = false;
  bool identify = false;  ///< search for the cause
  std::size_t examples = 3;
  std::string json;  ///< file for the result; none when empty
  bool quiet = false;
  const std::atomic<bool>* interrupt = nullptr;
};

/// @return an exit code: ok, outputs_differ for violations, too_few_data
int run_audit(const casefile::CaseSpec& spec, const AuditOptions& options);

}  // namespace edmill::cli
