// The commands that follow a case through its parameters.
#pragma once

#include "app/study.hpp"
#include "base/errors.hpp"
#include "casefile/quantity.hpp"
#include "cli/commands/case_argument.hpp"
#include "cli/commands/run.hpp"
#include "cli/exit_codes.hpp"
#include "io/progress_line.hpp"
#include "io/terminal.hpp"
#include "run/sensitivity.hpp"

namespace edmill::cli {

struct Bifurcation : CaseCommand<app::BifurcationOptions> {
  static constexpr const char* name = "bifurcation";
  static constexpr const char* what = "plot the phases of a ball's impacts against a case parameter";

  void add_options(CLI::App& command) {
    given_.add_to(command);
    command
        .add_option("--over", options_.over, "key of the case whose value is varied, \"contact.restitution\"")
        ->required();
    command.add_option("--from", options_.from, "first value, in the unit of the case file")->required();
    command.add_option("--to", options_.to, "last value, in the unit of the case file")->required();
    command.add_option("--steps", options_.steps, "number of values (default: 400)")
        ->check(CLI::Range(2, 100000));
    command
        .add_option("--skip", options_.skip,
                    "number of impacts of ball 0 with walls before the first phase is drawn (default: 1000)")
        ->check(CLI::Range(0, 100000000));
    command.add_option("--keep", options_.keep, "number of phases drawn for each value (default: 100)")
        ->check(CLI::Range(1, 100000));
    command.add_option("--above", above_,
                       "lowest approach speed of impacts that count, \"2 cm/s\", which excludes the hops of "
                       "a ball at rest (default: all impacts)");
    command.add_option("--out", options_.file,
                       "file for the drawing (SVG; default: out/<case name>.bifurcation.svg); its points are "
                       "written beside it (CSV)");
    command.add_flag("--quiet", quiet_, "print no progress and no report");
  }
  int run() {
    if (!above_.empty()) {
      const auto speed = casefile::parse_quantity(above_, casefile::Dimension::speed);
      const auto* known = std::get_if<casefile::Quantity>(&speed);
      if (known == nullptr)
        throw InputError("--above: found " + std::get<casefile::QuantityProblem>(speed).found +
                         ", expected a speed such as \"2 cm/s\"");
      options_.least_approach = known->to<double>();
    }
    name_file(".bifurcation.svg");
    return interruptible(given_.read(), options_, [this](const auto& spec, auto& options) {
      io::ProgressLine line(quiet_);
      options.progress = [&](std::size_t step) {
        line.show(fmt::format("{} of {} values ", step, options.steps));
      };
      const auto found = app::bifurcation(spec, options);
      line.clear();
      if (quiet_ || found.interrupted) return ok;
      io::print("{} phases: {}\n", found.points.size(), options.file);
      if (found.ended > 0) io::print("{} runs ended before they had all phases\n", found.ended);
      return ok;
    });
  }

 private:
  std::string above_;
};

struct Sensitivity : CaseCommand<run::SensitivityOptions> {
  static constexpr const char* name = "sensitivity";
  static constexpr const char* what =
      "compute the derivatives of the first events with respect to parameters of the case and the initial "
      "state";

  void add_options(CLI::App& command) {
    given_.add_to(command);
    command
        .add_option("--by", options_.by,
                    "key of the case, \"contact.restitution\", or a coordinate of a ball at the start, "
                    "\"initial.3.vx\"; can be repeated")
        ->required();
    command.add_option("--events", options_.events, "number of events")
        ->required()
        ->check(CLI::Range(1, 1000000));
    command.add_option("--digits", options_.digits, "number of digits of each derivative (default: 17)")
        ->check(CLI::Range(1, 1000));
    command.add_flag("--states", options_.states,
                     "also write the derivatives of the states of the balls after each impact");
    command.add_option("--out", options_.file,
                       "file for the derivatives (CSV; default: out/<case name>.sensitivity.csv)");
    command.add_flag("--quiet", quiet_, "print no progress and no report");
  }
  int run() {
    name_file(".sensitivity.csv");
    return interruptible(given_.read(), options_, [this](const auto& spec, auto& options) {
      io::ProgressLine line(quiet_);
      options.progress = [&line](const std::string& precision, std::size_t events) {
        line.show(fmt::format("{}: {} events ", precision, events));
      };
      const auto found = run::sensitivity(spec, options);
      line.clear();
      if (!quiet_ && !found.interrupted)
        io::print("{} events in {}; derivatives to {} digits: {}\n", found.events.size(), found.precision,
                  options.digits, options.file);
      return ok;
    });
  }
};

/// @tparam work  what it does; its result is nothing on ranks that only do runs of rank 0
template <std::optional<app::StudyResult> (*work)(const app::StudyOptions&)>
struct Study {
  void add_options(CLI::App& command) {
    command.add_option("file", options_.file, "sweep or optimisation file (TOML)")->required();
    command.add_option("--out", options_.folder, "folder for the tables (default: out/<name of the file>)");
    command
        .add_option("--jobs", options_.jobs,
                    "number of simultaneous runs in each process (default: all cores)")
        ->check(CLI::Range(1, 4096));
    command.add_flag("--estimate", options_.estimate,
                     "only report the number of runs and how long they will take, after short trial runs");
    command.add_flag("--quiet", options_.quiet, "print no progress line and no report");
  }
  int run() {
    return interruptible(options_, [&] { return end_of_study(work(options_), options_.quiet); });
  }

 private:
  app::StudyOptions options_;
};

struct Sweep : Study<app::sweep> {
  static constexpr const char* name = "sweep";
  static constexpr const char* what =
      "run a case with many combinations of parameters and tabulate the results";
};
struct Optimize : Study<app::optimize> {
  static constexpr const char* name = "optimize";
  static constexpr const char* what = "search for the parameters with the largest dose rate, within bounds";
};

}  // namespace edmill::cli
