// The commands that run a case many times.
#pragma once

#include "cli/commands/case_argument.hpp"
#include "cli/study_command.hpp"

namespace edmill::cli {

template <int (*work)(const app::StudyOptions&)>
struct Study {
  void add_options(CLI::App& command) {
    command.add_option("file", options_.file, "sweep or optimisation file (TOML)")->required();
    command.add_option("--out", options_.folder,
                       "folder for the tables; out/<name of the file> unless given");
    command.add_option("--jobs", options_.jobs, "runs at a time in each process; all cores unless given")
        ->check(CLI::Range(1, 4096));
    command.add_flag("--estimate", options_.estimate,
                     "only say how many runs there are and how long they will take, after short trials");
    command.add_flag("--quiet", options_.quiet, "no progress line and no report");
  }
  int run() {
    return interruptible(options_, [&] { return work(options_); });
  }

 private:
  app::StudyOptions options_;
};

struct Sweep : Study<run_sweep> {
  static constexpr const char* name = "sweep";
  static constexpr const char* what = "run a case at many points and tabulate the results";
};
struct Optimize : Study<run_optimize> {
  static constexpr const char* name = "optimize";
  static constexpr const char* what = "search for the largest dose rate within bounds";
};

}  // namespace edmill::cli
