#include "app/audit.hpp"

#include <fmt/format.h>

#include "base/errors.hpp"
#include "compare/junit.hpp"
#include "io/input_file.hpp"
#include "io/json_text.hpp"

namespace edmill::app {

namespace {

/// The case's section [audit], overridden by the command line's options.
audit::Options merged(const casefile::CaseSpec& spec, const AuditOptions& given) {
  auto options = audit::options_of(spec);
  options.log = given.log;
  for (const auto& text : given.columns) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
      throw InputError(fmt::format("--column {}: found {}, expected ours=theirs, e.g. \"time=t [ms]\"", text,
                                   equals == 0 ? "no name" : "no '='"));
    const std::string ours = text.substr(0, equals);
    std::erase_if(options.conventions.columns, [&](const auto& column) { return column.first == ours; });
    options.conventions.columns.emplace_back(ours, text.substr(equals + 1));
  }
  if (given.first_ball) options.conventions.first_ball = *given.first_ball;
  if (!given.walls.empty())
    options.conventions.walls = audit::parse_walls(given.walls, casefile::partners_of(spec), "--walls");
  if (given.tolerance) options.tolerance = *given.tolerance;
  if (given.gap_tolerance) options.gap_tolerance = given.gap_tolerance;
  options.from_start = options.from_start || given.from_start;
  options.examples = given.examples;
  options.interrupt = given.interrupt;
  options.progress = given.progress;
  return options;
}

}  // namespace

Audited audit(const casefile::CaseSpec& spec, const AuditOptions& given) {
  auto options = merged(spec, given);
  const io::Spool pipes;
  const auto built = casefile::build_case<double>(spec);
  Audited audited{audit::audit(built.the_case, built.states, options), {}};
  audited.result.case_name = spec.file;
  if (given.identify && !audited.result.interrupted)
    audited.identified = identify::identify(spec, options, given.searching);
  return audited;
}

std::string Audited::table() const {
  return audit::table(result) + (identified ? identify::table(*identified) : "");
}

std::string Audited::json() const {
  io::JsonText text;
  audit::put_json(text, result);
  if (identified) identify::put_json(text, *identified);
  return text.finish();
}

std::string Audited::junit() const {
  std::vector<compare::JunitCase> cases;
  for (std::size_t k = 0; k < audit::check_count; ++k) {
    const auto check = static_cast<audit::Check>(k);
    if (result.findings.judged_number(check) == 0) continue;
    std::string problem;
    for (const auto kind : result.findings.ranked()) {
      const auto& [name, unit, meaning, own] = audit::info(kind);
      const auto& tally = result.findings.of(kind);
      if (own == check)
        problem += fmt::format("{}{}: {} times, at worst {:.3g} {}; {}", problem.empty() ? "" : "\n", name,
                               tally.count, tally.worst, unit, meaning);
    }
    cases.emplace_back(audit::info(check).name, problem);
  }
  cases.emplace_back("enough impacts",
                     result.verdict == audit::Verdict::clean || result.verdict == audit::Verdict::violations
                         ? ""
                         : "too few impacts to judge");
  return compare::junit_text("edmill audit of " + result.log_name, cases);
}

}  // namespace edmill::app
