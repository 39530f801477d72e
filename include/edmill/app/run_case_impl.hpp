// Implementation of run_case; included by the instantiation files only.
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <memory>

#include "edmill/app/run_case.hpp"
#include "edmill/driver/simulate.hpp"
#include "edmill/observe/progress.hpp"
#include "edmill/outputs/output.hpp"
#include "edmill/report/result_table.hpp"

namespace edmill::app {

template <class Real>
int run_case(const casefile::CaseSpec& spec, const RunOptions& options) {
  const std::filesystem::path folder(options.folder);
  const auto built = setup::build_case<Real>(spec);
  record::prepare_folder(folder);
  const DriveClock<Real> clock(built.the_case.mill.motion.period);
  outputs::Outputs<Real> outputs(spec, folder, clock.seconds(built.start));

  driver::Guests<Real> guests;
  guests.interrupt = options.interrupt;
  if (!outputs.empty()) guests.observers.push_back(&outputs);
  std::unique_ptr<observe::Progress<Real>> progress;
  if (!options.quiet && ::isatty(STDERR_FILENO)) {
    std::optional<double> end;
    if (spec.end_time) end = spec.end_time->template to<double>();
    progress =
        std::make_unique<observe::Progress<Real>>(static_cast<double>(clock.seconds(built.start)), end);
    guests.observers.push_back(progress.get());
  }
  const auto [summary, saved] = driver::simulate<Real>(spec, built, guests);
  progress.reset();

  outputs.commit();
  record::AtomicFile state_file(folder / "final_state.csv");
  record::write_final_state<Real>(state_file.stream(), saved, clock);
  state_file.commit();
  record::AtomicFile summary_file(folder / "summary.json");
  summary_file.stream() << record::summary_json(summary);
  summary_file.commit();

  if (!options.quiet) fmt::print("{}\nResults are in {}\n", report::result_table(summary), folder.string());
  if (!summary.error.empty()) {
    fmt::print(stderr, "edmill: {}\n", summary.error);
    return undecided;
  }
  return summary.end_reason == "inelastic_collapse" ? inelastic_collapse : ok;
}

}  // namespace edmill::app
