// The commands that judge logs.
#pragma once

#include <limits>
#include <optional>

#include "app/audit.hpp"
#include "cli/commands/case_argument.hpp"
#include "cli/exit_codes.hpp"
#include "cli/progress_line.hpp"
#include "compare/comparison.hpp"
#include "dem/contact_audit.hpp"
#include "dem/contact_rates.hpp"
#include "io/input_file.hpp"
#include "io/output_folder.hpp"
#include "io/terminal.hpp"

namespace edmill::cli {

/// What becomes of a judgement.
class Judgement {
 public:
  void add_to(CLI::App& command, const char* meaning_of_quiet) {
    command.add_option("--json", json_name_, "file for the result in JSON");
    command.add_option("--junit", junit_name_, "file for the result as JUnit's XML");
    command.add_flag("--quiet", quiet, meaning_of_quiet);
  }
  /// Makes its files, before the judgement.
  void open() {
    if (!json_name_.empty()) json_.emplace(json_name_);
    if (!junit_name_.empty()) junit_.emplace(junit_name_);
  }
  void write(const std::string& json, const std::string& junit, const std::string& table) {
    if (json_) json_->write([&](std::ostream& out) { out << json; });
    if (junit_) junit_->write([&](std::ostream& out) { out << junit; });
    if (!quiet) io::print("{}", table);
  }

  bool quiet = false;

 private:
  std::string json_name_, junit_name_;
  std::optional<io::NamedFile> json_, junit_;
};

struct Compare {
  static constexpr const char* name = "compare";
  static constexpr const char* what = "compare two collision logs event by event and by statistics";

  void add_options(CLI::App& command) {
    command.add_option("A", options_.a, "reference: folder of a run, or a collision log (CSV)")->required();
    command.add_option("B", options_.b, "the other")->required();
    command.add_option("--tolerance", options_.tolerance, "relative, for single events; 1e-9 unless given")
        ->check(CLI::Range(0.0, 1.0));
    command.add_option("--events", options_.events, "number of events that must agree one by one");
    command.add_option("--from", options_.limits.from, "time in s to begin at");
    command.add_option("--until", options_.limits.until, "time in s to end at");
    command.add_option("--batch", options_.batch, "length of a batch in s; a twentieth unless given")
        ->check(CLI::PositiveNumber);
    judgement_.add_to(command, "no table");
  }
  int run() {
    judgement_.open();
    const io::Spool pipes;
    const auto a = options_.a.string(), b = options_.b.string();
    if (dem::is_contact_log(a) || dem::is_contact_log(b)) {
      const auto& [from, until] = options_.limits;
      const auto compared = dem::compare_contacts(a, b, from.value_or(0),
                                                  until.value_or(std::numeric_limits<double>::infinity()));
      judgement_.write(dem::to_json(compared), dem::to_junit(compared), dem::table(compared));
      return !compared.known ? too_few_data : compared.agree() ? ok : outputs_differ;
    }
    const auto compared = compare::compare(options_);
    judgement_.write(compare::to_json(compared), compare::to_junit(compared), compare::table(compared));
    if (compared.verdict == compare::Verdict::agree) return ok;
    return compared.verdict == compare::Verdict::differ ? outputs_differ : too_few_data;
  }

 private:
  compare::Options options_;
  Judgement judgement_;
};

struct Audit {
  static constexpr const char* name = "audit";
  static constexpr const char* what = "check another code's collision log against the physics of a case";

  void add_options(CLI::App& command) {
    given_.add_to(command);
    command.add_option("log", options_.log, "collision log (CSV), or folder of a run")->required();
    command.add_option("--column", options_.columns, "ours=theirs [unit]: name of a column; can be repeated")
        ->take_all()
        ->expected(1);
    command.add_option("--first-ball", options_.first_ball, "number of the log's first ball; 0 unless given")
        ->check(CLI::Range(0, 1000000000));
    command.add_option(
        "--walls", options_.walls,
        "numbers of the walls by id, e.g. \"1, 2, 3\" for the caps at -y and +y and the cylinder");
    command.add_option("--tolerance", options_.tolerance, "relative; 1e-9 unless given")
        ->check(CLI::Range(1e-15, 0.5));
    command
        .add_option("--gap-tolerance", options_.gap_tolerance,
                    "largest gap or overlap of bodies in contact, in m")
        ->check(CLI::PositiveNumber);
    command.add_flag("--from-start", options_.from_start, "the log begins at the case's initial state");
    command.add_flag("--identify", options_.identify,
                     "search for the value or mistake that explains the violations");
    command.add_option("--examples", options_.examples, "of each kind of violation; 3 unless given")
        ->check(CLI::Range(0, 1000));
    judgement_.add_to(command, "no progress line and no table");
  }
  int run() {
    return interruptible(given_.read(), options_,
                         [this](const auto& spec, auto& options) { return judge(spec, options); });
  }

 private:
  int judge(const casefile::CaseSpec& spec, app::AuditOptions& options) {
    const io::Spool pipes;
    const bool contacts = dem::is_contact_log(options.log);
    judgement_.open();
    if (contacts) {
      const auto audited = dem::audit_contacts(spec, {options.log, options.interrupt});
      judgement_.write(dem::to_json(audited), dem::to_junit(audited), dem::table(audited));
      if (audited.verdict == dem::ContactVerdict::agrees) return ok;
      return audited.verdict == dem::ContactVerdict::differs ? outputs_differ : too_few_data;
    }
    ProgressLine line(judgement_.quiet);
    if (line) {
      std::optional<double> end;
      if (spec.end_time) end = spec.end_time->to<double>();
      options.progress = [&line, end](double time, std::uint64_t events) { line.show(time, end, events); };
      options.searching = [&line](const std::string& stage) { line.show("searching: " + stage); };
    }
    const auto audited = app::audit(spec, options);
    line.clear();
    judgement_.write(audited.json(), audited.junit(), audited.table());
    const auto verdict = audited.result.verdict;
    if (verdict == audit::Verdict::clean) return ok;
    return verdict == audit::Verdict::violations ? outputs_differ : too_few_data;
  }

  CaseArgument given_;
  app::AuditOptions options_;
  Judgement judgement_;
};

}  // namespace edmill::cli
