#include <fmt/format.h>

#include "base/clean_text.hpp"
#include "base/version.hpp"
#include "dem/contact_rates.hpp"
#include "io/fields.hpp"

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

/// Visits the fields of a document. docs/files.md, "Logs of contacts"
struct Fields {
  const ContactAudit& a;

  void operator()(auto& v) const {
    v("format", "", "", "edmill contact audit 2");
    v("version", "", "version of the program", version());
    v("verdict", "", "`agrees`, `differs`, `too few`",
        verdicts[static_cast<std::size_t>(a.verdict)]);
    v("case", "", "", a.case_name);
    v("log", "", "", a.log_name);
    v("contacts", "1", "number of contacts", a.facts.contacts);
    v("frames", "1", "number of frames", a.facts.frames);
    v("frame_interval", "s", "", a.facts.statistics.interval);
    v("contact_time", "s", "median time during which a ball is not in free flight",
        a.facts.statistics.contact_time);
    v.group("classes", "by name ([dem.md](dem.md#what-can-be-imported))", [&] {
      for (std::size_t k = 0; k < contact_class_names.size(); ++k)
        v.group(contact_class_names[k], "", [&] {
          v("contacts", "1", "number of contacts", a.counts[k]);
          v("milling_dose", "J", "", a.facts.doses[k]);
        });
    });
    v("milling_dose_rate", "W", "dose rate by the balance of energy", a.dose_rate);
    v("milling_dose_rate_half_width", "W", "half-width of its 95 % interval",
        a.dose_rate_half_width);
    v.each("values", "by name, SI", a.judged, &Judged::name, [&](const Judged& j) {
      v("found", "", "", j.found.value);
      v("low", "", "lower end of the 95 % interval", j.found.low);
      v("high", "", "upper end of the 95 % interval", j.found.high);
      v("contacts", "1", "number of contacts that show it", j.found.count);
      v("dose_share", "1", "share of these contacts in the dose", j.dose_share);
      v("expected", "", "value of the case", j.expected);
      v("allowed", "", "deviation allowed beyond the interval", j.allowed);
      v("judged", "", "false if too few contacts show the value, or it follows from another",
          j.known());
      v("agrees", "", "true also if it was not judged", j.agrees());
      if (v.has(!j.equation.empty()))
        v("equation", "", "equation in [theory.md](theory.md)", j.equation);
    });
    v("wall_distance", "m", "distance from the walls at which balls leave their flights",
        a.wall_distance);
    v("wall_resolution", "m", "resolution of this distance by frames", a.wall_resolution);
    const auto ratio_of = [](const SlipBin& s) { return fmt::format("{:.4g}", s.ratio); };
    v.each("slips",
        "fraction of the slip that remains after a contact, by ratio of slip to approach speed",
        a.slips, ratio_of, [&](const SlipBin& s) {
          slip(v, "walls", "fraction of the slip at first touch, at walls", s.of_walls);
          slip(v, "balls", "fraction of the slip at first touch, between balls", s.of_balls);
        });
    v.each("causes", "by key: numbers of the case with which the walls are where balls meet them",
        a.causes, &GeometryCause::key, [&](const GeometryCause& c) {
          v("value", "", "SI", c.value);
          v("half_width", "", "half-width of its interval", c.half_width);
          v("expected", "", "value of the case", c.expected);
          v("left", "m", "distance from the walls that remains with this number", c.left);
        });
  }
 private:
  static void slip(auto& v, const std::string& key, const char* meaning, const Median& left) {
    if (!v.has(left.known())) return;
    v(key, "1", meaning, left.value);
    v(key + "_half_width", "1", "half-width of its 95 % interval", left.half_width());
  }
};

}  // namespace

std::string table(const ContactAudit& a) {
  const auto& f = a.facts;
  std::string out = fmt::format(
      "{}: {} contacts in {} frames, {:.3g} s apart, {:g} s to {:g} s; a contact lasts {:.3g} s{}\n"
      "judged by {}\n\n{}\n"
      "  dose rate, by the balance of energy: {} W\n\n  {:<44}{:<28}{:>10}{:>10}  {}\n",
      a.log_name, f.contacts, f.frames, f.statistics.interval, f.first, f.last,
      f.statistics.contact_time, a.interrupted ? " (interrupted)" : "", a.case_name,
      class_table(f.doses, a.counts), with_interval(a.dose_rate, a.dose_rate_half_width), "value",
      "found, 95 % interval", "case", "allowed", "");
  for (const auto& j : a.judged)
    if (!j.is_part || !j.agrees() || j.is_open())
      out += j.known() ? fmt::format("  {:<44}{:<28}{:>10.5g}{:>10.2g}  {}\n", j.name,
                             interval(j.found), j.expected, j.allowed, j.agrees() ? "" : "differs")
                       : fmt::format("  {:<44}not judged: {}\n", j.name, why_not(j));
  if (a.wall_resolution > 0)
    out += fmt::format(
        "\n  balls leave their flights {:.3g} m from the walls of the case; frames resolve {:.3g} "
        "m\n",
        a.wall_distance, a.wall_resolution);
  for (const auto& cause : a.causes)
    out += fmt::format("    with {}: {}; then {:.3g} m\n", cause.key, cause.text, cause.left);
  if (!a.walls_met() && a.causes.empty())
    out += "    no single number of mill or vessel explains it\n";
  if (!a.slips.empty())
    out +=
        "\n  what a contact leaves of the slip\n  slip/approach   at walls            between "
        "balls\n";
  for (const auto& s : a.slips) {
    const auto cell = [](const Median& m) {
      return m.known() ? with_interval(m.value, m.half_width()) : "-";
    };
    out += fmt::format("  {:<16.3f}{:<20}{}\n", s.ratio, cell(s.of_walls), cell(s.of_balls));
  }
  return out + fmt::format("\n  verdict: {}\n", sentences[static_cast<std::size_t>(a.verdict)]);
}

std::string to_json(const ContactAudit& a) { return io::JsonFields::of(Fields{a}); }

std::string contact_audit_keys() { return io::KeyTable::of(Fields{{}}); }

std::string to_junit(const ContactAudit& a) {
  std::vector<compare::JunitCase> cases;
  for (const auto& j : a.judged)
    cases.push_back({j.name, j.agrees() ? "" : sentence(j), j.known() ? "" : why_not(j)});
  std::string moved;
  if (!a.walls_met()) moved = "balls leave their flights away from the walls of the case";
  for (const auto& c : a.causes) moved += fmt::format("; with {}: {}", c.key, c.text);
  cases.push_back({"places of the walls", moved});
  cases.push_back(
      {"enough contacts", a.verdict != Verdict::too_few ? "" : "too few contacts to judge"});
  return compare::junit_text("edmill audit of " + a.log_name, cases);
}

}  // namespace edmill::dem
