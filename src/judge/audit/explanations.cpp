// ImpactJudge: the mistakes that may reproduce a logged outcome.
#include <algorithm>
#include <cmath>

#include "audit/impact_judge.hpp"

namespace edmill::audit {

namespace {

enum class Where { balls_and_walls, balls, walls };

/// A formula that codes take for the right one.
struct KnownMistake {
  Kind kind;
  const char* note;
  Where where;
  Formula (*formula)(const LoggedImpact&, std::size_t ball);
  const WallVelocity* wall = nullptr;  ///< in place of the right one
};

double alone(const LoggedImpact& impact, std::size_t ball) {
  return 1 + 1 / impact.ball[ball].reduced_inertia;
}

const std::vector<KnownMistake>& known_mistakes() {
  static const std::vector<KnownMistake> list = [] {
    std::vector<KnownMistake> all = {
        {Kind::tangential_sign, "(2.34), (A.72) as printed: only the velocity's sign is wrong",
         Where::balls_and_walls, [](const auto&, auto) { return Formula{.velocity_sign = -1}; }},
        {Kind::tangential_sign, "velocity and spin both have the wrong sign", Where::balls_and_walls,
         [](const auto&, auto) { return Formula{.velocity_sign = -1, .spin_sign = -1}; }},
        {Kind::spin_change, "the spin has the wrong sign", Where::balls_and_walls,
         [](const auto&, auto) { return Formula{.spin_sign = -1}; }},
        {Kind::spin_change, "the spin does not change", Where::balls_and_walls,
         [](const auto&, auto) { return Formula{.spin_sign = 0}; }},
        {Kind::tangential_restitution,
         "friction is limited by mu (1 + e_n) |g_n|, not by the actual impulse at v_s",
         Where::balls_and_walls, [](const auto&, auto) { return Formula{.friction_of_restitution = true}; }},
        {Kind::unequal_balls, "(2.24) as printed: 1 + 1/J", Where::balls,
         [](const auto& impact, auto ball) { return Formula{.compliance_in_e_t = alone(impact, ball)}; }},
        {Kind::unequal_balls, "(2.24) as printed: 1 + 1/J, in the impulse too", Where::balls,
         [](const auto& impact, auto ball) {
           const double c = alone(impact, ball);
           return Formula{.compliance_in_e_t = c, .compliance_in_impulse = c};
         }},
        {Kind::unequal_balls, "the formula for equal masses", Where::balls,
         [](const auto&, auto) {
           return Formula{.share = {0.5, 0.5}};
         }},
        {Kind::unequal_balls, "the masses are exchanged", Where::balls, [](const auto& impact, auto) {
           return Formula{.share = {impact.effective_mass / impact.ball[1].mass,
                                    impact.effective_mass / impact.ball[0].mass}};
         }}};
    for (std::size_t k = 1; k < wall_velocities.size(); ++k)
      all.push_back({Kind::wall_velocity, wall_velocities[k].note, Where::walls,
                     [](const auto&, auto) { return Formula{}; }, &wall_velocities[k]});
    return all;
  }();
  return list;
}

}  // namespace

ImpactJudge::ImpactJudge(const Judge& shared)
    : Judge(shared),
      suspicions_(known_mistakes().size(), Suspicion(findings_.examples())),
      net_dose_(findings_.examples()),
      dose_without_rule_(findings_.examples()) {}

auto ImpactJudge::explaining(const Scene& scene, double allowed, bool violated)
    -> std::optional<Explanation> {
  const auto& logged = scene.impact.event->body;
  const auto due = outcome(scene.impact, {});
  const double off = distance(scene.impact, logged, due);
  std::optional<Explanation> found;
  ++explained_impacts_;
  for (std::size_t k = 0; k < suspicions_.size(); ++k) {
    // What nothing has pointed to is looked at in the first impacts only.
    if (!violated && !suspicions_[k].is_suspected() && explained_impacts_ > 200) continue;
    const KnownMistake& mistake = known_mistakes()[k];
    LoggedImpact seen = scene.impact;  // by the code
    if (mistake.where == (seen.with_wall() ? Where::balls : Where::walls)) continue;
    if (mistake.wall) seen.set_wall_velocity(*mistake.wall, scene.nested, scene.printed);
    bool shows = true;  // of a number of two balls codes take either one
    double left = std::numeric_limits<double>::infinity();
    for (std::size_t ball = 0; ball < seen.count(); ++ball) {
      const auto result = outcome(seen, mistake.formula(seen, ball));
      shows = shows && distance(scene.impact, due, result) > allowed;
      left = std::min(left, distance(seen, logged, result));
    }
    // Bodies that separate faster than v_s when the mistake is assumed keep their velocities, which proves
    // nothing.
    if (seen.g_n() > seen.law->least_separation + allowed) continue;
    const bool explains = violated && vanishes(off, left, allowed);
    if (explains && !found)
      found = Explanation{mistake.kind, mistake.note, &suspicions_[k], seen, off, left};
    else if (shows && !explains)
      suspicions_[k].contradicted();
  }
  return found;
}

/// Reports a wrong speed of separation. The law's other branch, or another least speed, is named if the log
/// as a whole has it.
void ImpactJudge::tell_normal(const LoggedImpact& impact, double off, double allowed, Findings& plain) {
  const LoggedEvent& event = *impact.event;
  const double g_n = impact.g_n(), left = impact.g_n_after();
  const double due = impact.separation_speed(g_n), by_restitution = impact.by_restitution(g_n);
  const double least = impact.law->least_separation;
  const bool moving = g_n != 0;
  const Finding as_found{event, Kind::normal_restitution, off, moving ? -left / g_n : unknown,
                         moving ? -due / g_n : unknown};
  if (&plain != &findings_) return plain.add(as_found);
  const auto name = [&](Suspicion& suspicion, double left_off, const char* note) {
    suspicion.explains(off, left_off).add({event, Kind::separation_law, off, left, due, note, true});
    suspicion.plain().add(as_found);
  };
  auto& of_law = separations_.try_emplace(number_of_law(impact), findings_.examples()).first->second;
  const double to_branch = std::abs(left - by_restitution), to_least = std::abs(left - least);
  if (due > by_restitution && vanishes(off, to_branch, allowed)) {
    if (of_law.speed < std::numeric_limits<double>::infinity() && by_restitution < of_law.speed - allowed)
      of_law.least.contradicted();
    return name(of_law.least, to_branch, "separates at e_n |g_n|, which is below v_s");
  }
  if (least > 0 && due <= by_restitution && vanishes(off, to_least, allowed))
    return name(of_law.always, to_least, "separates at v_s, which is below e_n |g_n|");
  if (left <= by_restitution + allowed) return plain.add(as_found);
  constexpr const char* another = "separates at another least separation speed than the case's";
  if (!(of_law.speed < std::numeric_limits<double>::infinity())) {
    of_law.speed = left;
    of_law.g_n = g_n;
  }
  if (!vanishes(off, std::abs(left - of_law.speed), allowed)) return plain.add(as_found);
  // A constant restitution gives the same speed for the same approach only.
  const bool other_approach = of_law.speed * std::abs(g_n - of_law.g_n) > 2 * allowed * std::abs(g_n);
  name(of_law.least, other_approach ? std::abs(left - of_law.speed) : off, another);
}

/// Impacts at which a suspected law of separation would show and the log has another one.
void ImpactJudge::see_separation(const LoggedImpact& impact, double allowed) {
  const auto place = separations_.find(number_of_law(impact));
  if (place == separations_.end()) return;
  SeparationSuspicions& of_law = place->second;
  const double g_n = impact.g_n(), left = impact.g_n_after(), due = impact.separation_speed(g_n);
  const auto see = [&](Suspicion& suspicion, double with_it) {
    const bool fits = std::abs(left - with_it) <= allowed;
    if (suspicion.is_suspected() && std::abs(due - with_it) > allowed && !fits) suspicion.contradicted();
  };
  const bool known = of_law.speed < std::numeric_limits<double>::infinity();
  see(of_law.least, std::max({impact.by_restitution(g_n), known ? of_law.speed : 0.0, g_n}));
  see(of_law.always, std::max(impact.law->least_separation, g_n));
}

void ImpactJudge::finish() {
  for (const auto& suspicion : suspicions_) findings_.take(suspicion.findings());
  for (const auto& of_law : separations_) {
    const SeparationSuspicions& own = of_law.second;
    // Few impacts of a law may leave no doubt where another law has the same speed.
    const bool known = std::any_of(separations_.begin(), separations_.end(), [&](const auto& other) {
      const SeparationSuspicions& theirs = other.second;
      return theirs.least.is_named() && std::abs(theirs.speed - own.speed) <= 1e-6 * own.speed;
    });
    findings_.take(own.least.findings(own.least.is_named() || (known && own.least.fits())));
    findings_.take(own.always.findings());
  }
  for (const auto* suspicion : {&net_dose_, &dose_without_rule_}) findings_.take(suspicion->findings());
}

/// The wall's speed along n that the logged speeds imply, where the law of impacts holds with it.
std::optional<double> ImpactJudge::other_wall_speed(const LoggedImpact& impact, const Residuals& off,
                                                    double allowed) const {
  if (!impact.with_wall() || !available_.approach_speed || !available_.slip_speed) return std::nullopt;
  const LoggedEvent& event = *impact.event;
  const double wall = impact.along(event.body[0].velocity_before) + event.approach_speed,
               separation = impact.along(event.body[0].velocity_after) - wall;
  const double normal_left = std::abs(separation - impact.separation_speed(-event.approach_speed));
  // The slip before the impact follows from its change, with e_t of the logged speeds.
  const Vec g = impact.before(), changed = impact.across(impact.after()) - impact.across(g);
  const double e_t =
      impact.tangential_restitution(impact.compliance, separation + event.approach_speed, event.slip_speed);
  const double slip_left = std::abs(size(changed) - std::abs(1 - e_t) * event.slip_speed);
  const double logged_off = std::abs(event.approach_speed + impact.along(g));
  const double all_off = std::max({off.normal, off.tangential, logged_off});
  if (!vanishes(all_off, std::max(normal_left, slip_left), allowed)) return std::nullopt;
  return wall;
}

}  // namespace edmill::audit
