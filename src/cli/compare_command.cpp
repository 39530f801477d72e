#include "cli/compare_command.hpp"

#include <fmt/format.h>

#include "cli/run_case.hpp"
#include "io/output_folder.hpp"

namespace edmill::cli {

int run_compare(const CompareOptions& options) {
  const auto comparison = compare::compare(options);
  if (!options.json.empty()) {
    io::AtomicFile file(options.json);
    file.stream() << compare::to_json(comparison);
    file.commit();
  }
  if (!options.quiet) fmt::print("{}", compare::table(comparison));
  switch (comparison.verdict) {
    case compare::Verdict::agree:
      return ok;
    case compare::Verdict::differ:
      return outputs_differ;
    default:
      return too_few_data;
  }
}

}  // namespace edmill::cli
