// The command `edmill sensitivity`.
#pragma once

#include "app/sensitivity.hpp"
#include "cli/commands/case_argument.hpp"
#include "cli/exit_codes.hpp"
#include "cli/progress_line.hpp"
#include "io/terminal.hpp"

namespace edmill::cli {

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
      const auto found = app::sensitivity(spec, options);
      if (show) io::tell("{}", no_line);
      if (!quiet_ && !found.interrupted)
        io::print("{} events in {}; derivatives to {} digits: {}\n", found.events.size(), found.precision,
                  options.digits, options.file);
      return ok;
    });
  }

 private:
  CaseArgument given_;
  app::SensitivityOptions options_;
  bool quiet_ = false;
};

}  // namespace edmill::cli
