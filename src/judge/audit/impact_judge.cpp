#include "audit/impact_judge.hpp"

#include <algorithm>
#include <cmath>

namespace edmill::audit {

/// The equations themselves: momentum, torque, and the separation of the contact points.
/// @param parting  the bodies do not approach, which is reported: a code may then reflect g_n as usual
auto ImpactJudge::residuals(const LoggedImpact& impact, const Known& known, bool parting) const
    -> LawResiduals {
  LawResiduals off;
  const auto& body = impact.event->body;
  const Vec g = impact.before(), g_after = impact.after();
  const double g_n = impact.along(g), g_n_after = impact.along(g_after);
  const Vec slip = impact.across(g), slip_after = impact.across(g_after);
  std::array<Vec, 2> impulse;  // on each ball
  for (std::size_t k = 0; k < impact.count(); ++k)
    impulse[k] = (body[k].velocity_after - body[k].velocity_before) * impact.ball[k].mass;
  if (!impact.with_wall()) off.momentum = size(Vec(impulse[0] + impulse[1])) / impact.effective_mass;
  if (known.spins)
    for (std::size_t k = 0; k < impact.count(); ++k) {
      const auto& ball = impact.ball[k];
      const Vec arm = impact.normal * (k == 0 ? -ball.radius : ball.radius);
      const Vec change = body[k].spin_after - body[k].spin_before;
      const Vec missing = change * (ball.mass * ball.reduced_inertia * ball.radius * ball.radius) -
                          cross<double>(arm, impulse[k]);
      off.spin = std::max(off.spin, size(missing) / (ball.mass * ball.radius));
    }
  const double bounce = std::max(0.0, impact.along(impulse[0])) / impact.effective_mass;
  off.normal = std::abs(g_n_after - impact.separation_speed(g_n));
  if (parting) off.normal = std::min(off.normal, std::abs(g_n_after - impact.by_restitution(g_n)));
  off.restitution_tangential = impact.tangential_restitution(impact.compliance, bounce, size(slip));
  if (known.spins) off.tangential = size(Vec(slip_after - slip * off.restitution_tangential));
  return off;
}

void ImpactJudge::judge_outcome(const LoggedImpact& impact, const Known& known, double allowed) {
  const LoggedEvent& event = *impact.event;
  const double g_n = impact.g_n();
  const auto off = residuals(impact, known, g_n > allowed);
  const auto check = [&](Check check, Kind kind, double size, double found, double expected) {
    judge(check, kind, event, size, allowed, found, expected);
  };
  check(Check::normal_law, Kind::normal_restitution, off.normal,
        g_n != 0 ? -impact.g_n_after() / g_n : unknown,
        g_n != 0 ? -impact.separation_speed(g_n) / g_n : unknown);
  if (!impact.with_wall()) check(Check::momentum, Kind::momentum, off.momentum, off.momentum, 0);
  if (!known.spins) return;
  check(Check::spin_change, Kind::spin_change, off.spin, off.spin, 0);
  const Vec slip = impact.across(impact.before()), slip_after = impact.across(impact.after());
  const double found = dot(slip, slip) > 0 ? dot(slip, slip_after) / dot(slip, slip) : unknown;
  // With a wrong torque the slip after the impact carries no further information.
  check(Check::tangential_law, Kind::tangential_restitution, off.spin > allowed ? 0 : off.tangential, found,
        off.restitution_tangential);
}

/// Where the log leaves open whether friction rests in an impact: whether it obeys the law only if it does.
bool ImpactJudge::fits_without_friction(const LoggedImpact& impact, const Known& known) const {
  const LoggedEvent& event = *impact.event;
  LoggedImpact rested = impact;
  rested.in_stall = true;
  double with = 0, without = 0, allowed = 0;
  if (known.velocities && known.spins) {
    const double scale = velocity_scale(impact, true);
    with = residuals(impact, known, false).largest();
    without = residuals(rested, known, false).largest();
    allowed = tolerances_.relative * scale + by_wall(impact, scale);
  } else if (available_.approach_speed && available_.slip_speed && available_.milling_dose) {
    const Speeds speeds{-event.approach_speed, event.slip_speed};
    with = std::abs(event.milling_dose - dose_by_law(impact, speeds));
    without = std::abs(event.milling_dose - dose_by_law(rested, speeds));
    allowed = allowed_dose(impact,
                           std::max({event.approach_speed, event.slip_speed, impact.law->least_separation}));
  }
  return with > allowed && without <= allowed;
}

void ImpactJudge::judge_impact(LoggedImpact impact, Friction friction) {
  const bool with_wall = impact.with_wall();
  const bool seen = available_.positions(with_wall) && available_.velocities_before(with_wall);
  const Known known{seen && available_.velocities_after(with_wall), seen && available_.spins(with_wall)};
  impact.in_stall =
      friction == Friction::rests || (friction == Friction::either && fits_without_friction(impact, known));
  if (!seen) return judge_speeds(impact);
  const double scale = velocity_scale(impact, known.spins), wall = by_wall(impact, scale);
  if (wall > 0 && wall >= scale) return leave_unresolved(known);
  const double allowed = tolerances_.relative * scale + wall, g_n = impact.g_n();
  judge(Check::approach, Kind::not_approaching, *impact.event, g_n, allowed, -g_n, 0);
  if (known.velocities) {
    const auto* coulomb = std::get_if<model::WaltonBraun<double>>(&impact.law->law);
    const double most_friction = coulomb ? std::min(coulomb->friction, 10.0) : 0;
    judge_outcome(impact, known, allowed * (1 + most_friction * impact.compliance));
  }
  judge_logged_speeds(impact, known, allowed);
  if (known.velocities && known.spins) judge_energies(impact, 4 * allowed * impact.effective_mass * scale);
}

/// Counts as unresolved the checks of an impact with a wall whose place the rounding of its time leaves open.
void ImpactJudge::leave_unresolved(const Known& known) {
  const bool all = known.velocities && known.spins;
  for (const auto& [check, is_due] : {std::pair(Check::approach, true),
                                      {Check::approach_speed, available_.approach_speed},
                                      {Check::normal_law, known.velocities},
                                      {Check::tangential_law, all},
                                      {Check::spin_change, all},
                                      {Check::slip_speed, all && available_.slip_speed},
                                      {Check::milling_dose, all && available_.milling_dose},
                                      {Check::wall_work, all && available_.wall_work}})
    if (is_due) findings_.unresolved(check);
}

void ImpactJudge::judge_logged_speeds(const LoggedImpact& impact, const Known& known, double allowed) {
  const LoggedEvent& event = *impact.event;
  const Speeds speeds = speeds_before(impact);
  if (available_.approach_speed)
    judge(Check::approach_speed, Kind::approach_speed, event, std::abs(event.approach_speed + speeds.g_n),
          allowed, event.approach_speed, -speeds.g_n);
  if (available_.slip_speed && known.spins)
    judge(Check::slip_speed, Kind::slip_speed, event, std::abs(event.slip_speed - speeds.slip), allowed,
          event.slip_speed, speeds.slip);
}

/// The dose is the wall work plus the energy that the least separation speed supplies, minus what the balls
/// have gained.
void ImpactJudge::judge_energies(const LoggedImpact& impact, double allowed) {
  const LoggedEvent& event = *impact.event;
  const double work = work_of_wall(impact), gained = kinetic_change(impact);
  const Speeds speeds = speeds_before(impact);
  const double due = supplied(impact, speeds.g_n, impact.separation_speed(speeds.g_n));
  ++energies_.impacts;
  energies_.wall_work += work;
  energies_.kinetic_change += gained;
  energies_.supplied += due;
  energies_.milling_dose += available_.milling_dose ? event.milling_dose : dose_by_law(impact, speeds);
  if (due > 0) ++energies_.supplying;
  if (const double created = gained - work - due; created > allowed) {
    ++energies_.creating;
    energies_.created += created;
  }
  if (available_.milling_dose) judge_dose(impact, allowed);
  if (available_.wall_work)
    judge(Check::wall_work, Kind::wall_work, event, std::abs(event.wall_work - work), allowed,
          event.wall_work, work);
}

/// The dose of a violating impact may also be that of the law for the same speeds, and its balance without
/// what v_s supplies in the log: then the law is wrong and not the dose.
void ImpactJudge::judge_dose(const LoggedImpact& impact, double allowed) {
  const LoggedEvent& event = *impact.event;
  const Speeds speeds = speeds_before(impact);
  const double balance = work_of_wall(impact) - kinetic_change(impact);
  const double expected = balance + supplied(impact, speeds.g_n, impact.g_n_after());
  const auto away = [&](double dose) { return std::abs(event.milling_dose - dose); };
  double off = std::min(away(expected), away(dose_by_law(impact, speeds)));
  if (supplied(impact, speeds.g_n, impact.separation_speed(speeds.g_n)) == 0)
    off = std::min(off, away(balance));
  judge(Check::milling_dose, Kind::milling_dose, event, off, allowed, event.milling_dose, expected);
}

/// Judges the dose by the logged speeds, where the log or this impact has no states.
void ImpactJudge::judge_speeds(const LoggedImpact& impact) {
  const LoggedEvent& event = *impact.event;
  if (available_.approach_speed) {
    const double scale = available_.slip_speed ? std::max(std::abs(event.approach_speed), event.slip_speed)
                                               : std::abs(event.approach_speed);
    judge(Check::approach, Kind::not_approaching, event, -event.approach_speed,
          tolerances_.relative * std::max(scale, 1.0), event.approach_speed, 0);
    if (available_.slip_speed && available_.milling_dose) {
      const double expected = dose_by_law(impact, {-event.approach_speed, event.slip_speed});
      judge(Check::milling_dose, Kind::milling_dose, event, std::abs(event.milling_dose - expected),
            allowed_dose(impact, std::max(scale, impact.law->least_separation)), event.milling_dose,
            expected);
    }
  }
  if (available_.wall_work && !event.with_wall)
    judge(Check::wall_work, Kind::wall_work, event, std::abs(event.wall_work), 0, event.wall_work, 0);
}

}  // namespace edmill::audit
