#include "cli/study_command.hpp"

#include "cli/exit_codes.hpp"
#include "io/terminal.hpp"

namespace edmill::cli {

namespace {

int end_of(const std::optional<app::StudyResult>& result, bool quiet) {
  if (!result) return ok;
  if (!result->estimate.empty()) return io::print("{}\n", result->estimate), ok;
  const auto& c = result->counts;
  if (!quiet)
    io::print("{}{} runs: {} reused, {} run now, {} failed{}\nTables are in {}\n", result->optimum, c.total,
              c.kept, c.ran, c.failed, result->interrupted ? ", interrupted" : "", result->folder);
  return c.failed > 0 ? some_runs_failed : ok;
}

}  // namespace

int run_sweep(const app::StudyOptions& options) { return end_of(app::sweep(options), options.quiet); }
int run_optimize(const app::StudyOptions& options) { return end_of(app::optimize(options), options.quiet); }

}  // namespace edmill::cli
