// Implementation of run_case; included by the instantiation files only.
#pragma once

#include <unistd.h>

#include <memory>

#include "cli/run_case.hpp"
#include "io/terminal.hpp"
#include "output/write_results.hpp"
#include "report/result_table.hpp"
#include "run/progress.hpp"
#include "run/simulate.hpp"

namespace edmill::cli {

template <class Real>
int run_case(const casefile::CaseSpec& spec, const RunOptions& options) {
  const auto built = casefile::build_case<Real>(spec);
  run::RunFolder folder(options.folder, spec, options.checkpoint);
  if (!folder.locked()) tell_of_missing_locks(folder.place());
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
  output::write_results<Real>(folder, outputs, saved, clock, io::summary_json(summary), options.case_text,
                              goes_on);
  options.when_written();
  if (!goes_on) folder.remove_checkpoint();

  if (!options.quiet) {
    io::print("{}\nResults are in {}\n", report::result_table(summary), options.folder);
    if (goes_on) io::print("Continue with: edmill resume {}\n", options.folder);
  }
  if (!summary.error.empty()) io::tell("edmill: {}\n", summary.error);
  switch (summary.end_reason) {
    case model::EndReason::undecided:
      return undecided;
    case model::EndReason::stalled:
      return stalled;
    case model::EndReason::interrupted:
      return interrupted;
    case model::EndReason::inelastic_collapse:
      return inelastic_collapse;
    default:
      return ok;
  }
}

}  // namespace edmill::cli
