// Implementation of simulate; included by the instantiation files only.
#pragma once

#include <ctime>

#include "edmill/core/errors.hpp"
#include "edmill/core/version.hpp"
#include "edmill/driver/simulate.hpp"
#include "edmill/observe/run_statistics.hpp"
#include "edmill/observe/stop_rules.hpp"

namespace edmill::driver {

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

/// Of this thread: several runs can share a process.
inline double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Runs up to the start of statistics, then with them to the end.
template <class Real>
void run_both_parts(const setup::InitialCase<Real>& built, const std::atomic<bool>* interrupt,
                    engine::Simulation<Real>& simulation, observe::RunStatistics<Real>& statistics,
                    record::Summary<Real>& summary) {
  const auto& clock = simulation.clock();
  const auto& end_time = built.the_case.stop.end_time;
  const auto end = end_time ? clock.at(*end_time) : Instant<Real>::never();
  auto start = clock.at(built.the_case.statistics_start);
  if (start < built.start) start = built.start;
  EDMILL_REQUIRE(start <= end || !end_time, "statistics start before the end");
  try {
    auto reason = start > built.start ? simulation.run_until(start, interrupt) : engine::EndReason::end_time;
    if (reason == engine::EndReason::end_time) {
      summary.start_time = clock.seconds(start);
      summary.energy_at_start = simulation.energy_at(start);
      simulation.attach(statistics);
      reason = simulation.run_until(end, interrupt);
    } else {
      summary.start_time = simulation.seconds();
      summary.energy_at_start = simulation.energy_at(simulation.now());
    }
    summary.end_reason = end_reason_name(reason);
  } catch (const UndecidedError& error) {
    summary.end_reason = "undecided";
    summary.error = error.what();
  }
}

template <class Real>
void note_totals(const engine::Simulation<Real>& simulation, const observe::RunStatistics<Real>& statistics,
                 record::Summary<Real>& summary) {
  summary.end_time = simulation.seconds();
  summary.period = simulation.clock().period();
  summary.energy_at_end = simulation.energy_at(simulation.now());
  for (int k = 0; k < model::partner_kinds; ++k) {
    const auto& totals = statistics.by_partner()[k];
    summary.collisions[k] = totals.collisions;
    summary.dose_by_partner[k] = totals.milling_dose.value();
  }
  summary.milling_dose = statistics.milling_dose();
  summary.wall_work = statistics.wall_work();
  summary.collapse_impacts = statistics.collapsing();
  summary.resting_impacts = statistics.resting();
  summary.collapse_dose = statistics.collapsing_dose();
  summary.collapse = simulation.collapse();
  summary.simultaneous_contacts = simulation.counts().simultaneous_contacts;
  summary.deepest_overlap = simulation.counts().deepest_overlap;
  summary.total_impacts = simulation.counts().impacts;
  summary.escalations = simulation.escalations();
}

template <class Real>
Result<Real> simulate(const casefile::CaseSpec& spec, const setup::InitialCase<Real>& built,
                      const Guests<Real>& guests) {
  const double cpu_start = cpu_seconds();
  engine::Simulation<Real> simulation(built.the_case, built.states, built.start);
  observe::StopRuleWatch<Real> stop_rules(built.the_case.stop);
  observe::RunStatistics<Real> statistics;
  simulation.attach(stop_rules);
  for (auto* observer : guests.observers) simulation.attach(*observer);

  Result<Real> result;
  auto& summary = result.summary;
  run_both_parts(built, guests.interrupt, simulation, statistics, summary);
  for (auto* observer : guests.observers) observer->on_end(simulation);
  summary.cpu_seconds = cpu_seconds() - cpu_start;
  note_totals(simulation, statistics, summary);
  if (spec.powder_mass) summary.powder_mass = spec.powder_mass->template to<Real>();
  Real ball_mass{0};
  for (const auto& ball : built.the_case.balls) ball_mass += ball.mass;
  summary.ball_mass = ball_mass;
  summary.provenance = {spec.file,  spec.digest, std::string(ScalarName<Real>::value), version(), commit(),
                        compiler(), spec.seed};
  result.saved.time = simulation.now();
  for (int k = 0; k < simulation.ball_count(); ++k)
    result.saved.states.push_back(simulation.state_at(k, simulation.now()));
  return result;
}

}  // namespace edmill::driver
