#include "cli/dem_command.hpp"

#include <filesystem>
#include <optional>

#include "cli/exit_codes.hpp"
#include "cli/progress_line.hpp"
#include "dem/contact_comparison.hpp"
#include "dem/limit.hpp"
#include "io/named_file.hpp"
#include "io/terminal.hpp"

namespace edmill::cli {

namespace {

void write(const std::string& name, const std::string& text) {
  if (!name.empty()) io::NamedFile(name).write([&](std::ostream& out) { out << text; });
}

int code_of_verdict(bool known, bool good) { return !known ? too_few_data : good ? ok : outputs_differ; }

}  // namespace

int run_export(const casefile::CaseSpec& spec, const ExportOptions& options) {
  const auto deck = dem::make_deck(spec, options);
  const std::filesystem::path folder(options.folder);
  for (const auto& file : deck.files) write((folder / file.name).string(), file.text);
  if (options.quiet) return ok;
  for (const auto& file : deck.files) io::print("wrote {}\n", (folder / file.name).string());
  for (const auto& note : deck.notes) io::print("note: {}\n", note);
  io::print(
      "run it there:    {}\nthen:            edmill import {}.dump --case {} --deck {} --out "
      "{}.contacts.csv\n",
      deck.command, options.name, spec.file, deck.files.front().name, options.name);
  return ok;
}

int run_import(const casefile::CaseSpec& spec, ImportOptions options) {
  options.in_vessel = options.frame == "vessel";
  std::optional<ProgressLine> line;
  if (shows_progress(options.quiet)) {
    line.emplace();
    options.progress = [&line](double time, std::uint64_t contacts) {
      line->show(time, std::nullopt, contacts);
    };
  }
  io::NamedFile file(options.out);
  dem::ContactLogWriter log;
  const auto imported = dem::import_dump(spec, options, log);
  line.reset();
  file.write([&](std::ostream& out) { log.write(out, imported.facts); });
  if (!options.quiet) io::print("{}", dem::table(imported, options.out));
  return ok;
}

int run_contact_audit(const casefile::CaseSpec& spec, const dem::ContactAuditOptions& options,
                      const ResultFiles& files, bool quiet) {
  const auto audit = dem::audit_contacts(spec, options);
  write(files.json, dem::to_json(audit));
  write(files.junit, dem::to_junit(audit));
  if (!quiet) io::print("{}", dem::table(audit));
  return code_of_verdict(audit.verdict != dem::ContactVerdict::too_few,
                         audit.verdict == dem::ContactVerdict::agrees);
}

int run_contact_comparison(const std::string& a, const std::string& b, double from, double until,
                           const ResultFiles& files, bool quiet) {
  const auto comparison = dem::compare_contacts(a, b, from, until);
  write(files.json, dem::to_json(comparison));
  write(files.junit, dem::to_junit(comparison));
  if (!quiet) io::print("{}", dem::table(comparison));
  return code_of_verdict(comparison.known, comparison.agree());
}

int run_limit(const LimitOptions& options) {
  const auto limit = dem::limit_of(options.logs, options.run, options.from);
  write(options.json, dem::to_json(limit));
  write(options.svg, dem::to_svg(limit));
  if (!options.quiet) io::print("{}", dem::table(limit));
  return ok;
}

}  // namespace edmill::cli
