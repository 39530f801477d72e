#include "cli/audit_command.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "base/errors.hpp"
#include "cli/run_case.hpp"
#include "identify/identify.hpp"
#include "instances/instances.hpp"
#include "io/input_file.hpp"
#include "io/named_file.hpp"
#include "io/terminal.hpp"
#include "run/progress.hpp"

namespace edmill::cli {

namespace {

/// The case's section [audit], overridden by the command line's options.
audit::Options merged(const casefile::CaseSpec& spec, const AuditOptions& given) {
  audit::Options options;
  const auto& s = spec.audit;
  options.log = given.log;
  options.conventions.columns = s.columns;
  for (const auto& text : given.columns) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
      throw InputError(fmt::format("--column {}: found {}, expected ours=theirs, e.g. \"time=t [ms]\"", text,
                                   equals == 0 ? "no name" : "no '='"));
    const std::string ours = text.substr(0, equals);
    std::erase_if(options.conventions.columns, [&](const auto& column) { return column.first == ours; });
    options.conventions.columns.emplace_back(ours, text.substr(equals + 1));
  }
  options.conventions.first_ball = given.first_ball.value_or(static_cast<int>(s.first_ball.value_or(0)));
  const auto partners = casefile::partners_of(spec);
  if (!given.walls.empty())
    options.conventions.walls = audit::parse_walls(given.walls, partners, "--walls");
  else if (!s.walls.empty())
    options.conventions.walls = audit::parse_walls(s.walls, partners, spec.file + ": key 'audit.walls'");
  options.tolerance = given.tolerance.value_or(s.tolerance ? s.tolerance->to<double>() : 1e-9);
  options.gap_tolerance = given.gap_tolerance;
  if (!given.gap_tolerance && s.gap_tolerance) options.gap_tolerance = s.gap_tolerance->to<double>();
  options.from_start = given.from_start || s.from_start;
  options.examples = given.examples;
  options.interrupt = given.interrupt;
  return options;
}

}  // namespace

int run_audit(const casefile::CaseSpec& spec, const AuditOptions& given) {
  auto options = merged(spec, given);
  std::optional<io::NamedFile> file;
  if (!given.json.empty()) file.emplace(given.json);
  const io::Spool pipes;
  const auto built = casefile::build_case<double>(spec);
  std::optional<run::ProgressLine> line;
  if (!given.quiet && ::isatty(STDERR_FILENO)) {
    std::optional<double> end;
    if (spec.end_time) end = spec.end_time->to<double>();
    line.emplace(end);
    options.progress = [&](double time, std::uint64_t events) { line->show(time, events); };
  }
  auto result = audit::audit(built.the_case, built.states, options);
  line.reset();
  result.case_name = spec.file;
  std::optional<identify::Identification> found;
  if (given.identify && !result.interrupted) found = identify::identify(spec, options);
  if (file) {
    io::JsonText json;
    audit::put_json(json, result);
    if (found) identify::put_json(json, *found);
    file->write([&](std::ostream& out) { out << json.finish(); });
  }
  if (!given.quiet) io::print("{}", audit::table(result));
  if (!given.quiet && found) io::print("{}", identify::table(*found));
  switch (result.verdict) {
    case audit::Verdict::clean:
      return ok;
    case audit::Verdict::violations:
      return outputs_differ;
    default:
      return too_few_data;
  }
}

}  // namespace edmill::cli
