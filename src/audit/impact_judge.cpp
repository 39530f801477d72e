#include "edmill/audit/impact_judge.hpp"

#include <algorithm>
#include <cmath>

namespace edmill::audit {

namespace {

std::size_t bodies(const Impact& impact) { return impact.with_wall ? 1 : 2; }

/// Kinetic energy gained by the balls [J].
double kinetic_change(const LoggedEvent& event, const Impact& impact) {
  double change = 0;
  for (std::size_t k = 0; k < bodies(impact); ++k) {
    const auto& ball = impact.ball[k];
    const auto& b = event.body[k];
    // (a - b).(a + b) loses fewer digits than a.a - b.b.
    change += ball.mass / 2 *
              dot(Vec(b.velocity_after - b.velocity_before), Vec(b.velocity_after + b.velocity_before));
    change += ball.mass * ball.reduced_inertia * ball.radius * ball.radius / 2 *
              dot(Vec(b.spin_after - b.spin_before), Vec(b.spin_after + b.spin_before));
  }
  return change;
}

double work_of_wall(const LoggedEvent& event, const Impact& impact) {
  if (!impact.with_wall) return 0;
  return impact.ball[0].mass *
         dot(impact.wall_velocity, Vec(event.body[0].velocity_after - event.body[0].velocity_before));
}

}  // namespace

double ImpactJudge::Residuals::largest() const { return std::max({normal, tangential, momentum, spin}); }

void ImpactJudge::tell(Kind kind, const LoggedEvent& event, double size, double found, double expected,
                       const char* note) {
  findings_.add({kind, size, event.line, event.time, event.ball, event.with_wall, event.partner, found,
                 expected, note});
}

std::vector<Formula> ImpactJudge::right_formulas(const Impact& impact, const Restitutions& allowed) const {
  std::vector<Formula> formulas;
  Formula formula;
  if (allowed.law) {
    formula.restitution = law(impact).restitution_normal;
    formulas.push_back(formula);
  }
  formula.restitution = 1;
  if (allowed.collapse) formulas.push_back(formula);
  formula.lossless = true;
  if (allowed.rest) formulas.push_back(formula);
  return formulas;
}

/// The equations themselves: momentum, torque, and the two restitutions of the contact point's velocity.
auto ImpactJudge::residuals(const LoggedEvent& event, const Impact& impact, const Restitutions& allowed,
                            const Known& known) const -> Residuals {
  Residuals best;
  const Vec g = impact.before(event), g_after = impact.after(event);
  const double g_n = dot(g, impact.normal), g_n_after = dot(g_after, impact.normal);
  const Vec slip = g - impact.normal * g_n, slip_after = g_after - impact.normal * g_n_after;
  std::array<Vec, 2> impulse;  // on each ball
  for (std::size_t k = 0; k < bodies(impact); ++k)
    impulse[k] = (event.body[k].velocity_after - event.body[k].velocity_before) * impact.ball[k].mass;
  if (!impact.with_wall) best.momentum = size(Vec(impulse[0] + impulse[1])) / impact.effective_mass;
  if (known.spins)
    for (std::size_t k = 0; k < bodies(impact); ++k) {
      const auto& ball = impact.ball[k];
      const Vec arm = impact.normal * (k == 0 ? -ball.radius : ball.radius);
      const Vec change = event.body[k].spin_after - event.body[k].spin_before;
      const Vec off = change * (ball.mass * ball.reduced_inertia * ball.radius * ball.radius) -
                      cross<double>(arm, impulse[k]);
      best.spin = std::max(best.spin, size(off) / (ball.mass * ball.radius));
    }
  const double bounce = std::max(0.0, dot(impulse[0], impact.normal)) / impact.effective_mass;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& formula : right_formulas(impact, allowed)) {
    const double normal = std::abs(g_n_after + formula.restitution * g_n);
    const double e_t =
        formula.lossless ? 1 : tangential_restitution(law(impact), impact.compliance, bounce, size(slip));
    const double tangential = known.spins ? size(Vec(slip_after - slip * e_t)) : 0;
    if (!(normal + tangential < least)) continue;
    least = normal + tangential;
    best.normal = normal, best.tangential = tangential;
    best.restitution = formula.restitution, best.lossless = formula.lossless;
  }
  return best;
}

