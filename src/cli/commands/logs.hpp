// The commands that judge logs.
#pragma once

#include "cli/audit_command.hpp"
#include "cli/commands/case_argument.hpp"

namespace edmill::cli {

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
    command.add_option("--json", options_.json, "file for the result in JSON");
    command.add_option("--junit", options_.junit, "file for the result as JUnit's XML");
    command.add_flag("--quiet", options_.quiet, "no table");
  }
  int run() { return run_compare(options_); }

 private:
  CompareOptions options_;
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
    command.add_option("--json", options_.json, "file for the result in JSON");
    command.add_option("--junit", options_.junit, "file for the result as JUnit's XML");
    command.add_flag("--quiet", options_.quiet, "no progress line and no table");
  }
  int run() { return interruptible(given_.read(), options_, run_audit); }

 private:
  CaseArgument given_;
  AuditOptions options_;
};

}  // namespace edmill::cli
