// Implementation of run_case; included by the instantiation files only.
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <ctime>
#include <memory>

#include "edmill/app/run_case.hpp"
#include "edmill/app/version.hpp"
#include "edmill/core/errors.hpp"
#include "edmill/observe/collision_log.hpp"
#include "edmill/observe/progress.hpp"
#include "edmill/observe/run_statistics.hpp"
#include "edmill/observe/stop_rules.hpp"
#include "edmill/record/final_state.hpp"
#include "edmill/record/summary.hpp"
#include "edmill/report/result_table.hpp"
#include "edmill/setup/build_case.hpp"

namespace edmill::app {

inline std::string end_reason_name(engine::EndReason reason) {
  switch (reason) {
    case engine::EndReason::end_time:
      return "end_time";
    case engine::EndReason::max_collisions:
      return "max_collisions";
    case engine::EndReason::max_milling_dose:
      return "max_milling_dose";
    case engine::EndReason::max_ball_speed:
      return "max_ball_speed";
    case engine::EndReason::inelastic_collapse:
      return "inelastic_collapse";
    case engine::EndReason::interrupted:
      return "interrupted";
  }
  return "?";
}

inline double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

template <class Real>
int run_case(const casefile::CaseSpec& spec, const RunOptions& options) {
  const std::filesystem::path folder(options.folder);
  const auto built = setup::build_case<Real>(spec);
  record::prepare_folder(folder);
  std::vector<std::unique_ptr<observe::CollisionLog<Real>>> logs;
  const auto time = [](const std::optional<casefile::Quantity>& q) {
    return q ? std::optional<Real>(q->template to<Real>()) : std::nullopt;
  };
  for (const auto& output : spec.outputs)
    logs.push_back(std::make_unique<observe::CollisionLog<Real>>(
        folder / output.file, time(output.start_time), time(output.end_time)));

  const double cpu_start = cpu_seconds();
  engine::Simulation<Real> simulation(built.the_case, built.states, built.start);
  const auto& clock = simulation.clock();
  observe::StopRuleWatch<Real> stop_rules(built.the_case.stop);
  observe::RunStatistics<Real> statistics;
  simulation.attach(stop_rules);
  for (auto& log : logs) simulation.attach(*log);
  std::unique_ptr<observe::Progress<Real>> progress;
  if (!options.quiet && ::isatty(STDERR_FILENO)) {
    std::optional<double> end;
    if (spec.end_time) end = spec.end_time->to<double>();
    progress = std::make_unique<observe::Progress<Real>>(static_cast<double>(simulation.seconds()), end);
    simulation.attach(*progress);
  }

  record::Summary<Real> summary;
  const auto end = spec.end_time ? clock.at(*built.the_case.stop.end_time) : Instant<Real>::never();
  auto statistics_start = clock.at(built.the_case.statistics_start);
  if (statistics_start < built.start) statistics_start = built.start;
  EDMILL_REQUIRE(statistics_start <= end || !spec.end_time, "statistics start before the end");
  try {
    auto reason = statistics_start > built.start ? simulation.run_until(statistics_start, options.interrupt)
                                                 : engine::EndReason::end_time;
    if (reason == engine::EndReason::end_time) {
      summary.start_time = clock.seconds(statistics_start);
      summary.energy_at_start = simulation.energy_at(statistics_start);
      simulation.attach(statistics);
      reason = simulation.run_until(end, options.interrupt);
    } else {
      summary.start_time = simulation.seconds();
      summary.energy_at_start = simulation.energy_at(simulation.now());
    }
    summary.end_reason = end_reason_name(reason);
  } catch (const UndecidedError& error) {
    summary.end_reason = "undecided";
    summary.error = error.what();
  }
  progress.reset();

  summary.cpu_seconds = cpu_seconds() - cpu_start;
  summary.end_time = simulation.seconds();
  summary.period = clock.period();
  summary.energy_at_end = simulation.energy_at(simulation.now());
  for (int k = 0; k < model::partner_kinds; ++k) {
    const auto& totals = statistics.by_partner()[k];
    summary.collisions[k] = totals.collisions;
    summary.dose_by_partner[k] = totals.milling_dose.value();
  }
  summary.milling_dose = statistics.milling_dose();
  summary.wall_work = statistics.wall_work();
  summary.collapse_impacts = statistics.collapsing();
  summary.collapse_dose = statistics.collapsing_dose();
  summary.collapse = simulation.collapse();
  summary.simultaneous_contacts = simulation.counts().simultaneous_contacts;
  summary.deepest_overlap = simulation.counts().deepest_overlap;
  summary.total_impacts = simulation.counts().impacts;
  summary.escalations = simulation.escalations();
  summary.powder_mass = time(spec.powder_mass);
  Real ball_mass{0};
  for (const auto& ball : built.the_case.balls) ball_mass += ball.mass;
  summary.ball_mass = ball_mass;
  summary.provenance = {spec.file,  spec.digest, std::string(ScalarName<Real>::value), version(), commit(),
                        compiler(), spec.seed};

  record::SavedState<Real> saved{simulation.now(), {}};
  for (int k = 0; k < simulation.ball_count(); ++k)
    saved.states.push_back(simulation.state_at(k, simulation.now()));
  for (auto& log : logs) log->commit();
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
