// Implementation of run_case; included by the instantiation files only.
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <memory>

#include "cli/run_case.hpp"
#include "cli/run_folder_guard.hpp"
#include "output/outputs.hpp"
#include "report/result_table.hpp"
#include "run/progress.hpp"
#include "run/simulate.hpp"

namespace edmill::cli {

template <class Real>
int run_case(const casefile::CaseSpec& spec, const RunOptions& options) {
  const auto built = casefile::build_case<Real>(spec);
  RunFolderGuard folder(spec, options);
  const DriveClock<Real> clock(built.the_case.mill.motion.period());
  options.listen();
  output::Outputs<Real> outputs(spec, folder.place(), clock.seconds(built.start));

  run::Guests<Real> guests;
  guests.interrupt = options.interrupt;
  guests.checkpoints = folder.checkpoints();
  if (!spec.outputs.empty()) guests.observers.push_back(&outputs);
  std::unique_ptr<run::Progress<Real>> progress;
  if (!options.quiet && ::isatty(STDERR_FILENO)) {
    std::optional<double> end;
    if (spec.end_time) end = spec.end_time->template to<double>();
    progress = std::make_unique<run::Progress<Real>>(end);
    guests.observers.push_back(progress.get());
  }
  const auto [summary, saved] = run::simulate<Real>(spec, built, guests);
  progress.reset();

  const bool goes_on = options.checkpoint && summary.end_reason == model::EndReason::interrupted;
  outputs.commit(goes_on);
  io::AtomicFile state_file(folder.place() / "final_state.csv");
  io::write_final_state<Real>(state_file.stream(), saved, clock);
  state_file.commit();
  io::AtomicFile summary_file(folder.place() / "summary.json");
  summary_file.stream() << io::summary_json(summary);
  summary_file.commit();
  options.when_written();
  if (!goes_on) folder.remove_checkpoint();

  if (!options.quiet) {
    fmt::print("{}\nResults are in {}\n", report::result_table(summary), options.folder);
    if (goes_on) fmt::print("Continue with: edmill resume {}\n", options.folder);
  }
  if (!summary.error.empty()) {
    fmt::print(stderr, "edmill: {}\n", summary.error);
    return undecided;
  }
  if (summary.stall) {
    fmt::print(stderr, "edmill: {}\n", io::stall_message(summary));
    return stalled;
  }
  if (summary.end_reason == model::EndReason::interrupted) return interrupted;
  return summary.end_reason == model::EndReason::inelastic_collapse ? inelastic_collapse : ok;
}

}  // namespace edmill::cli
