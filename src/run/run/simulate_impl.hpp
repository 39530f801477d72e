// Implementation of simulate; included by the instantiation files only.
#pragma once

#include "base/errors.hpp"
#include "base/version.hpp"
#include "run/run_driver_impl.hpp"
#include "run/warnings.hpp"

namespace edmill::run {

template <class Real>
void note_totals(const engine::Simulation<Real>& simulation, const run::RunStatistics<Real>& statistics,
                 io::Summary<Real>& summary) {
  summary.end_time = simulation.seconds();
  summary.period = simulation.clock().period();
  summary.energy_at_end = simulation.energy_at(simulation.now());
  for (int k = 0; k < summary.partners.count(); ++k) {
    const auto& totals = statistics.by_partner()[k];
    summary.collisions[k] = totals.collisions;
    summary.dose_by_partner[k] = totals.milling_dose.value();
  }
  summary.milling_dose = statistics.milling_dose();
  summary.wall_work = statistics.wall_work();
  summary.touched_impacts = statistics.touched();
  summary.touched_dose = statistics.touched_dose();
  summary.supplied_energy = statistics.supplied_energy();
  summary.stall_impacts = statistics.in_stall();
  summary.stall_dose = statistics.stall_dose();
  summary.collapse = simulation.collapse();
  summary.stall = simulation.stall();
  summary.simultaneous_contacts = simulation.counts().simultaneous_contacts;
  summary.deepest_overlap = simulation.counts().deepest_overlap;
  summary.total_impacts = simulation.counts().impacts;
  summary.escalations = simulation.escalations();
  const auto &first = summary.energy_at_start, &last = summary.energy_at_end;
  summary.energy_closure = summary.wall_work - summary.milling_dose + summary.supplied_energy -
                           ((last.kinetic + last.potential) - (first.kinetic + first.potential));
}

/// Summary of a case, with nothing counted yet.
template <class Real>
io::Summary<Real> blank_summary(const casefile::CaseSpec& spec, const casefile::InitialCase<Real>& built) {
  io::Summary<Real> summary(model::partners_of(built.the_case.mill.vessel));
  if (spec.powder_mass) summary.powder_mass = spec.powder_mass->template to<Real>();
  if (spec.target.dose)
    summary.target = {spec.target.dose->template to<Real>(), spec.target.counts(), Real(0)};
  if (const auto& wanted = built.the_case.stop.limits[model::place_of_rule<model::DoseRatePrecision>])
    summary.wanted_precision = static_cast<double>(*wanted);
  Real ball_mass{0};
  for (const auto& ball : built.the_case.balls) ball_mass += ball.mass;
  summary.ball_mass = ball_mass;
  summary.provenance = {spec.file, spec.digest, spec.settings, spec.reported, scalar_name<Real>(),
                        version(), commit(),    compiler(),    spec.seed,     spec.right_digits};
  return summary;
}

/// Summary of what has been simulated so far.
template <class Real>
io::Summary<Real> summary_of(const casefile::CaseSpec& spec, const casefile::InitialCase<Real>& built,
                             const RunDriver<Real>& driver) {
  auto summary = blank_summary(spec, built);
  const auto& simulation = driver.simulation();
  summary.cpu_seconds = driver.cpu_spent();
  summary.start_time = driver.counted_from();
  summary.energy_at_start = driver.energy_at_start();
  note_totals(simulation, driver.statistics(), summary);
  driver.every_run().note(summary);
  // An instant is whole periods and a rest, whose sum is rounded: where the case names the time, it is that.
  const auto name = [&](Real& seconds, const Instant<Real>& when, const casefile::Quantity& given) {
    if (seconds == simulation.clock().seconds(when)) seconds = given.template to<Real>();
  };
  name(summary.start_time, built.the_case.statistics_start, spec.statistics_start);
  if (spec.end_time) name(summary.end_time, *built.the_case.stop.end_time, *spec.end_time);
  if (summary.duration() > 0) {
    summary.intervals =
        driver.statistics().intervals(simulation.now(), simulation.clock().period(), summary.duration());
    if (summary.target)
      summary.target->counted_dose_rate = driver.statistics().counted_dose() / summary.duration();
  }
  return summary;
}

/// Summary of a run whose balls' first contacts could not be decided.
template <class Real>
io::Summary<Real> empty_summary(const casefile::CaseSpec& spec, const casefile::InitialCase<Real>& built) {
  auto summary = blank_summary(spec, built);
  summary.period = built.the_case.mill.motion.period();
  summary.start_time = summary.end_time = DriveClock<Real>(summary.period).seconds(built.start);
  summary.energy_at_start = summary.energy_at_end =
      model::energy_of(built.the_case.balls, built.states, built.the_case.mill.gravity);
  return summary;
}

/// Adds what follows from the numbers.
template <class Real>
void finish_summary(io::Summary<Real>& summary, model::EndReason end_reason, const std::string& error) {
  summary.end_reason = end_reason;
  summary.warnings = warnings_of(measures_of(summary));
  summary.error = summary.stall ? io::stall_message(summary) : error;
}

template <class Real>
Result<Real> simulate(const casefile::CaseSpec& spec, const casefile::InitialCase<Real>& built,
                      const Guests<Real>& guests) {
  std::optional<RunDriver<Real>> driver;
  auto end_reason = model::EndReason::undecided;
  std::string error;
  try {
    driver.emplace(built, guests);
    end_reason = driver->go();
  } catch (const UndecidedError& undecided) {
    error = undecided.what();
  }
  Result<Real> result;
  if (driver) {
    const auto& simulation = driver->simulation();
    for (auto* observer : guests.observers) observer->on_end(simulation);
    result.summary = summary_of(spec, built, *driver);
    result.saved.time = simulation.now();
    for (int k = 0; k < simulation.ball_count(); ++k)
      result.saved.states.push_back(simulation.state_at(k, simulation.now()));
  } else {
    result.summary = empty_summary(spec, built);
    result.saved = {built.start, built.states};
  }
  finish_summary(result.summary, end_reason, error);
  return result;
}

}  // namespace edmill::run
