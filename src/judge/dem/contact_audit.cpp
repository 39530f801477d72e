#include "dem/contact_audit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "base/statistics.hpp"
#include "base/version.hpp"
#include "compare/junit.hpp"
#include "dem/soft_contact.hpp"
#include "io/json_text.hpp"

namespace edmill::dem {

namespace {

/// What one single contact shows.
struct Shown {
  double approach = 0, slip = 0;       ///< at the touch [m/s]
  double pressed = 0;                  ///< what the wall and gravity add to the approach meanwhile, over it
  double separation = 0;               ///< at the detachment, over approach
  double restitution = 0;              ///< what it would be if nothing pressed
  double slip_change = 0;              ///< of the surface's velocity along it [m/s]
  double slip_left = 0;                ///< along the slip at the touch, over it
  double compliance = 1;               ///< 1 + M/(m_i J_i) + M/(m_j J_j)
  double expected = 0, friction = -1;  ///< of the case's law; no friction below 0
};

void set_expected(const model::ContactLaw<double>& law, const model::ContactBodies<double>& bodies,
                  Shown& shown) {
  shown.expected = law.restitution(shown.approach, bodies);
  law.parameters([&](const model::Parameter& p, double value) {
    if (p.key == std::string("friction")) shown.friction = value;
  });
  shown.restitution = shown.separation + press_effect(shown.expected) * shown.pressed;
}

/// Of the surface of a ball at a wall, into the vessel, and along the wall [m/s].
struct SurfaceSpeed {
  double normal = 0;
  Vector along;
};

SurfaceSpeed speed_at_wall(const MovingVessel& vessel, const Contact& c, double time,
                           const BallState& state) {
  const auto ball = static_cast<std::size_t>(c.ball);
  const auto pose = vessel.at(time);
  const Vector n = vessel.normal(pose, ball, c.partner, state.position);
  const Vector arm = -n * vessel.ball(ball).radius;
  const Vector g =
      state.velocity + cross<double>(state.spin, arm) - vessel.wall_velocity(pose, state.position + arm);
  const double normal = dot<double>(g, n);
  return {normal, g - n * normal};
}

void set_slip(const Vector& before, const Vector& after, Shown& shown) {
  shown.slip = norm<double>(before);
  shown.slip_change = norm<double>(Vector(after - before));
  if (shown.slip > 0) shown.slip_left = dot<double>(after, before) / (shown.slip * shown.slip);
}

/// Restitution is against the wall's velocity at either time: it turns meanwhile, and so does the normal
/// where the wall is round. Both, and gravity, press the ball on the wall or lift it, as the flights show if
/// they go on through the contact.
Shown shown_by_wall(const MovingVessel& vessel, const model::Mill<double>& mill, const Vector& gravity,
                    const Contact& c) {
  Shown shown;
  const auto& b = vessel.ball(static_cast<std::size_t>(c.ball));
  const double duration = c.end - c.begin;
  const auto touch = speed_at_wall(vessel, c, c.begin, c.before),
             leave = speed_at_wall(vessel, c, c.end, c.after);
  const auto flown_on = speed_at_wall(vessel, c, c.end, flown(c.before, gravity, duration));
  const auto flown_back = speed_at_wall(vessel, c, c.begin, flown(c.after, gravity, -duration));
  shown.approach = -touch.normal;
  if (shown.approach > 0) {
    shown.separation = leave.normal / shown.approach;
    shown.pressed =
        (flown_back.normal - leave.normal + touch.normal - flown_on.normal) / (2 * shown.approach);
  }
  shown.compliance = 1 + 1 / b.reduced_inertia;
  const Vector turned = flown_on.along - touch.along;
  set_slip(touch.along, leave.along - turned, shown);
  set_expected(mill.law_with_wall(b, c.partner), {b.mass, b.radius}, shown);
  return shown;
}

/// Pairs are judged along the mean normal: the line of centres turns while they touch.
Shown shown_by_pair(const MovingVessel& vessel, const model::Mill<double>& mill, const Contact& c) {
  Shown shown;
  const auto &a = vessel.ball(static_cast<std::size_t>(c.ball)),
             &b = vessel.ball(static_cast<std::size_t>(c.partner));
  const auto unit = [](const Vector& v) { return Vector(v / norm<double>(v)); };
  const Vector n = unit(unit(c.before.position - c.partner_before.position) +
                        unit(c.after.position - c.partner_after.position));
  const auto surface = [&](const BallState& i, const BallState& j) {
    return Vector(i.velocity - j.velocity - cross<double>(Vector(i.spin * a.radius + j.spin * b.radius), n));
  };
  const Vector before = surface(c.before, c.partner_before), after = surface(c.after, c.partner_after);
  shown.approach = -dot<double>(before, n);
  if (shown.approach > 0) shown.separation = dot<double>(after, n) / shown.approach;
  const double effective = a.mass * b.mass / (a.mass + b.mass);
  shown.compliance = 1 + effective / (a.mass * a.reduced_inertia) + effective / (b.mass * b.reduced_inertia);
  set_slip(before - n * dot<double>(before, n), after - n * dot<double>(after, n), shown);
  set_expected(mill.law_between(a, b), {effective, a.radius, b.radius}, shown);
  return shown;
}

/// Beyond, what presses is no small part of a contact.
constexpr double most_pressed = 0.2;

std::vector<double> values_of(const std::vector<Shown>& list, double least, const auto& value) {
  std::vector<double> values;
  for (const auto& shown : list)
    if (shown.approach >= least && std::abs(shown.pressed) <= most_pressed)
      if (const std::optional<double> v = value(shown)) values.push_back(*v);
  return values;
}

/// Gentle contacts have walls and gravity that turn them within their duration.
double least_approach(const std::vector<Shown>& list) {
  std::vector<double> speeds;
  for (const auto& shown : list) speeds.push_back(shown.approach);
  return numerics::quantile(std::move(speeds), 0.9) / 8;
}

/// Sliding throughout: Walton and Braun's limit is at a slip of compliance mu (1 + e) approach.
std::optional<double> sliding_friction(const Shown& s) {
  const double impulse = s.compliance * (1 + s.separation + s.pressed) * s.approach;
  if (s.friction < 0 || !(impulse > 0) || s.slip < 1.5 * s.friction * impulse) return std::nullopt;
  return s.slip_change / impulse;
}

/// Each contact is compared with its own law, which may depend on speed or materials; what is shown is the
/// median of the laws' values and how far the code is from them.
void judge(const std::string& name, const char* equation, double allowed, const std::vector<Shown>& list,
           const auto& found, double Shown::*expected, ContactAudit& audit) {
  const double least = least_approach(list);
  const auto off = [&](const Shown& s) {
    const std::optional<double> value = found(s);
    return value ? std::optional(*value - s.*expected) : std::nullopt;
  };
  const auto usual = [&](const Shown& s) { return found(s) ? std::optional(s.*expected) : std::nullopt; };
  Judged judged{name, "", equation, median_of(values_of(list, least, off))};
  judged.expected = median_of(values_of(list, least, usual)).value;
  for (double* value : {&judged.found.value, &judged.found.low, &judged.found.high})
    *value += judged.expected;
  judged.allowed = allowed;
  if (judged.found.known()) audit.judged.push_back(judged);
}

void judge_laws(const std::vector<Shown>& list, const std::string& where, ContactAudit& audit) {
  const auto restitution = [](const Shown& s) { return std::optional(s.restitution); };
  judge("restitution " + where, "(2.23')", 0.002, list, restitution, &Shown::expected, audit);
  judge("friction " + where, "(2.24')", 0.01, list, sliding_friction, &Shown::friction, audit);
}

/// What holds for the whole log.
void judge_facts(const model::Mill<double>& mill, ContactAudit& audit) {
  const auto& facts = audit.facts;
  const auto add = [&](const std::string& name, double found, double half_width, double expected,
                       double allowed, const char* unit = "") {
    audit.judged.push_back(
        {name, unit, "", {found, found - half_width, found + half_width, 1}, expected, allowed});
  };
  for (Eigen::Index k = 0; k < 3 && !facts.of_list(); ++k)
    add(fmt::format("gravity along {}", "XYZ"[k]), facts.statistics.gravity[k],
        facts.statistics.gravity_half_width[k], mill.gravity[k], 1e-3 * norm<double>(mill.gravity) + 1e-3,
        "m/s^2");
  add("density over the case's", facts.mass_factor / std::pow(facts.radius_factor, 3), 0, 1, 1e-6);
  add("diameter over the case's", facts.radius_factor, 0, 1, 1e-6);
  // A ball that leaves its flight has met something, as far as frames resolve it.
  if (const double all = facts.dose(); all > 0)
    add("dose with no wall or ball", facts.doses[static_cast<std::size_t>(ContactClass::unexplained)] / all,
        0, 0, 0.01);
}

std::vector<SlipBin> slips_of(const std::vector<Shown>& walls, const std::vector<Shown>& balls) {
  std::vector<SlipBin> bins;
  const double least = std::max(least_approach(walls), least_approach(balls));
  const auto ratio = [](const Shown& s) { return s.slip / s.approach; };
  for (double low = 0; low < 12; low = low < 1 ? low + 0.25 : low * 1.25) {
    const double high = low < 1 ? low + 0.25 : low * 1.25;
    const auto of = [&](const std::vector<Shown>& list, const auto& value) {
      return median_of(values_of(list, least, [&](const Shown& s) -> std::optional<double> {
        if (!(ratio(s) >= low && ratio(s) < high)) return std::nullopt;
        return std::invoke(value, s);
      }));
    };
    SlipBin bin{0, of(walls, &Shown::slip_left), of(balls, &Shown::slip_left)};
    bin.ratio = of(bin.of_walls.count >= bin.of_balls.count ? walls : balls, ratio).value;
    if (bin.of_walls.known() || bin.of_balls.known()) bins.push_back(bin);
  }
  return bins;
}

constexpr std::array<const char*, 3> verdicts{"agrees", "differs", "too few"},
    sentences{"agrees with the case", "differs from the case", "too few contacts to judge"};

std::string interval(const Median& m) {
  return m.high > m.low ? fmt::format("{:.4f} ({:.4f} to {:.4f})", m.value, m.low, m.high)
                        : fmt::format("{:.6g}", m.value);
}

std::string sentence(const Judged& j) {
  return fmt::format("{} is {}{}{}, the case has {:.6g}", j.name, interval(j.found),
                     j.unit.empty() ? "" : " ", j.unit, j.expected);
}

void put_values(io::JsonText& json, const std::vector<Judged>& values) {
  json.groups("values", values, &Judged::name, [&](const Judged& j) {
    json.add("found", j.found.value);
    json.add("low", j.found.low);
    json.add("high", j.found.high);
    json.add("contacts", j.found.count);
    json.add("expected", j.expected);
    json.add("allowed", j.allowed);
    json.add("agrees", j.agrees());
    if (!j.equation.empty()) json.add("equation", j.equation);
  });
}

}  // namespace

ContactAudit audit_contacts(const casefile::CaseSpec& spec, const ContactAuditOptions& options) {
  ContactLogReader log(options.log);
  const auto built = casefile::build_case<double>(spec);
  const auto& mill = built.the_case.mill;
  const MovingVessel vessel(mill, built.the_case.balls, log.facts().facets);
  ContactAudit audit;
  audit.case_name = spec.file;
  audit.log_name = options.log;
  audit.facts = log.facts();
  std::vector<Shown> walls, balls;
  std::vector<Contact> at_walls;
  DoseRate rate(log.facts().first, log.facts().last);
  while (const auto contact = log.next()) {
    if (options.interrupt && *options.interrupt) audit.interrupted = true;
    if (audit.interrupted) break;
    const auto& c = *contact;
    const int balls_of_case = static_cast<int>(vessel.ball_count());
    if (c.ball >= balls_of_case || c.partner >= (c.bodies == 1 ? vessel.walls() : balls_of_case))
      throw InputError(fmt::format("{}: found ball {} with {} {}, expected {} balls and {} walls",
                                   options.log, c.ball, c.bodies == 1 ? "wall" : "ball", c.partner,
                                   balls_of_case, vessel.walls()));
    ++audit.counts[static_cast<std::size_t>(c.kind)];
    rate.add((c.begin + c.end) / 2, c.dose);
    if (c.kind == ContactClass::wall)
      walls.push_back(shown_by_wall(vessel, mill, log.facts().statistics.gravity, c));
    if (c.kind == ContactClass::pair) balls.push_back(shown_by_pair(vessel, mill, c));
    constexpr std::size_t enough = 400;
    if (c.bodies == 1 && c.kind != ContactClass::lasting && at_walls.size() < enough) at_walls.push_back(c);
  }
  audit.dose_rate = rate.mean();
  audit.dose_rate_half_width = rate.half_width();
  judge_laws(walls, "at walls", audit);
  judge_laws(balls, "between balls", audit);
  const bool enough = !audit.judged.empty();
  judge_facts(mill, audit);
  audit.slips = slips_of(walls, balls);
  // Balls of another size meet the walls elsewhere.
  if (audit.facts.radius_factor == 1 && !audit.facts.of_list())
    judge_places(spec, at_walls, options.interrupt, audit);
  const bool all = std::ranges::all_of(audit.judged, [](const Judged& j) { return j.agrees(); });
  if (!all || !audit.walls_met())
    audit.verdict = ContactVerdict::differs;
  else if (enough && !audit.interrupted)
    audit.verdict = ContactVerdict::agrees;
  return audit;
}

std::string table(const ContactAudit& a) {
  const auto& f = a.facts;
  const auto frames = f.of_list()
                          ? std::string(" with walls")
                          : fmt::format(" in {} frames, {:.3g} s apart", f.frames, f.statistics.interval);
  std::string out = fmt::format(
      "{}: {} contacts{}, {:g} s to {:g} s; a contact lasts {:.3g} s{}\n"
      "judged by {}\n\n  {:<14}{:>10}{:>12}\n",
      a.log_name, f.contacts, frames, f.first, f.last, f.statistics.contact_time,
      a.interrupted ? " (interrupted)" : "", a.case_name, "contacts", "number", "of the dose");
  const double dose = f.dose();
  for (std::size_t k = 0; k < contact_class_names.size(); ++k)
    out += fmt::format("  {:<14}{:>10}{:>11.2f}%\n", contact_class_names[k], a.counts[k],
                       dose != 0 ? 100 * f.doses[k] / dose : 0);
  out += fmt::format(
      "\n  dose rate{}, by the balance of energy: {:.4g} ± {:.2g} W\n\n  {:<32}{:<28}{:>10}{:>10}  {}\n",
      f.of_list() ? " of these contacts" : "", a.dose_rate, a.dose_rate_half_width, "value",
      "found, 95 % interval", "case", "allowed", "");
  for (const auto& j : a.judged)
    out += fmt::format("  {:<32}{:<28}{:>10.5g}{:>10.2g}  {}\n", j.name, interval(j.found), j.expected,
                       j.allowed, j.agrees() ? "" : "differs");
  if (a.wall_resolution > 0)
    out += fmt::format(
        "\n  balls leave their flights {:.3g} m from the walls of the case; frames resolve {:.3g} m\n",
        a.wall_distance, a.wall_resolution);
  for (const auto& cause : a.causes)
    out += fmt::format("    with {}: {}; then {:.3g} m\n", cause.key, cause.text, cause.left);
  if (!a.walls_met() && a.causes.empty()) out += "    no single number of mill or vessel explains it\n";
  if (!a.slips.empty())
    out += "\n  what a contact leaves of the slip\n  slip/approach   at walls            between balls\n";
  for (const auto& s : a.slips) {
    const auto cell = [](const Median& m) {
      return m.known() ? fmt::format("{:.3f} ± {:.3f}", m.value, m.half_width()) : "-";
    };
    out += fmt::format("  {:<16.3f}{:<20}{}\n", s.ratio, cell(s.of_walls), cell(s.of_balls));
  }
  return out + fmt::format("\n  verdict: {}\n", sentences[static_cast<std::size_t>(a.verdict)]);
}

std::string to_json(const ContactAudit& a) {
  io::JsonText json;
  json.add("format", "edmill contact audit 1");
  json.add("version", version());
  json.add("verdict", verdicts[static_cast<std::size_t>(a.verdict)]);
  json.add("case", a.case_name);
  json.add("log", a.log_name);
  json.add("contacts", a.facts.contacts);
  json.add("frames", a.facts.frames);
  json.add("frame_interval", a.facts.statistics.interval);
  json.add("contact_time", a.facts.statistics.contact_time);
  json.begin("classes");
  for (std::size_t k = 0; k < contact_class_names.size(); ++k) {
    json.begin(contact_class_names[k]);
    json.add("contacts", a.counts[k]);
    json.add("milling_dose", a.facts.doses[k]);
    json.end();
  }
  json.end();
  json.add("milling_dose_rate", a.dose_rate);
  json.add("milling_dose_rate_half_width", a.dose_rate_half_width);
  put_values(json, a.judged);
  json.add("wall_distance", a.wall_distance);
  json.add("wall_resolution", a.wall_resolution);
  const auto ratio_of = [](const auto& s) { return fmt::format("{:.4g}", s.ratio); };
  json.groups("slips", a.slips, ratio_of, [&](const auto& s) {
    for (const auto* m : {&s.of_walls, &s.of_balls}) {
      if (!m->known()) continue;
      json.add(m == &s.of_walls ? "walls" : "balls", m->value);
      json.add(m == &s.of_walls ? "walls_half_width" : "balls_half_width", m->half_width());
    }
  });
  json.groups("causes", a.causes, &GeometryCause::key, [&](const GeometryCause& c) {
    json.add("value", c.value);
    json.add("half_width", c.half_width);
    json.add("expected", c.expected);
    json.add("left", c.left);
  });
  return json.finish();
}

std::string to_junit(const ContactAudit& a) {
  std::vector<compare::JunitCase> cases;
  for (const auto& j : a.judged) cases.emplace_back(j.name, j.agrees() ? "" : sentence(j));
  std::string moved;
  if (!a.walls_met()) moved = "balls leave their flights away from the walls of the case";
  for (const auto& c : a.causes) moved += fmt::format("; with {}: {}", c.key, c.text);
  cases.emplace_back("places of the walls", moved);
  cases.emplace_back("enough contacts",
                     a.verdict != ContactVerdict::too_few ? "" : "too few contacts to judge");
  return compare::junit_text("edmill audit of " + a.log_name, cases);
}

}  // namespace edmill::dem
