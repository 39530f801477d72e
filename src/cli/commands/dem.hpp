// The commands between edmill and DEM codes.
#pragma once

#include <variant>

#include "casefile/quantity.hpp"
#include "cli/commands/case_argument.hpp"
#include "cli/dem_command.hpp"

namespace edmill::cli {

/// An option that is a quantity with a unit, "50 us", kept in SI.
template <class Target>
CLI::Option* add_quantity(CLI::App& command, const std::string& name, Target& target,
                          casefile::Dimension dimension, const std::string& what) {
  return command.add_option_function<std::string>(
      name,
      [&target, name, dimension](const std::string& text) {
        const auto read = casefile::parse_quantity(text, dimension);
        if (const auto* problem = std::get_if<casefile::QuantityProblem>(&read))
          throw CLI::ValidationError(
              name, "found " + problem->found + ", expected " + casefile::describe(dimension));
        const auto& quantity = std::get<casefile::Quantity>(read);
        if (!quantity.positive())
          throw CLI::ValidationError(name,
                                     "found " + text + ", expected a positive " + casefile::noun(dimension));
        target = quantity.to<double>();
      },
      what);
}

struct Export {
  static constexpr const char* name = "export";
  static constexpr const char* what = "write a case as the input of a DEM code";

  void add_options(CLI::App& command) {
    using casefile::Dimension;
    given_.add_to(command);
    command.add_option("--to", options_.code, "DEM code")
        ->required()
        ->check(CLI::IsMember(std::vector<std::string>(dem::deck_codes.begin(), dem::deck_codes.end())));
    command.add_option("--out", options_.folder, "folder for the deck; the working directory unless given");
    command.add_option("--name", options_.name, "of the files; deck unless given")
        ->check([](const std::string& text) {
          return text.find_first_of("/ \t'\"") == std::string::npos && !text.empty()
                     ? ""
                     : "expected a plain file name";
        });
    add_quantity(command, "--contact-time", options_.contact_time, Dimension::time,
                 "how long the largest ball touches a wall; \"50 us\" unless given");
    add_quantity(command, "--contact-speed", options_.speed, Dimension::speed,
                 "at which it does; \"1 m/s\" unless given");
    add_quantity(command, "--duration", options_.duration, Dimension::time,
                 "simulated; to the end of the case unless given");
    add_quantity(command, "--frames", options_.frame_interval, Dimension::time,
                 "time between frames of the dump; a fifth of the contact time unless given");
    command.add_option("--steps", options_.steps, "time steps in a contact; 50 unless given")
        ->check(CLI::Range(10, 10000));
    command
        .add_option(
            "--facets", options_.facets,
            "of a cylinder where the code has only triangles; 128 in LIGGGHTS and 24 in YADE unless given")
        ->check(CLI::Range(8, 4096));
    command.add_flag("--quiet", options_.quiet, "print nothing");
  }
  int run() { return run_export(given_.read(), options_); }

 private:
  CaseArgument given_;
  ExportOptions options_;
};

struct Import {
  static constexpr const char* name = "import";
  static constexpr const char* what = "turn the dump of a DEM code into a log of contacts";

  void add_options(CLI::App& command) {
    command
        .add_option("dump", options_.dump,
                    "frames: `dump custom` of LAMMPS (text or binary) or LIGGGHTS, or a table, also "
                    "compressed; - for "
                    "standard input; or a list of contacts with walls, as Lethe writes it")
        ->required();
    given_.add_to(command, "--case");
    command.add_option("--out", options_.out, "log of contacts (CSV); contacts.csv unless given");
    command.add_option("--deck", options_.deck, "input of the code, which gives time step, units and frame");
    add_quantity(command, "--timestep", options_.time_step, casefile::Dimension::time,
                 "of a dump that has no times");
    command.add_option("--units", options_.units, "of the dump; si unless the dump or the deck names them")
        ->check(CLI::IsMember({"si", "cgs", "micro", "nano"}));
    command.add_option("--frame", options_.frame, "frame of the dump; laboratory unless the deck names it")
        ->check(CLI::IsMember({"laboratory", "vessel"}));
    command.add_flag("--quiet", options_.quiet, "no progress line and no table");
  }
  int run() {
    if (options_.out.empty()) options_.out = "contacts.csv";
    return interruptible(given_.read(), options_, run_import);
  }

 private:
  CaseArgument given_;
  ImportOptions options_;
};

struct Limit {
  static constexpr const char* name = "limit";
  static constexpr const char* what = "extrapolate logs of contacts to contacts of no duration";

  void add_options(CLI::App& command) {
    command.add_option("logs", options_.logs, "logs of contacts of one deck with several contact times")
        ->required()
        ->expected(2, 100);
    command.add_option("--edmill", options_.run,
                       "run of edmill, or its collision log, to compare the limit with");
    add_quantity(command, "--from", options_.from, casefile::Dimension::time,
                 "time to begin at; all unless given");
    command.add_option("--json", options_.json, "file for the result in JSON");
    command.add_option("--draw", options_.svg, "file for a drawing (SVG)");
    command.add_flag("--quiet", options_.quiet, "no table");
  }
  int run() { return run_limit(options_); }

 private:
  LimitOptions options_;
};

}  // namespace edmill::cli
