// ImpactJudge: one mistake that reproduces the logged outcome.
#include <algorithm>
#include <cmath>

#include "check/impact_judge.hpp"

namespace edmill::audit {

bool ImpactJudge::explain_by_formula(const LoggedEvent& event, const Scene& scene, double allowed_off,
                                     Explanation& explanation) const {
  const LoggedImpact& impact = scene.impact;
  const auto fits = [&](const Formula& formula) {
    return distance(impact, event, outcome(impact, law(impact), event, formula)) <= allowed_off;
  };
  const auto found = [&](Kind kind, const char* note) {
    explanation = {kind, note, impact};
    return true;
  };
  Formula f;
  f.velocity_sign = -1;
  if (fits(f))
    return found(Kind::tangential_sign, "(2.34), (A.72) as printed: only the velocity's sign is wrong");
  f.spin_sign = -1;
  if (fits(f)) return found(Kind::tangential_sign, "velocity and spin both have the wrong sign");
  f.velocity_sign = 1;
  if (fits(f)) return found(Kind::spin_change, "the spin has the wrong sign");
  f.spin_sign = 0;
  if (fits(f)) return found(Kind::spin_change, "the spin does not change");
  f = {};
  f.friction_of_restitution = true;
  if (fits(f))
    return found(Kind::tangential_restitution,
                 "friction is limited by mu (1 + e_n) |g_n|, not by the actual impulse at v_s");
  if (!impact.with_wall) {
    for (const auto& ball : impact.ball) {
      f = {};
      f.compliance_in_e_t = 1 + 1 / ball.reduced_inertia;
      if (fits(f)) return found(Kind::unequal_balls, "(2.24) as printed: 1 + 1/J");
      f.compliance_in_impulse = f.compliance_in_e_t;
      if (fits(f)) return found(Kind::unequal_balls, "(2.24) as printed: 1 + 1/J, in the impulse too");
    }
    f = {};
    f.share = {0.5, 0.5};
    if (fits(f)) return found(Kind::unequal_balls, "the formula for equal masses");
    f.share = {impact.effective_mass / impact.ball[1].mass, impact.effective_mass / impact.ball[0].mass};
    if (fits(f)) return found(Kind::unequal_balls, "the masses are exchanged");
  }
  return false;
}

/// Finds one mistake that reproduces the logged outcome.
bool ImpactJudge::explain(const LoggedEvent& event, const Scene& scene, double allowed_off,
                          Explanation& explanation) const {
  const LoggedImpact& impact = scene.impact;
  if (explain_by_formula(event, scene, allowed_off, explanation)) return true;
  if (!impact.with_wall) return false;
  const Vec centre = event.body[0].position, point = centre - impact.normal * impact.ball[0].radius;
  for (int k = 1; k < wall_velocity_count; ++k) {
    LoggedImpact theirs = impact;
    const auto formula = static_cast<WallVelocity>(k);
    theirs.wall_velocity = wall_velocity(formula, scene.nested, scene.printed, point, centre) +
                           piston_velocity(scene.nested, impact.wall, impact.normal);
    if (distance(theirs, event, outcome(theirs, law(theirs), event, {})) <= allowed_off) {
      explanation = {Kind::wall_velocity, name_of(formula), theirs};
      return true;
    }
  }
  return false;
}

/// The bodies separate at e_n |g_n| where v_s applies, or the reverse.
bool ImpactJudge::leaves_by_the_other_branch(const LoggedEvent& event, const LoggedImpact& impact,
                                             double allowed_off) const {
  const auto& l = law(impact);
  const double g_n = dot(impact.before(event), impact.normal), left = dot(impact.after(event), impact.normal);
  const double by_restitution = l.restitution(-g_n, impact.bodies()) * -g_n;
  const double other =
      separation_speed(l, impact, g_n) > by_restitution ? by_restitution : l.least_separation;
  return l.least_separation > 0 && std::abs(left - other) <= allowed_off;
}

/// Reports a wrong speed of separation: the law's other branch, another least speed, or neither.
void ImpactJudge::tell_normal(const LoggedEvent& event, const LoggedImpact& impact, double off,
                              double allowed_off) {
  const auto& l = law(impact);
  const double g_n = dot(impact.before(event), impact.normal), left = dot(impact.after(event), impact.normal);
  const double right = separation_speed(l, impact, g_n),
               by_restitution = l.restitution(-g_n, impact.bodies()) * -g_n;
  const auto finding = [&](Kind kind, double found, double expected, const char* note) {
    return Finding{kind,          off,   event.line, event.time, event.ball, event.with_wall,
                   event.partner, found, expected,   note};
  };
  const auto tell_separation = [&](const char* note) {
    findings_.add(finding(Kind::separation_law, left, right, note));
  };
  if (leaves_by_the_other_branch(event, impact, allowed_off))
    return tell_separation(right > by_restitution ? "separates at e_n |g_n|, which is below v_s"
                                                  : "separates at v_s, which is below e_n |g_n|");
  const auto by_ratio = g_n != 0 ? finding(Kind::normal_restitution, -left / g_n, -right / g_n, "")
                                 : finding(Kind::normal_restitution, unknown, unknown, "");
  if (left <= by_restitution + allowed_off) return findings_.add(by_ratio);
  for (auto& [of_law, other] : other_least_) {
    // A constant restitution gives the same speed for the same approach only.
    if (!(std::abs(left - other.speed) <= allowed_off &&
          other.speed * std::abs(g_n - other.g_n) > 2 * allowed_off * std::abs(g_n)))
      continue;
    constexpr const char* note = "separates at another least separation speed than the case's";
    if (other.held) {
      Finding first = *other.held;
      first.kind = Kind::separation_law, first.note = note;
      first.found = other.speed, first.expected = other.due;
      findings_.add(first);
    }
    other.held.reset();
    other.confirmed = true;
    return tell_separation(note);
  }
  OtherLeast& other = other_least_[number_of(l)];
  if (other.confirmed || left > other.speed - allowed_off) return findings_.add(by_ratio);
  if (other.held) findings_.add(*other.held);
  other = {left, g_n, right, false, by_ratio};
}

void ImpactJudge::finish() {
  for (auto& [of_law, other] : other_least_) {
    if (other.held) findings_.add(*other.held);
    other.held.reset();
  }
}

/// The logged speeds show that the code used another velocity of the contact point.
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