/// Names what is broken by the equation that does not hold.
void ImpactJudge::tell_broken_equations(const LoggedEvent& event, const Scene& scene, const Residuals& off,
                                        const Known& known, double allowed_off) {
  const Impact& impact = scene.impact;
  const Vec g = impact.before(event), g_after = impact.after(event);
  const double g_n = dot(g, impact.normal), g_n_after = dot(g_after, impact.normal);
  const bool normal = off.normal > allowed_off, tangential = off.tangential > allowed_off;
  const bool spin = off.spin > allowed_off;
  if (off.momentum > allowed_off) tell(Kind::momentum, event, off.momentum, off.momentum, 0);
  if (spin) tell(Kind::spin_change, event, off.spin, off.spin, 0);
  if (event.with_wall && !spin &&
      ((normal && tangential) || speeds_tell_another_wall_velocity(event, scene, known, allowed_off))) {
    const Vec change = event.body[0].velocity_after - event.body[0].velocity_before;
    const double implied = dot(event.body[0].velocity_before, impact.normal) +
                           dot(change, impact.normal) / (1 + off.restitution);
    return tell(Kind::wall_velocity, event, std::max(off.normal, off.tangential), implied,
                dot(impact.wall_velocity, impact.normal));
  }
  if (normal)
    tell(Kind::normal_restitution, event, off.normal, g_n != 0 ? -g_n_after / g_n : unknown, off.restitution);
  // Without the right torque the slip after the impact tells nothing of its own.
  if (tangential && !spin) {
    const Vec slip = g - impact.normal * g_n, slip_after = g_after - impact.normal * g_n_after;
    const double bounce = std::max(0.0, -(1 + off.restitution) * g_n);
    tell(Kind::tangential_restitution, event, off.tangential,
         dot(slip, slip) > 0 ? dot(slip, slip_after) / dot(slip, slip) : unknown,
         off.lossless ? 1 : tangential_restitution(law(impact), impact.compliance, bounce, size(slip)));
  }
}

