#include "cli/audit_command.hpp"

#include <limits>
#include <optional>

#include "cli/dem_command.hpp"
#include "cli/exit_codes.hpp"
#include "cli/progress_line.hpp"
#include "io/input_file.hpp"
#include "io/named_file.hpp"
#include "io/terminal.hpp"

namespace edmill::cli {

int run_audit(const casefile::CaseSpec& spec, AuditOptions options) {
  const io::Spool pipes;
  if (dem::is_contact_log(options.log))
    return run_contact_audit(spec, {options.log, options.interrupt}, {options.json, options.junit},
                             options.quiet);
  auto json = io::file_for(options.json), junit = io::file_for(options.junit);
  std::optional<ProgressLine> line;
  if (shows_progress(options.quiet)) {
    std::optional<double> end;
    if (spec.end_time) end = spec.end_time->to<double>();
    line.emplace();
    options.progress = [&line, end](double time, std::uint64_t events) { line->show(time, end, events); };
    options.searching = [&line](const std::string& stage) { line->show("searching: " + stage); };
  }
  const auto audited = app::audit(spec, options);
  line.reset();
  if (json) json->write([&](std::ostream& out) { out << audited.json(); });
  if (junit) junit->write([&](std::ostream& out) { out << audited.junit(); });
  if (!options.quiet) io::print("{}", audited.table());
  const auto verdict = audited.result.verdict;
  if (verdict == audit::Verdict::clean) return ok;
  return verdict == audit::Verdict::violations ? outputs_differ : too_few_data;
}

int run_compare(const CompareOptions& options) {
  auto json = io::file_for(options.json), junit = io::file_for(options.junit);
  const io::Spool pipes;
  if (dem::is_contact_log(options.a.string()) || dem::is_contact_log(options.b.string()))
    return run_contact_comparison(options.a.string(), options.b.string(), options.limits.from.value_or(0),
                                  options.limits.until.value_or(std::numeric_limits<double>::infinity()),
                                  {options.json, options.junit}, options.quiet);
  const auto comparison = compare::compare(options);
  if (json) json->write([&](std::ostream& out) { out << compare::to_json(comparison); });
  if (junit) junit->write([&](std::ostream& out) { out << compare::to_junit(comparison); });
  if (!options.quiet) io::print("{}", compare::table(comparison));
  if (comparison.verdict == compare::Verdict::agree) return ok;
  return comparison.verdict == compare::Verdict::differ ? outputs_differ : too_few_data;
}

}  // namespace edmill::cli
