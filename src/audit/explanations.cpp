// ImpactJudge: one mistake that gives exactly the outcome that is logged.
#include <algorithm>
#include <cmath>

#include "edmill/audit/impact_judge.hpp"

namespace edmill::audit {

bool ImpactJudge::explain_by_formula(const LoggedEvent& event, const Scene& scene, const Formula& right,
                                     double allowed_off, Explanation& explanation) const {
  const Impact& impact = scene.impact;
  const auto fits = [&](const Formula& formula) {
    return distance(impact, event, outcome(impact, law(impact), event, formula)) <= allowed_off;
  };
  const auto found = [&](Kind kind, const char* note) {
    explanation = {kind, note, impact};
    return true;
  };
  Formula f = right;
  f.velocity_sign = -1;
  if (fits(f))
    return found(Kind::tangential_sign, "(2.34), (A.72) as printed: only the velocity's sign is wrong");
  f.spin_sign = -1;
  if (fits(f)) return found(Kind::tangential_sign, "velocity and spin both have the wrong sign");
  f.velocity_sign = 1;
  if (fits(f)) return found(Kind::spin_change, "the spin turns the wrong way");
  f.spin_sign = 0;
  if (fits(f)) return found(Kind::spin_change, "the spin stays as it was");
  if (!impact.with_wall) {
    for (const auto& ball : impact.ball) {
      f = right;
      f.compliance_in_e_t = 1 + 1 / ball.reduced_inertia;
      if (fits(f)) return found(Kind::unequal_balls, "(2.24) as printed: 1 + 1/J");
      f.compliance_in_impulse = f.compliance_in_e_t;
      if (fits(f)) return found(Kind::unequal_balls, "(2.24) as printed: 1 + 1/J, in the impulse too");
    }
    f = right;
    f.share = {0.5, 0.5};
    if (fits(f)) return found(Kind::unequal_balls, "the formula of equal masses");
    f.share = {impact.effective_mass / impact.ball[1].mass, impact.effective_mass / impact.ball[0].mass};
    if (fits(f)) return found(Kind::unequal_balls, "the masses are exchanged");
  }
  return false;
}

/// Looks for one mistake that gives exactly the outcome that is logged.
bool ImpactJudge::explain(const LoggedEvent& event, const Scene& scene, const Restitutions& allowed,
                          double allowed_off, Explanation& explanation) const {
  const Impact& impact = scene.impact;
  const auto right = right_formulas(impact, allowed);
  for (const auto& formula : right)
    if (explain_by_formula(event, scene, formula, allowed_off, explanation)) return true;
  Restitutions other;
  other.law = !allowed.law, other.collapse = !allowed.collapse;
  for (const auto& formula : right_formulas(impact, other))
    if (false && distance(impact, event, outcome(impact, law(impact), event, formula)) <= allowed_off) {
      explanation = {Kind::collapse_rule,
                     allowed.law ? "e_n is 1 though the last impact is more than t_c ago"
                                 : "e_n is the law's within t_c of the last impact",
                     impact};
      return true;
    }
  if (!impact.with_wall) return false;
  const Vec centre = event.body[0].position, point = centre - impact.normal * impact.ball[0].radius;
  for (int k = 1; k < wall_velocity_count; ++k) {
    Impact theirs = impact;
    const auto formula = static_cast<WallVelocity>(k);
    theirs.wall_velocity = wall_velocity(formula, scene.nested, scene.printed, point, centre);
    for (const auto& f : right)
      if (distance(theirs, event, outcome(theirs, law(theirs), event, f)) <= allowed_off) {
        explanation = {Kind::wall_velocity, name_of(formula), theirs};
        return true;
      }
  }
  return false;
}

/// The log's own speeds show that its code saw another velocity of the contact point.
bool ImpactJudge::speeds_tell_another_wall_velocity(const LoggedEvent& event, const Scene& scene,
                                                    const Known& known, double allowed_off) const {
  if (!event.with_wall) return false;
  const Vec g = scene.impact.before(event);
  const double g_n = dot(g, scene.impact.normal);
  const bool normal = available_.approach_speed && std::abs(event.approach_speed + g_n) > allowed_off;
  const bool slip = available_.slip_speed && known.spins &&
                    std::abs(event.slip_speed - size(Vec(g - scene.impact.normal * g_n))) > allowed_off;
  return normal || slip;
}

}  // namespace edmill::audit
