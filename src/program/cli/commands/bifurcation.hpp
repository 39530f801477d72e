// The commands that follow a case through its parameters.
#pragma once

#include "app/study.hpp"
#include "base/errors.hpp"
#include "casefile/quantity.hpp"
#include "cli/commands/case_argument.hpp"
#include "cli/exit_codes.hpp"
#include "cli/progress_line.hpp"
#include "io/terminal.hpp"
#include "run/sensitivity.hpp"

namespace edmill::cli {

struct Bifurcation {
  static constexpr const char* name = "bifurcation";
  static constexpr const char* what = "plot the phases of a ball's impacts against a case parameter";

  void add_options(CLI::App& command) {
    given_.add_to(command);
    command.add_option("--over", options_.over, "key of a parameter of the case, \"contact.restitution\"")
        ->required();
    command.add_option("--from", options_.from, "first value, in the unit of the case file")->required();
    command.add_option("--to", options_.to, "last value")->required();
    command.add_option("--steps", options_.steps, "how many values; 400 unless given")
        ->check(CLI::Range(2, 100000));
    command
        .add_option("--skip", options_.skip,
                    "impacts of ball 0 with walls before the first phase; 1000 unless given")
        ->check(CLI::Range(0, 100000000));
    command.add_option("--keep", options_.keep, "number of phases drawn after these; 100 unless given")
        ->check(CLI::Range(1, 100000));
    command.add_option("--above", above_,
                       "slower impacts do not count, such as the hops of a ball that rests: \"2 cm/s\"");
    command.add_option(
        "--out", options_.file,
        "drawing (SVG), with its points beside it (CSV); out/<case name>.bifurcation.svg unless given");
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
    if (options_.file.empty()) options_.file = "out/" + name_of(given_.file) + ".bifurcation.svg";
    return interruptible(given_.read(), options_, [this](const auto& spec, auto& options) {
      const bool show = shows_progress(quiet_);
      if (show)
        options.progress = [&](std::size_t step) {
          io::tell("{}{} of {} values ", no_line, step, options.steps);
        };
      const auto found = app::bifurcation(spec, options);
      if (show) io::tell("{}", no_line);
      if (quiet_ || found.interrupted) return ok;
      io::print("{} phases: {}\n", found.points.size(), options.file);
      if (found.ended > 0) io::print("{} runs ended before they had all phases\n", found.ended);
      return ok;
    });
  }

 private:
  CaseArgument given_;
  app::BifurcationOptions options_;
  std::string above_;
  bool quiet_ = false;
};

struct Sensitivity {
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
    command.add_option("--digits", options_.digits, "of each derivative; 17 unless given")
        ->check(CLI::Range(1, 1000));
    command.add_flag("--states", options_.states, "also those of the balls' states after each impact");
    command.add_option("--out", options_.file, "file (CSV); out/<case name>.sensitivity.csv unless given");
    command.add_flag("--quiet", quiet_, "no progress and no report");
  }
  int run() {
    if (options_.file.empty()) options_.file = "out/" + name_of(given_.file) + ".sensitivity.csv";
    return interruptible(given_.read(), options_, [this](const auto& spec, auto& options) {
      const bool show = shows_progress(quiet_);
      if (show)
        options.progress = [](const std::string& precision, std::size_t events) {
          io::tell("{}{}: {} events ", no_line, precision, events);
        };
      const auto found = run::sensitivity(spec, options);
      if (show) io::tell("{}", no_line);
      if (!quiet_ && !found.interrupted)
        io::print("{} events in {}; derivatives to {} digits: {}\n", found.events.size(), found.precision,
                  options.digits, options.file);
      return ok;
    });
  }

 private:
  CaseArgument given_;
  run::SensitivityOptions options_;
  bool quiet_ = false;
};

}  // namespace edmill::cli
