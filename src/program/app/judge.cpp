#include "app/judge.hpp"

#include <fmt/format.h>

#include <limits>

#include "base/errors.hpp"
#include "compare/junit.hpp"
#include "dem/contact_audit.hpp"
#include "dem/contact_rates.hpp"
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

std::string to_junit(const audit::Audit& result) {
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
    cases.push_back({std::string(audit::info(check).name), problem});
  }
  const bool judged = result.verdict == audit::Verdict::clean || result.verdict == audit::Verdict::violations;
  cases.push_back({"enough impacts", judged ? "" : "too few impacts to judge"});
  return compare::junit_text("edmill audit of " + result.log_name, cases);
}

Judged::Verdict verdict_of(bool good, bool bad) {
  return good ? Judged::Verdict::good : bad ? Judged::Verdict::bad : Judged::Verdict::too_few_data;
}

Judged judged(const auto& found, bool good, bool bad) {
  return {verdict_of(good, bad), to_json(found), to_junit(found), table(found)};
}

}  // namespace

Judged compare(const compare::Options& options) {
  const io::Spool pipes;
  const auto a = options.a.string(), b = options.b.string();
  if (dem::is_contact_log(a) || dem::is_contact_log(b)) {
    const auto& [from, until] = options.limits;
    const auto found = dem::compare_contacts(a, b, from.value_or(0),
                                             until.value_or(std::numeric_limits<double>::infinity()));
    return judged(found, found.known && found.agree(), found.known);
  }
  const auto found = compare::compare(options);
  return judged(found, found.verdict == compare::Verdict::agree, found.verdict == compare::Verdict::differ);
}

Judged audit(const casefile::CaseSpec& spec, const AuditOptions& given) {
  const io::Spool pipes;
  if (dem::is_contact_log(given.log)) {
    const auto found = dem::audit_contacts(spec, {given.log, given.interrupt});
    return judged(found, found.verdict == dem::ContactVerdict::agrees,
                  found.verdict == dem::ContactVerdict::differs);
  }
  const auto options = merged(spec, given);
  const auto built = casefile::build_case<double>(spec);
  auto found = audit::audit(built.the_case, built.states, options);
  found.case_name = spec.file;
  std::string table = audit::table(found);
  io::JsonText json;
  audit::put_json(json, found);
  using identify::Search;
  if (!found.interrupted && (given.identify || found.verdict == audit::Verdict::violations)) {
    const auto identified =
        identify::identify(spec, options, given.identify ? Search::all : Search::single, given.searching);
    table += identify::table(identified);
    identify::put_json(json, identified);
  }
  return {verdict_of(found.verdict == audit::Verdict::clean, found.verdict == audit::Verdict::violations),
          json.finish(), to_junit(found), table};
}

}  // namespace edmill::app
