#include <fmt/format.h>

#include "base/version.hpp"
#include "compare/junit.hpp"
#include "dem/contact_audit.hpp"
#include "io/json_text.hpp"

namespace edmill::dem {

namespace {

constexpr std::array<const char*, 3> verdicts{"agrees", "differs", "too few"},
    sentences{"agrees with the case", "differs from the case", "too few contacts to judge"};

std::string interval(const Median& m) {
  return m.high > m.low ? fmt::format("{:.4f} ({:.4f} to {:.4f})", m.value, m.low, m.high)
                        : fmt::format("{:.6g}", m.value);
}

std::string why_not(const Judged& j) {
  if (!j.not_judged.empty()) return j.not_judged;
  return fmt::format("{} contacts with {:.2g} % of the dose show it, {} are needed", j.found.count,
                     100 * j.dose_share, Median::least);
}

std::string sentence(const Judged& j) {
  return fmt::format("{} is {}{}{}, the case has {:.6g}", j.name, interval(j.found),
                     j.unit.empty() ? "" : " ", j.unit, j.expected);
}

}  // namespace

std::string table(const ContactAudit& a) {
  const auto& f = a.facts;
  std::string out = fmt::format(
      "{}: {} contacts in {} frames, {:.3g} s apart, {:g} s to {:g} s; a contact lasts {:.3g} s{}\n"
      "judged by {}\n\n{}\n"
      "  dose rate, by the balance of energy: {:.4g} ± {:.2g} W\n\n  {:<44}{:<28}{:>10}{:>10}  {}\n",
      a.log_name, f.contacts, f.frames, f.statistics.interval, f.first, f.last, f.statistics.contact_time,
      a.interrupted ? " (interrupted)" : "", a.case_name, class_table(f.doses, a.counts), a.dose_rate,
      a.dose_rate_half_width, "value", "found, 95 % interval", "case", "allowed", "");
  for (const auto& j : a.judged)
    if (!j.is_part || !j.agrees() || j.is_open())
      out += j.known() ? fmt::format("  {:<44}{:<28}{:>10.5g}{:>10.2g}  {}\n", j.name, interval(j.found),
                                     j.expected, j.allowed, j.agrees() ? "" : "differs")
                       : fmt::format("  {:<44}not judged: {}\n", j.name, why_not(j));
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
  json.add("format", "edmill contact audit 2", "version", version(), "verdict",
           verdicts[static_cast<std::size_t>(a.verdict)]);
  json.add("case", a.case_name, "log", a.log_name, "contacts", a.facts.contacts);
  json.add("frames", a.facts.frames, "frame_interval", a.facts.statistics.interval, "contact_time",
           a.facts.statistics.contact_time);
  json.begin("classes");
  for (std::size_t k = 0; k < contact_class_names.size(); ++k)
    json.group(contact_class_names[k],
               [&] { json.add("contacts", a.counts[k], "milling_dose", a.facts.doses[k]); });
  json.end();
  json.add("milling_dose_rate", a.dose_rate, "milling_dose_rate_half_width", a.dose_rate_half_width);
  json.groups("values", a.judged, &Judged::name, [&](const Judged& j) {
    json.add("found", j.found.value, "low", j.found.low, "high", j.found.high);
    json.add("contacts", j.found.count, "dose_share", j.dose_share, "expected", j.expected);
    json.add("allowed", j.allowed, "judged", j.known(), "agrees", j.agrees());
    if (!j.equation.empty()) json.add("equation", j.equation);
  });
  json.add("wall_distance", a.wall_distance, "wall_resolution", a.wall_resolution);
  const auto ratio_of = [](const auto& s) { return fmt::format("{:.4g}", s.ratio); };
  json.groups("slips", a.slips, ratio_of, [&](const auto& s) {
    for (const auto* m : {&s.of_walls, &s.of_balls}) {
      if (!m->known()) continue;
      json.add(m == &s.of_walls ? "walls" : "balls", m->value,
               m == &s.of_walls ? "walls_half_width" : "balls_half_width", m->half_width());
    }
  });
  json.groups("causes", a.causes, &GeometryCause::key, [&](const GeometryCause& c) {
    json.add("value", c.value, "half_width", c.half_width, "expected", c.expected, "left", c.left);
  });
  return json.finish();
}

std::string to_junit(const ContactAudit& a) {
  std::vector<compare::JunitCase> cases;
  for (const auto& j : a.judged)
    cases.push_back({j.name, j.agrees() ? "" : sentence(j), j.known() ? "" : why_not(j)});
  std::string moved;
  if (!a.walls_met()) moved = "balls leave their flights away from the walls of the case";
  for (const auto& c : a.causes) moved += fmt::format("; with {}: {}", c.key, c.text);
  cases.push_back({"places of the walls", moved});
  cases.push_back(
      {"enough contacts", a.verdict != compare::Verdict::too_few ? "" : "too few contacts to judge"});
  return compare::junit_text("edmill audit of " + a.log_name, cases);
}

}  // namespace edmill::dem
