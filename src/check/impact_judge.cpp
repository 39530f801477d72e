#include "check/impact_judge.hpp"

#include <algorithm>
#include <cmath>

namespace edmill::audit {

double ImpactJudge::Residuals::largest() const { return std::max({normal, tangential, momentum, spin}); }

void ImpactJudge::tell(Kind kind, const LoggedEvent& event, double size, double found, double expected,
                       const char* note) {
  findings_.add({kind, size, event.line, event.time, event.ball, event.with_wall, event.partner, found,
                 expected, note});
}

/// The equations themselves: momentum, torque, and the separation of the contact points.
/// @param parting  the bodies do not approach, which is reported: a code may then reflect g_n as usual
auto ImpactJudge::residuals(const LoggedEvent& event, const LoggedImpact& impact, const Known& known,
                            bool parting) const -> Residuals {
  Residuals off;
  const Vec g = impact.before(event), g_after = impact.after(event);
  const double g_n = dot(g, impact.normal), g_n_after = dot(g_after, impact.normal);
  const Vec slip = g - impact.normal * g_n, slip_after = g_after - impact.normal * g_n_after;
  std::array<Vec, 2> impulse;  // on each ball
  for (std::size_t k = 0; k < impact.count(); ++k)
    impulse[k] = (event.body[k].velocity_after - event.body[k].velocity_before) * impact.ball[k].mass;
  if (!impact.with_wall) off.momentum = size(Vec(impulse[0] + impulse[1])) / impact.effective_mass;
  if (known.spins)
    for (std::size_t k = 0; k < impact.count(); ++k) {
      const auto& ball = impact.ball[k];
      const Vec arm = impact.normal * (k == 0 ? -ball.radius : ball.radius);
      const Vec change = event.body[k].spin_after - event.body[k].spin_before;
      const Vec missing = change * (ball.mass * ball.reduced_inertia * ball.radius * ball.radius) -
                          cross<double>(arm, impulse[k]);
      off.spin = std::max(off.spin, size(missing) / (ball.mass * ball.radius));
    }
  const double bounce = std::max(0.0, dot(impulse[0], impact.normal)) / impact.effective_mass;
  off.normal = std::abs(g_n_after - separation_speed(law(impact), impact, g_n));
  if (parting)
    off.normal =
        std::min(off.normal, std::abs(g_n_after + law(impact).restitution(-g_n, impact.bodies()) * g_n));
  off.restitution_tangential = tangential_restitution(law(impact), impact.compliance, bounce, size(slip));
  if (known.spins) off.tangential = size(Vec(slip_after - slip * off.restitution_tangential));
  return off;
}

/// Names the violation by the equation that does not hold.
void ImpactJudge::tell_broken_equations(const LoggedEvent& event, const Scene& scene, const Residuals& off,
                                        const Known& known, double allowed_off) {
  const LoggedImpact& impact = scene.impact;
  const Vec g = impact.before(event), g_after = impact.after(event);
  const double g_n = dot(g, impact.normal), g_n_after = dot(g_after, impact.normal);
  const bool normal = off.normal > allowed_off, tangential = off.tangential > allowed_off;
  const bool spin = off.spin > allowed_off;
  if (off.momentum > allowed_off) tell(Kind::momentum, event, off.momentum, off.momentum, 0);
  if (spin) tell(Kind::spin_change, event, off.spin, off.spin, 0);
  if (event.with_wall && !spin &&
      ((normal && tangential) || speeds_tell_another_wall_velocity(event, scene, known, allowed_off))) {
    // The wall's speed along n with which the law would hold.
    const double v_n = dot(event.body[0].velocity_before, impact.normal);
    const double v_n_after = dot(event.body[0].velocity_after, impact.normal);
    const auto& l = law(impact);
    const double e_n = l.restitution(-dot(impact.before(event), impact.normal), impact.bodies());
    double implied = v_n + (v_n_after - v_n) / (1 + e_n);
    if (v_n_after - implied < l.least_separation) implied = v_n_after - l.least_separation;
    return tell(Kind::wall_velocity, event, std::max(off.normal, off.tangential), implied,
                dot(impact.wall_velocity, impact.normal));
  }
  if (normal) tell_normal(event, impact, off.normal, allowed_off);
  // With a wrong torque the slip after the impact carries no further information.
  if (tangential && !spin) {
    const Vec slip = g - impact.normal * g_n, slip_after = g_after - impact.normal * g_n_after;
    tell(Kind::tangential_restitution, event, off.tangential,
         dot(slip, slip) > 0 ? dot(slip, slip_after) / dot(slip, slip) : unknown, off.restitution_tangential);
  }
}

void ImpactJudge::judge(const LoggedEvent& event, Scene scene) {
  if (!available_.positions(event.with_wall) || !available_.velocities_before(event.with_wall)) {
    judge_speeds(event, scene.impact);
    return;
  }
  const Known known{available_.velocities_after(event.with_wall), available_.spins(event.with_wall)};
  if (scene.displaced && known.velocities) {
    // The printed matrix is used either with its own derivative or with the printed velocity.
    LoggedImpact other = scene.impact;
    const Vec& centre = event.body[0].position;
    other.wall_velocity = wall_velocity(WallVelocity::of_the_printed_matrix, scene.nested, scene.printed,
                                        centre - other.normal * other.ball[0].radius, centre) +
                          piston_velocity(scene.nested, other.wall, other.normal);
    if (residuals(event, other, known, false).largest() <
        residuals(event, scene.impact, known, false).largest())
      scene.impact = other;
  }
  const LoggedImpact& impact = scene.impact;
  const double scale = velocity_scale(impact, event, known.spins);
  const double allowed_off = tolerances_.relative * scale;
  const double g_n = dot(impact.before(event), impact.normal);
  findings_.judged(Check::approach);
  if (g_n > allowed_off) tell(Kind::not_approaching, event, g_n, -g_n, 0);
  LoggedImpact theirs = impact;
  bool wall_velocity_told = false;
  if (known.velocities) {
    findings_.judged(Check::normal_law);
    if (!event.with_wall) findings_.judged(Check::momentum);
    if (known.spins) findings_.judged(Check::tangential_law), findings_.judged(Check::spin_change);
    const auto off = residuals(event, impact, known, g_n > allowed_off);
    const auto* coulomb = std::get_if<model::WaltonBraun<double>>(&law(impact).law);
    const double friction = coulomb ? std::min(coulomb->friction, 10.0) : 0;
    const double slack = allowed_off * (1 + friction * impact.compliance);
    if (off.largest() > slack) {
      Explanation explanation;
      // First: a vanishing impulse also results from a wall from which the ball moves away.
      const bool separation_alone = std::max({off.tangential, off.momentum, off.spin}) <= slack &&
                                    leaves_by_the_other_branch(event, impact, slack);
      if (known.spins && !separation_alone && explain(event, scene, slack, explanation)) {
        tell(explanation.kind, event, off.largest(), off.largest(), 0, explanation.note);
        theirs = explanation.impact;
        wall_velocity_told = explanation.kind == Kind::wall_velocity;
      } else {
        const auto before = findings_.of(Kind::wall_velocity).count;
        tell_broken_equations(event, scene, off, known, slack);
        wall_velocity_told = findings_.of(Kind::wall_velocity).count > before;
      }
    }
  }
  judge_logged_speeds(event, theirs, known, scale, wall_velocity_told);
  if (known.velocities && known.spins) judge_energies(event, impact, theirs, scale);
}

void ImpactJudge::judge_logged_speeds(const LoggedEvent& event, const LoggedImpact& impact,
                                      const Known& known, double scale, bool wall_velocity_told) {
  const double allowed_off = tolerances_.relative * scale;
  const Vec g = impact.before(event);
  const double g_n = dot(g, impact.normal);
  const auto compare = [&](Check check, Kind kind, double logged, double expected) {
    findings_.judged(check);
    const double off = std::abs(logged - expected);
    if (off > allowed_off && !wall_velocity_told) tell(kind, event, off, logged, expected);
  };
  if (available_.approach_speed)
    compare(Check::approach_speed, Kind::approach_speed, event.approach_speed, -g_n);
  if (available_.slip_speed && known.spins)
    compare(Check::slip_speed, Kind::slip_speed, event.slip_speed, size(Vec(g - impact.normal * g_n)));
}

/// The dose is the wall work plus the energy that the least separation speed supplies, minus what the balls
/// have gained.
void ImpactJudge::judge_energies(const LoggedEvent& event, const LoggedImpact& right,
                                 const LoggedImpact& theirs, double scale) {
  const double allowed_off = 4 * tolerances_.relative * right.effective_mass * scale * scale;
  const double work = work_of_wall(event, right), gained = kinetic_change(event, right);
  const Speeds speeds = speeds_before(event, right);
  const double due = supplied(right, speeds.g_n, separation_speed(law(right), right, speeds.g_n));
  ++energies_.impacts;
  energies_.wall_work += work;
  energies_.kinetic_change += gained;
  energies_.supplied += due;
  energies_.milling_dose +=
      available_.milling_dose ? event.milling_dose : dose_by_law(right, law(right), speeds);
  if (due > 0) ++energies_.supplying;
  if (const double created = gained - work - due; created > allowed_off) {
    ++energies_.creating;
    energies_.created += created;
  }
  if (available_.milling_dose) judge_dose(event, right, theirs, allowed_off);
  if (available_.wall_work) {
    findings_.judged(Check::wall_work);
    const double off =
        std::min(std::abs(event.wall_work - work), std::abs(event.wall_work - work_of_wall(event, theirs)));
    if (off > allowed_off) tell(Kind::wall_work, event, off, event.wall_work, work);
  }
}

/// The dose of a violating impact may also be that of the law for the same speeds, and its balance without
/// what v_s supplies in the log: then the law is wrong and not the dose.
void ImpactJudge::judge_dose(const LoggedEvent& event, const LoggedImpact& right, const LoggedImpact& theirs,
                             double allowed_off) {
  findings_.judged(Check::milling_dose);
  const auto balance = [&](const LoggedImpact& impact) {
    return work_of_wall(event, impact) - kinetic_change(event, impact);
  };
  const auto supplied_in_log = [&](const LoggedImpact& impact) {
    return supplied(impact, speeds_before(event, impact).g_n, dot(impact.after(event), impact.normal));
  };
  const auto away = [&](double dose) { return std::abs(event.milling_dose - dose); };
  const Speeds speeds = speeds_before(event, theirs);
  const double expected = balance(right) + supplied_in_log(right);
  double off = std::min({away(expected), away(balance(theirs) + supplied_in_log(theirs)),
                         away(dose_by_law(theirs, law(theirs), speeds))});
  const bool none_is_due = supplied(right, speeds.g_n, separation_speed(law(right), right, speeds.g_n)) == 0;
  if (none_is_due) off = std::min({off, away(balance(right)), away(balance(theirs))});
  if (off > allowed_off)
    tell(Kind::milling_dose, event, off, event.milling_dose, expected,
         away(balance(right)) <= allowed_off ? "the energy that v_s supplies is subtracted" : "");
}

void ImpactJudge::judge_speeds(const LoggedEvent& event, const LoggedImpact& impact) {
  if (available_.approach_speed) {
    findings_.judged(Check::approach);
    const double scale = available_.slip_speed ? std::max(std::abs(event.approach_speed), event.slip_speed)
                                               : std::abs(event.approach_speed);
    if (event.approach_speed < -tolerances_.relative * std::max(scale, 1.0))
      tell(Kind::not_approaching, event, -event.approach_speed, event.approach_speed, 0);
    if (available_.slip_speed && available_.milling_dose) {
      findings_.judged(Check::milling_dose);
      const Speeds speeds{-event.approach_speed, event.slip_speed};
      const double speed = std::max(scale, law(impact).least_separation);
      const double allowed_off = 4 * tolerances_.relative * impact.effective_mass * speed * speed;
      const double expected = dose_by_law(impact, law(impact), speeds);
      const double off = std::abs(event.milling_dose - expected);
      auto without = law(impact);
      without.least_separation = 0;
      const bool no_rule = std::abs(event.milling_dose - dose_by_law(impact, without, speeds)) <= allowed_off;
      if (off > allowed_off)
        tell(Kind::milling_dose, event, off, event.milling_dose, expected,
             no_rule ? "the dose of the law without a least separation speed" : "");
    }
  }
  if (available_.wall_work && !event.with_wall) {
    findings_.judged(Check::wall_work);
    if (event.wall_work != 0) tell(Kind::wall_work, event, std::abs(event.wall_work), event.wall_work, 0);
  }
}

}  // namespace edmill::audit
