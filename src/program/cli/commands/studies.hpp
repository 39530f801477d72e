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
    command.add_option("--over", options_.over, "key of a parameter of the case, \"contact.restitution\"")
        ->required();
    command.add_option("--from", options_.from, "first value, in the unit of the case file")->required();
    command.add_option("--to", options_.to, "last value")->required();
    command.add_option("--steps", options_.steps, "how many values (default: 400)")
        ->check(CLI::Range(2, 100000));
    command
        .add_option("--skip", options_.skip,
                    "impacts of ball 0 with walls before the first phase (default: 1000)")
        ->check(CLI::Range(0, 100000000));
    command.add_option("--keep", options_.keep, "number of phases drawn after these (default: 100)")
        ->check(CLI::Range(1, 100000));
    command.add_option("--above", above_,
                       "slower impacts do not count, such as the hops of a ball that rests: \"2 cm/s\"");
    command.add_option(
        "--out", options_.file,
        "drawing (SVG), with its points beside it (CSV; default: out/<case name>.bifurcation.svg)");
    command.add_flag("--quiet", quiet_, "no progress and no report");
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
      "derivatives of the first events with respect to parameters of the case and the initial state";

  void add_options(CLI::App& command) {
    given_.add_to(command);
    command
        .add_option("--by", options_.by,
                    "key of a parameter of the case, \"contact.restitution\", or \"initial.3.vx\", of ball 3 "
                    "at the start; can be repeated")
        ->required();
    command.add_option("--events", options_.events, "how many")->required()->check(CLI::Range(1, 1000000));
    command.add_option("--digits", options_.digits, "digits of each derivative (default: 17)")
        ->check(CLI::Range(1, 1000));
    command.add_flag("--states", options_.states, "also those of the balls' states after each impact");
    command.add_option("--out", options_.file, "file (CSV; default: out/<case name>.sensitivity.csv)");
    command.add_flag("--quiet", quiet_, "no progress and no report");
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
    command.add_option("--jobs", options_.jobs, "runs at a time in each process (default: all cores)")
        ->check(CLI::Range(1, 4096));
    command.add_flag("--estimate", options_.estimate,
                     "only say how many runs there are and how long they will take, after short trials");
    command.add_flag("--quiet", options_.quiet, "no progress line and no report");
  }
  int run() {
    return interruptible(options_, [&] { return end_of_study(work(options_), options_.quiet); });
  }

 private:
  app::StudyOptions options_;
};

struct Sweep : Study<app::sweep> {
  static constexpr const char* name = "sweep";
  static constexpr const char* what = "run a case at many points and tabulate the results";
};
struct Optimize : Study<app::optimize> {
  static constexpr const char* name = "optimize";
  static constexpr const char* what = "search for the largest dose rate within bounds";
};

}  // namespace edmill::cli