void ImpactJudge::judge(const LoggedEvent& event, Scene scene, const Restitutions& allowed) {
  if (!available_.positions(event.with_wall) || !available_.velocities_before(event.with_wall)) {
    judge_speeds(event, scene.impact, allowed);
    return;
  }
  const Known known{available_.velocities_after(event.with_wall), available_.spins(event.with_wall)};
  if (scene.displaced && known.velocities) {
    // With the printed matrix goes either its own derivative or the printed velocity.
    Impact other = scene.impact;
    const Vec& centre = event.body[0].position;
    other.wall_velocity = wall_velocity(WallVelocity::of_the_printed_matrix, scene.nested, scene.printed,
                                        centre - other.normal * other.ball[0].radius, centre);
    if (residuals(event, other, allowed, known).largest() <
        residuals(event, scene.impact, allowed, known).largest())
      scene.impact = other;
  }
  const Impact& impact = scene.impact;
  const double scale = velocity_scale(impact, event, known.spins);
  const double allowed_off = tolerances_.relative * scale;
  const double g_n = dot(impact.before(event), impact.normal);
  findings_.judged(Check::approach);
  if (g_n > allowed_off) tell(Kind::not_approaching, event, g_n, -g_n, 0);
  Impact theirs = impact;
  bool wall_velocity_told = false;
  if (known.velocities) {
    findings_.judged(Check::normal_law);
    if (!event.with_wall) findings_.judged(Check::momentum);
    if (known.spins) findings_.judged(Check::tangential_law), findings_.judged(Check::spin_change);
    const auto off = residuals(event, impact, allowed, known);
    const double friction =
        law(impact).model == model::ContactModel::walton_braun ? std::min(law(impact).friction, 10.0) : 0;
    const double slack = allowed_off * (1 + friction * impact.compliance);
    if (off.largest() > slack) {
      Explanation explanation;
      if (known.spins && explain(event, scene, allowed, slack, explanation)) {
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
  if (known.velocities && known.spins) judge_energies(event, impact, theirs, allowed, scale);
}

void ImpactJudge::judge_logged_speeds(const LoggedEvent& event, const Impact& impact, const Known& known,
                                      double scale, bool wall_velocity_told) {
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

/// (2.30), (2.36)
double ImpactJudge::dose_by_law(const Impact& impact, const Formula& formula, double approach,
                                double slip) const {
  const double e_n = formula.restitution;
  const double e_t = formula.lossless ? 1
                                      : tangential_restitution(law(impact), impact.compliance,
                                                               (1 + e_n) * std::max(0.0, approach), slip);
  return impact.effective_mass / 2 *
         ((1 - e_n * e_n) * approach * approach + (1 - e_t * e_t) / impact.compliance * slip * slip);
}

/// What is lost is what the wall gave less what the balls have gained. The dose of a broken impact may also
/// be the law's for the same speeds: then its law is to blame and not its dose.
void ImpactJudge::judge_energies(const LoggedEvent& event, const Impact& right, const Impact& theirs,
                                 const Restitutions& allowed, double scale) {
  const double allowed_off = 4 * tolerances_.relative * right.effective_mass * scale * scale;
  const double lost = work_of_wall(event, right) - kinetic_change(event, right);
  if (lost < -allowed_off) {
    ++energies_.creating;
    energies_.created -= lost;
  }
  if (available_.milling_dose) {
    findings_.judged(Check::milling_dose);
    const Vec g = theirs.before(event);
    const double g_n = dot(g, theirs.normal), slip = size(Vec(g - theirs.normal * g_n));
    double off = std::abs(event.milling_dose - lost);
    off = std::min(
        off, std::abs(event.milling_dose - (work_of_wall(event, theirs) - kinetic_change(event, theirs))));
    for (const auto& formula : right_formulas(theirs, allowed))
      off = std::min(off, std::abs(event.milling_dose - dose_by_law(theirs, formula, -g_n, slip)));
    if (off > allowed_off) tell(Kind::milling_dose, event, off, event.milling_dose, lost);
  }
  if (available_.wall_work) {
    findings_.judged(Check::wall_work);
    const double expected = work_of_wall(event, right);
    const double off = std::min(std::abs(event.wall_work - expected),
                                std::abs(event.wall_work - work_of_wall(event, theirs)));
    if (off > allowed_off) tell(Kind::wall_work, event, off, event.wall_work, expected);
  }
}

void ImpactJudge::judge_speeds(const LoggedEvent& event, const Impact& impact, const Restitutions& allowed) {
  if (available_.approach_speed) {
    findings_.judged(Check::approach);
    const double scale = available_.slip_speed ? std::max(std::abs(event.approach_speed), event.slip_speed)
                                               : std::abs(event.approach_speed);
    if (event.approach_speed < -tolerances_.relative * std::max(scale, 1.0))
      tell(Kind::not_approaching, event, -event.approach_speed, event.approach_speed, 0);
    if (available_.slip_speed && available_.milling_dose) {
      findings_.judged(Check::milling_dose);
      double off = std::numeric_limits<double>::infinity(), expected = 0;
      for (const auto& formula : right_formulas(impact, allowed)) {
        const double dose = dose_by_law(impact, formula, event.approach_speed, event.slip_speed);
        if (std::abs(event.milling_dose - dose) < off)
          off = std::abs(event.milling_dose - dose), expected = dose;
      }
      if (off > 4 * tolerances_.relative * impact.effective_mass * scale * scale)
        tell(Kind::milling_dose, event, off, event.milling_dose, expected);
    }
  }
  if (available_.wall_work && !event.with_wall) {
    findings_.judged(Check::wall_work);
    if (event.wall_work != 0) tell(Kind::wall_work, event, std::abs(event.wall_work), event.wall_work, 0);
  }
}

}  // namespace edmill::audit
