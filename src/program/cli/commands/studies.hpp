// The commands that run a case many times.
#pragma once

#include "app/study.hpp"
#include "cli/commands/case_argument.hpp"
#include "cli/exit_codes.hpp"
#include "io/terminal.hpp"

namespace edmill::cli {

/// @tparam work  what it does; its result is nothing on ranks that only do runs of rank 0
template <std::optional<app::StudyResult> (*work)(const app::StudyOptions&)>
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
    return interruptible(options_, [&] { return end_of(work(options_)); });
  }

 private:
  /// @return an exit code; `ok` for an interrupted study too, whose signal the caller knows
  int end_of(const std::optional<app::StudyResult>& result) const {
    if (!result) return ok;
    if (!result->estimate.empty()) return io::print("{}\n", result->estimate), ok;
    const auto& c = result->counts;
    if (!options_.quiet)
      io::print("{}{} runs: {} reused, {} run now, {} failed{}\nTables are in {}\n", result->optimum, c.total,
                c.kept, c.ran, c.failed, result->interrupted ? ", interrupted" : "", result->folder);
    return c.failed > 0 ? some_runs_failed : ok;
  }

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
