// Implementation of run_in; included by the instantiation files only.
#pragma once

#include "app/run.hpp"
#include "output/write_results.hpp"
#include "report/result_table.hpp"
#include "run/progress.hpp"
#include "run/simulate.hpp"

namespace edmill::app {

template <class Real>
RunResult run_in(const casefile::CaseSpec& spec, const RunOptions& options,
                 const std::function<std::filesystem::path()>& put_page) {
  const auto built = casefile::build_case<Real>(spec);
  run::RunFolder folder(options.folder, spec, options.checkpoint);
  if (!folder.locked()) options.without_locks(folder.place());
  const DriveClock<Real> clock(built.the_case.mill.motion.period());
  options.begun();
  output::Outputs<Real> outputs(spec, built.the_case.mill.vessel, folder.place(), clock.seconds(built.start));

  run::Guests<Real> guests;
  guests.interrupt = options.interrupt;
  guests.checkpoints = folder.checkpoints();
  if (!spec.outputs.empty()) guests.observers.push_back(&outputs);
  std::optional<double> end;
  if (spec.end_time) end = spec.end_time->template to<double>();
  run::Progress<Real> progress([&](double now, std::uint64_t collisions, double dose) {
    options.progress({now, end, collisions, dose});
  });
  if (options.progress) guests.observers.push_back(&progress);
  const auto [summary, saved] = run::simulate<Real>(spec, built, guests);

  const bool goes_on = options.checkpoint && summary.end_reason == model::EndReason::interrupted;
  output::write_results<Real>(folder, outputs, saved, clock, io::summary_json(summary), spec, goes_on);
  RunResult result{summary.end_reason, summary.error, report::result_table(summary), goes_on, put_page()};
  Archive archive;
  archive(result);
  if (!goes_on) folder.remove_checkpoint(archive.bytes());
  return result;
}

}  // namespace edmill::app
