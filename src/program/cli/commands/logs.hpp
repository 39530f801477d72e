// The commands that judge logs.
#pragma once

#include <optional>

#include "app/judge.hpp"
#include "cli/commands/case_argument.hpp"
#include "cli/exit_codes.hpp"
#include "io/output_folder.hpp"
#include "io/progress_line.hpp"
#include "io/terminal.hpp"

namespace edmill::cli {

inline int code_of(compare::Verdict verdict) {
  using compare::Verdict;
  return verdict == Verdict::differ ? outputs_differ : verdict == Verdict::too_few ? too_few_data : ok;
}

/// Options of a command that judges, its output files and its exit code.
class Judgement {
 public:
  void add_to(CLI::App& command, const char* meaning_of_quiet) {
    command.add_option("--json", json_, "file for the result as JSON");
    command.add_option("--junit", junit_, "file for the result as JUnit XML");
    command.add_flag("--quiet", quiet, meaning_of_quiet);
  }
  /// Makes the files, then judges. @return the exit code
  int of(const auto& judge) const {
    io::NamedFile json(json_), junit(junit_);
    const app::Judged judged = judge();
    json.write(judged.json);
    junit.write(judged.junit);
    if (!quiet) io::print("{}", judged.table);
    return code_of(judged.verdict);
  }

  bool quiet = false;

 private:
  std::string json_, junit_;
};

struct Compare {
  static constexpr const char* name = "compare";
  static constexpr const char* what = "compare two collision logs event by event and by statistics";

  void add_options(CLI::App& command) {
    command.add_option("A", options_.a, "reference: folder of a run, or a collision log (CSV)")->required();
    command.add_option("B", options_.b, "log to compare with it: folder of a run, or a collision log (CSV)")
        ->required();
    command
        .add_option("--tolerance", options_.tolerance, "relative tolerance for single events (default: 1e-9)")
        ->check(CLI::Range(0.0, 1.0));
    command.add_option("--events", options_.events,
                       "number of events that must agree one by one (default: none)");
    command.add_option("--from", options_.limits.from,
                       "start of the statistics, in s (default: where those of both runs begin)");
    command.add_option("--until", options_.limits.until,
                       "end of the statistics, in s (default: the end of the shorter log)");
    command.add_option("--within", within_,
                       "largest relative difference of dose rates that agree, for contacts that last: \"5%\" "
                       "or 0.05 (default: by their 95 % intervals)");
    command
        .add_option("--batch", options_.batch,
                    "length of a batch in s (default: a twentieth of the common time)")
        ->check(CLI::PositiveNumber);
    judgement_.add_to(command, "print no table");
  }
  int run() {
    if (!within_.empty()) options_.within = part_of_one("--within", within_);
    return judgement_.of([this] { return app::compare(options_); });
  }

 private:
  compare::ComparisonOptions options_;
  std::string within_;
  Judgement judgement_;
};

struct Audit {
  static constexpr const char* name = "audit";
  static constexpr const char* what = "check another code's collision log against the physics of a case";

  void add_options(CLI::App& command) {
    given_.add_to(command);
    command.add_option("log", options_.log, "collision log (CSV), or folder of a run")->required();
    command
        .add_option("--column", options_.columns,
                    "ours=theirs [unit]: edmill's name of a column, and its name in the log; can be repeated")
        ->take_all()
        ->expected(1);
    command.add_option("--first-ball", options_.first_ball, "number of the log's first ball (default: 0)")
        ->check(CLI::Range(0, 1000000000));
    command.add_option("--walls", options_.walls,
                       "the log's numbers of the walls, in the order of edmill's ids: \"1, 2, 3\" for the "
                       "caps at -y and +y and the cylinder (default: those of edmill)");
    command.add_option("--tolerance", options_.tolerance, "relative tolerance (default: 1e-9)")
        ->check(CLI::Range(1e-15, 0.5));
    command
        .add_option("--gap-tolerance", options_.gap_tolerance,
                    "largest gap or overlap of bodies in contact, in m (default: by rounding)")
        ->check(CLI::PositiveNumber);
    command.add_flag("--from-start", options_.from_start,
                     "treat the log as one that begins at the initial state of the case");
    command.add_flag(
        "--identify", options_.identify,
        "also search for causes in parts of the log, and for combinations of two and three causes");
    command
        .add_option("--examples", options_.examples,
                    "number of examples of each kind of violation (default: 3)")
        ->check(CLI::Range(0, 1000));
    judgement_.add_to(command, "print no progress line and no table");
  }
  int run() {
    return interruptible(given_.read(), options_, [this](const casefile::CaseSpec& spec, auto& options) {
      return judgement_.of([&] {
        io::ProgressLine line(judgement_.quiet);
        if (line) {
          std::optional<double> end;
          if (spec.end_time) end = spec.end_time->to<double>();
          options.progress = [&line, end](double time, std::uint64_t events) {
            line.show(time, end, events);
          };
          options.searching = [&line](const std::string& stage) { line.show("searching: " + stage); };
        }
        return app::audit(spec, options);
      });
    });
  }

 private:
  CaseArgument given_;
  app::AuditOptions options_;
  Judgement judgement_;
};

}  // namespace edmill::cli
