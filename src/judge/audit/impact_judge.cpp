#include "audit/impact_judge.hpp"

#include <algorithm>
#include <cmath>

namespace edmill::audit {

/// The equations themselves: momentum, torque, and the separation of the contact points.
/// @param parting  the bodies do not approach, which is reported: a code may then reflect g_n as usual
auto ImpactJudge::residuals(const LoggedImpact& impact, const Known& known, bool parting) const -> Residuals {
  Residuals off;
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

/// Names the violation by the equation that does not hold, or by the wall's velocity that the logged speeds
/// imply. @return whether by the latter
bool ImpactJudge::tell_broken_equations(const LoggedImpact& impact, const Residuals& off, double allowed,
                                        Findings& plain) {
  const bool spin = off.spin > allowed;
  const LoggedEvent& event = *impact.event;
  if (off.momentum > allowed) plain.add({event, Kind::momentum, off.momentum, off.momentum, 0});
  if (spin) plain.add({event, Kind::spin_change, off.spin, off.spin, 0});
  if (!spin)
    if (const auto wall = other_wall_speed(impact, off, allowed)) {
      plain.add({event, Kind::wall_velocity, std::max(off.normal, off.tangential), *wall,
                 impact.along(impact.wall_velocity)});
      return true;
    }
  if (off.normal > allowed) tell_normal(impact, off.normal, allowed, plain);
  // With a wrong torque the slip after the impact carries no further information.
  if (off.tangential > allowed && !spin) {
    const Vec slip = impact.across(impact.before()), slip_after = impact.across(impact.after());
    const double found = dot(slip, slip) > 0 ? dot(slip, slip_after) / dot(slip, slip) : unknown;
    plain.add({event, Kind::tangential_restitution, off.tangential, found, off.restitution_tangential});
  }
  return false;
}

/// @param theirs  becomes the impact as the log's code saw it
/// @return whether another velocity of the wall is told
bool ImpactJudge::judge_outcome(const Scene& scene, const Known& known, const Allowed& allowed,
                                LoggedImpact& theirs) {
  const LoggedImpact& impact = scene.impact;
  findings_.judged(Check::normal_law);
  if (!impact.with_wall()) findings_.judged(Check::momentum);
  if (known.spins) {
    findings_.judged(Check::tangential_law);
    findings_.judged(Check::spin_change);
  }
  const double g_n = impact.g_n();
  const auto off = residuals(impact, known, g_n > allowed.speed);
  const bool violated = off.largest() > allowed.slack;
  if (!violated) see_separation(impact, allowed.slack);
  // The bodies separate at e_n |g_n| where v_s applies, or the reverse: this comes first, since a vanishing
  // impulse also results from a wall from which the ball moves away.
  const double by_restitution = impact.by_restitution(g_n), least = impact.law->least_separation;
  const double other = impact.separation_speed(g_n) > by_restitution ? by_restitution : least;
  const bool separation_alone =
      violated && std::max({off.tangential, off.momentum, off.spin}) <= allowed.slack && least > 0 &&
      vanishes(off.normal, std::abs(impact.g_n_after() - other), allowed.slack);
  const auto found = known.spins && !separation_alone ? explaining(scene, allowed.slack, violated)
                                                      : std::optional<Explanation>{};
  if (!violated) return false;
  if (!found) return tell_broken_equations(impact, off, allowed.slack, findings_);
  tell_broken_equations(impact, off, allowed.slack, found->mistake->plain());
  found->mistake->explains(found->off, found->left)
      .add({*impact.event, found->kind, off.largest(), off.largest(), 0, found->note, true});
  theirs = found->impact;
  return found->kind == Kind::wall_velocity;
}

/// Where the log does not tell whether friction rests in an impact: whether it obeys the law only if it does.
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

void ImpactJudge::judge(Scene scene) {
  const bool with_wall = scene.impact.with_wall();
  const bool seen = available_.positions(with_wall) && available_.velocities_before(with_wall);
  const Known known{seen && available_.velocities_after(with_wall), seen && available_.spins(with_wall)};
  scene.impact.in_stall = scene.friction == Friction::rests ||
                          (scene.friction == Friction::either && fits_without_friction(scene.impact, known));
  if (!seen) return judge_speeds(scene.impact);
  if (scene.displaced && known.velocities) {
    // The printed matrix is used either with its own derivative or with the printed velocity.
    LoggedImpact other = scene.impact;
    other.set_wall_velocity(wall_velocities.back(), scene.nested, scene.printed);
    if (residuals(other, known, false).largest() < residuals(scene.impact, known, false).largest())
      scene.impact = other;
  }
  const LoggedImpact& impact = scene.impact;
  const double scale = velocity_scale(impact, known.spins), wall = by_wall(impact, scale);
  if (wall > 0 && wall >= scale) return leave_unresolved(known);
  Allowed allowed{tolerances_.relative * scale + wall, 0, 0};
  const auto* coulomb = std::get_if<model::WaltonBraun<double>>(&impact.law->law);
  const double friction = coulomb ? std::min(coulomb->friction, 10.0) : 0;
  allowed.slack = allowed.speed * (1 + friction * impact.compliance);
  allowed.energy = 4 * allowed.speed * impact.effective_mass * scale;
  const double g_n = impact.g_n();
  findings_.judged(Check::approach);
  if (g_n > allowed.speed) tell(Kind::not_approaching, *impact.event, g_n, -g_n, 0);
  LoggedImpact theirs = impact;
  const bool wall_velocity_told = known.velocities && judge_outcome(scene, known, allowed, theirs);
  judge_logged_speeds(theirs, known, allowed.speed, wall_velocity_told);
  if (known.velocities && known.spins) judge_energies(impact, theirs, allowed.energy);
}

/// Counts as unresolved the checks of an impact with a wall whose place the rounding of its time leaves open.
void ImpactJudge::leave_unresolved(const Known& known) {
  findings_.unresolved(Check::approach);
  if (available_.approach_speed) findings_.unresolved(Check::approach_speed);
  if (!known.velocities) return;
  findings_.unresolved(Check::normal_law);
  if (!known.spins) return;
  for (const Check check : {Check::tangential_law, Check::spin_change}) findings_.unresolved(check);
  if (available_.slip_speed) findings_.unresolved(Check::slip_speed);
  if (available_.milling_dose) findings_.unresolved(Check::milling_dose);
  if (available_.wall_work) findings_.unresolved(Check::wall_work);
}

void ImpactJudge::judge_logged_speeds(const LoggedImpact& impact, const Known& known, double allowed_off,
                                      bool wall_velocity_told) {
  const LoggedEvent& event = *impact.event;
  const Speeds speeds = speeds_before(impact);
  const auto compare = [&](Check check, Kind kind, double logged, double expected) {
    findings_.judged(check);
    const double off = std::abs(logged - expected);
    if (off > allowed_off && !wall_velocity_told) tell(kind, event, off, logged, expected);
  };
  if (available_.approach_speed)
    compare(Check::approach_speed, Kind::approach_speed, event.approach_speed, -speeds.g_n);
  if (available_.slip_speed && known.spins)
    compare(Check::slip_speed, Kind::slip_speed, event.slip_speed, speeds.slip);
}

/// The dose is the wall work plus the energy that the least separation speed supplies, minus what the balls
/// have gained.
void ImpactJudge::judge_energies(const LoggedImpact& right, const LoggedImpact& theirs, double allowed_off) {
  const LoggedEvent& event = *right.event;
  const double work = work_of_wall(right), gained = kinetic_change(right);
  const Speeds speeds = speeds_before(right);
  const double due = supplied(right, speeds.g_n, right.separation_speed(speeds.g_n));
  ++energies_.impacts;
  energies_.wall_work += work;
  energies_.kinetic_change += gained;
  energies_.supplied += due;
  energies_.milling_dose += available_.milling_dose ? event.milling_dose : dose_by_law(right, speeds);
  if (due > 0) ++energies_.supplying;
  if (const double created = gained - work - due; created > allowed_off) {
    ++energies_.creating;
    energies_.created += created;
  }
  if (available_.milling_dose) judge_dose(right, theirs, allowed_off);
  if (available_.wall_work) {
    findings_.judged(Check::wall_work);
    const double off =
        std::min(std::abs(event.wall_work - work), std::abs(event.wall_work - work_of_wall(theirs)));
    if (off > allowed_off) tell(Kind::wall_work, event, off, event.wall_work, work);
  }
}

/// The dose of a violating impact may also be that of the law for the same speeds, and its balance without
/// what v_s supplies in the log: then the law is wrong and not the dose.
void ImpactJudge::judge_dose(const LoggedImpact& right, const LoggedImpact& theirs, double allowed_off) {
  const LoggedEvent& event = *right.event;
  findings_.judged(Check::milling_dose);
  const auto balance = [](const LoggedImpact& impact) {
    return work_of_wall(impact) - kinetic_change(impact);
  };
  const auto supplied_in_log = [](const LoggedImpact& impact) {
    return supplied(impact, impact.g_n(), impact.g_n_after());
  };
  const auto away = [&](double dose) { return std::abs(event.milling_dose - dose); };
  const Speeds speeds = speeds_before(theirs);
  const double expected = balance(right) + supplied_in_log(right);
  double off = std::min(
      {away(expected), away(balance(theirs) + supplied_in_log(theirs)), away(dose_by_law(theirs, speeds))});
  const bool none_is_due = supplied(right, speeds.g_n, right.separation_speed(speeds.g_n)) == 0;
  if (none_is_due) off = std::min({off, away(balance(right)), away(balance(theirs))});
  tell_dose(event, off, expected, allowed_off, away(balance(right)), std::abs(expected - balance(right)),
            net_dose_, "the energy that v_s supplies is subtracted");
}

/// A wrong dose.
/// @param left, changes  how far off it is with a mistake, and what the mistake changes [J]
void ImpactJudge::tell_dose(const LoggedEvent& event, double off, double expected, double allowed,
                            double left, double changes, Suspicion& mistake, const char* note) {
  const auto found = [&](const char* name, bool explained) {
    return Finding{event, Kind::milling_dose, off, event.milling_dose, expected, name, explained};
  };
  if (off > allowed && vanishes(off, left, allowed)) {
    mistake.explains(off, left).add(found(note, true));
    mistake.plain().add(found("", false));
    return;
  }
  if (mistake.is_suspected() && changes > allowed) mistake.contradicted();
  if (off > allowed) findings_.add(found("", false));
}

/// Judges the dose by the logged speeds, where the log or this impact has no states.
void ImpactJudge::judge_speeds(const LoggedImpact& impact) {
  const LoggedEvent& event = *impact.event;
  if (available_.approach_speed) {
    findings_.judged(Check::approach);
    const double scale = available_.slip_speed ? std::max(std::abs(event.approach_speed), event.slip_speed)
                                               : std::abs(event.approach_speed);
    if (event.approach_speed < -tolerances_.relative * std::max(scale, 1.0))
      tell(Kind::not_approaching, event, -event.approach_speed, event.approach_speed, 0);
    if (available_.slip_speed && available_.milling_dose) {
      findings_.judged(Check::milling_dose);
      const Speeds speeds{-event.approach_speed, event.slip_speed};
      const double expected = dose_by_law(impact, speeds);
      auto law_without = *impact.law;
      law_without.least_separation = 0;
      LoggedImpact without = impact;
      without.law = &law_without;
      const double other = dose_by_law(without, speeds);
      tell_dose(event, std::abs(event.milling_dose - expected), expected,
                allowed_dose(impact, std::max(scale, impact.law->least_separation)),
                std::abs(event.milling_dose - other), std::abs(expected - other), dose_without_rule_,
                "the dose of the law without a least separation speed");
    }
  }
  if (available_.wall_work && !event.with_wall) {
    findings_.judged(Check::wall_work);
    if (event.wall_work != 0) tell(Kind::wall_work, event, std::abs(event.wall_work), event.wall_work, 0);
  }
}

}  // namespace edmill::audit
