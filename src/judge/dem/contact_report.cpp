#include <fmt/format.h>

#include "base/version.hpp"
#include "dem/contact_audit.hpp"
#include "io/json_text.hpp"

namespace edmill::dem {

namespace {

const char* name_of(ContactVerdict verdict) {
  return verdict == ContactVerdict::agrees    ? "agrees with the case"
         : verdict == ContactVerdict::differs ? "differs from the case"
                                              : "too few contacts to judge";
}

std::string interval(const Median& m) {
  return m.high > m.low ? fmt::format("{:.4f} ({:.4f} to {:.4f})", m.value, m.low, m.high)
                        : fmt::format("{:.6g}", m.value);
}

std::string sentence(const Judged& j) {
  return fmt::format("{} is {}{}{}, the case has {:.6g}", j.name, interval(j.found),
                     j.unit.empty() ? "" : " ", j.unit, j.expected);
}

void put_values(io::JsonText& json, const std::vector<Judged>& values) {
  json.begin("values");
  for (const auto& j : values) {
    json.begin(j.name);
    json.number("found", j.found.value);
    json.number("low", j.found.low);
    json.number("high", j.found.high);
    json.integer("contacts", j.found.count);
    json.number("expected", j.expected);
    json.number("allowed", j.allowed);
    json.flag("agrees", j.agrees());
    if (!j.equation.empty()) json.text("equation", j.equation);
    json.end();
  }
  json.end();
}

}  // namespace

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
  return out + fmt::format("\n  verdict: {}\n", name_of(a.verdict));
}

std::string to_json(const ContactAudit& a) {
  io::JsonText json;
  json.text("format", "edmill contact audit 1");
  json.text("version", version());
  json.text("verdict", a.verdict == ContactVerdict::agrees    ? "agrees"
                       : a.verdict == ContactVerdict::differs ? "differs"
                                                              : "too few");
  json.text("case", a.case_name);
  json.text("log", a.log_name);
  json.integer("contacts", a.facts.contacts);
  json.integer("frames", a.facts.frames);
  json.number("frame_interval", a.facts.statistics.interval);
  json.number("contact_time", a.facts.statistics.contact_time);
  json.begin("classes");
  for (std::size_t k = 0; k < contact_class_names.size(); ++k) {
    json.begin(contact_class_names[k]);
    json.integer("contacts", a.counts[k]);
    json.number("milling_dose", a.facts.doses[k]);
    json.end();
  }
  json.end();
  json.number("milling_dose_rate", a.dose_rate);
  json.number("milling_dose_rate_half_width", a.dose_rate_half_width);
  put_values(json, a.judged);
  json.number("wall_distance", a.wall_distance);
  json.number("wall_resolution", a.wall_resolution);
  json.begin("slips");
  for (const auto& s : a.slips) {
    json.begin(fmt::format("{:.4g}", s.ratio));
    for (const auto* m : {&s.of_walls, &s.of_balls}) {
      if (!m->known()) continue;
      json.number(m == &s.of_walls ? "walls" : "balls", m->value);
      json.number(m == &s.of_walls ? "walls_half_width" : "balls_half_width", m->half_width());
    }
    json.end();
  }
  json.end();
  json.begin("causes");
  for (const auto& c : a.causes) {
    json.begin(c.key);
    json.number("value", c.value);
    json.number("half_width", c.half_width);
    json.number("expected", c.expected);
    json.number("left", c.left);
    json.end();
  }
  json.end();
  return json.finish();
}

std::string to_junit(const ContactAudit& a) {
  io::JunitText junit("edmill audit of " + a.log_name);
  for (const auto& j : a.judged) junit.add(j.name, j.agrees() ? "" : sentence(j));
  std::string moved;
  if (!a.walls_met()) moved = "balls leave their flights away from the walls of the case";
  for (const auto& c : a.causes) moved += fmt::format("; with {}: {}", c.key, c.text);
  junit.add("places of the walls", moved);
  junit.add("enough contacts", a.verdict != ContactVerdict::too_few ? "" : "too few contacts to judge");
  return junit.finish();
}

}  // namespace edmill::dem
