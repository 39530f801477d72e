#include "cli/compare_command.hpp"

#include <optional>

#include "cli/run_case.hpp"
#include "io/input_file.hpp"
#include "io/named_file.hpp"
#include "io/terminal.hpp"

namespace edmill::cli {

int run_compare(const CompareOptions& options) {
  std::optional<io::NamedFile> json;
  if (!options.json.empty()) json.emplace(options.json);
  const io::Spool pipes;
  const auto comparison = compare::compare(options);
  if (json) json->write([&](std::ostream& out) { out << compare::to_json(comparison); });
  if (!options.quiet) io::print("{}", compare::table(comparison));
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
