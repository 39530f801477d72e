// Implementation of simulate; included by the instantiation files only.
#pragma once

#include "base/errors.hpp"
#include "base/version.hpp"
#include "run/course_impl.hpp"

namespace edmill::run {

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
    case engine::EndReason::paused:
      break;  // the run continues
  }
  return "?";
}

template <class Real>
void note_totals(const engine::Simulation<Real>& simulation, const run::RunStatistics<Real>& statistics,
                 io::Summary<Real>& summary) {
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
  summary.touched_impacts = statistics.touched();
  summary.touched_dose = statistics.touched_dose();
  summary.supplied_energy = statistics.supplied_energy();
  summary.collapse = simulation.collapse();
  summary.simultaneous_contacts = simulation.counts().simultaneous_contacts;
  summary.deepest_overlap = simulation.counts().deepest_overlap;
  summary.total_impacts = simulation.counts().impacts;
  summary.escalations = simulation.escalations();
}

template <class Real>
Result<Real> simulate(const casefile::CaseSpec& spec, const casefile::InitialCase<Real>& built,
                      const Guests<Real>& guests) {
  std::optional<Course<Real>> course;
  Result<Real> result;
  auto& summary = result.summary;
  try {
    course.emplace(built, guests);
    summary.end_reason = end_reason_name(course->go());
  } catch (const UndecidedError& error) {
    summary.end_reason = "undecided";
    summary.error = error.what();
  }
  if (course) {
    const auto& simulation = course->simulation();
    for (auto* observer : guests.observers) observer->on_end(simulation);
    summary.cpu_seconds = course->cpu_spent();
    summary.start_time = course->counted_from();
    summary.energy_at_start = course->energy_at_start();
    note_totals(simulation, course->statistics(), summary);
    result.saved.time = simulation.now();
    for (int k = 0; k < simulation.ball_count(); ++k)
      result.saved.states.push_back(simulation.state_at(k, simulation.now()));
  } else {
    // Not even the first contacts of the balls could be decided.
    summary.period = built.the_case.mill.motion.period;
    summary.start_time = summary.end_time = DriveClock<Real>(summary.period).seconds(built.start);
    summary.energy_at_start = summary.energy_at_end =
        model::energy_of(built.the_case.balls, built.states, built.the_case.mill.gravity);
    result.saved = {built.start, built.states};
  }
  if (spec.powder_mass) summary.powder_mass = spec.powder_mass->template to<Real>();
  Real ball_mass{0};
  for (const auto& ball : built.the_case.balls) ball_mass += ball.mass;
  summary.ball_mass = ball_mass;
  summary.provenance = {spec.file,  spec.digest, std::string(ScalarName<Real>::value), version(), commit(),
                        compiler(), spec.seed};
  return result;
}

}  // namespace edmill::run
