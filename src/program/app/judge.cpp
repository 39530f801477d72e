#include "app/judge.hpp"

#include <fmt/format.h>

#include "audit/audit_fields.hpp"
#include "base/errors.hpp"
#include "dem/contact_rates.hpp"
#include "identify/identify_fields.hpp"
#include "io/input_file.hpp"

namespace edmill::app {

namespace {

/// The case's section [audit], overridden by the command line's options.
audit::Options merged(const casefile::CaseSpec& spec, const AuditOptions& given) {
  auto options = audit::options_of(spec);
  options.log = given.log;
  for (const auto& text : given.columns) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
      throw InputError(fmt::format("--column {}: {} is missing, expected ours=theirs, e.g. \"time=t [ms]\"",
                                   text, equals == 0 ? "the name" : "'='"));
    const std::string ours = text.substr(0, equals);
    std::erase_if(options.conventions.columns, [&](const auto& column) { return column.first == ours; });
    options.conventions.columns.emplace_back(ours, text.substr(equals + 1));
  }
  if (given.first_ball) options.conventions.first_ball = *given.first_ball;
  if (!given.walls.empty())
    options.conventions.walls = logs::parse_walls(given.walls, casefile::partners_of(spec), "--walls");
  if (given.tolerance) options.tolerance = *given.tolerance;
  if (given.gap_tolerance) options.gap_tolerance = given.gap_tolerance;
  options.from_start = options.from_start || given.from_start;
  options.examples = given.examples.value_or(options.examples);
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
  cases.push_back(
      {"enough impacts", result.verdict == audit::Verdict::too_few ? "too few impacts to judge" : ""});
  return compare::junit_text("edmill audit of " + result.log_name, cases);
}

void refuse(bool given, const char* options, const char* found, const char* expected) {
  if (given)
    throw InputError(fmt::format("{}: found a log of {}, expected one of {}", options, found, expected));
}

Judged judged(const auto& found) { return {found.verdict, to_json(found), to_junit(found), table(found)}; }

}  // namespace

Judged compare(const compare::ComparisonOptions& options) {
  const io::Spool pipes;
  const auto a = options.a.string(), b = options.b.string();
  if (dem::is_contact_log(a) || dem::is_contact_log(b)) {
    refuse(options.tolerance || options.events || options.batch, "--tolerance, --events, --batch",
           "contacts that last", "impacts");
    return judged(dem::compare_contacts(options));
  }
  refuse(options.within.has_value(), "--within", "impacts", "contacts that last");
  return judged(compare::compare(options));
}

Judged audit(const casefile::CaseSpec& spec, const AuditOptions& given) {
  const io::Spool pipes;
  if (dem::is_contact_log(given.log)) {
    refuse(
        !given.columns.empty() || given.first_ball || !given.walls.empty() || given.tolerance ||
            given.gap_tolerance || given.from_start || given.identify || given.examples,
        "--column, --first-ball, --walls, --tolerance, --gap-tolerance, --from-start, --identify, --examples",
        "contacts that last", "impacts");
    return judged(dem::audit_contacts(spec, given.log, given.interrupt));
  }
  const auto options = merged(spec, given);
  const auto built = casefile::build_case<double>(spec);
  auto found = audit::audit(built.the_case, built.states, options);
  found.case_name = spec.file;
  std::string table = audit::table(found);
  using identify::Search;
  std::uint64_t explained = 0;
  for (const auto& diagnosis : found.diagnoses) explained += diagnosis.events;
  const bool is_open =
      found.verdict == audit::Verdict::differ && !audit::accounts_for(explained, found.findings.total());
  std::optional<identify::Identification> identified;
  if (!found.interrupted && (given.identify || is_open)) {
    identified =
        identify::identify(spec, options, given.identify ? Search::all : Search::single, given.searching);
    table += identify::table(*identified);
  }
  const auto json = io::JsonFields::of([&](auto& v) {
    audit::Fields{found}(v);
    if (identified) identify::Fields{*identified}(v);
  });
  return {found.verdict, json, to_junit(found), table};
}

std::string document_keys() {
  const auto section = [](const char* command, const std::string& keys) {
    return fmt::format("### {}\n\n{}\n", command, keys);
  };
  return section("compare", compare::comparison_keys()) +
         section("compare, of contacts that last", dem::contact_comparison_keys()) +
         section("audit", io::KeyTable::of([](auto& v) {
                   audit::Fields{{}}(v);
                   identify::Fields{{}}(v);
                 })) +
         section("audit, of contacts that last", dem::contact_audit_keys()) +
         section("limit", dem::limit_keys());
}

}  // namespace edmill::app
