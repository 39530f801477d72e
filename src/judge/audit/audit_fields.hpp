// The fields of an audit's document.
#pragma once

#include "audit/audit.hpp"
#include "base/version.hpp"
#include "io/fields.hpp"

namespace edmill::audit {

/// Visits the fields of an audit's document. docs/files.md, "Audit"
struct Fields {
  const Audit& a;

  void operator()(auto& v) const {
    v("format", "", "", "edmill audit 2");
    v("version", "", "version of the program", version());
    v("commit", "", "commit of the program", commit());
    v("verdict", "", "`clean`, `violations`, `too_few`", name_of(a.verdict));
    v("case", "", "", a.case_name);
    v("log", "", "", a.log_name);
    v("events", "1", "number of events", a.events);
    v("first_time", "s", "time of the first event", a.first);
    v("last_time", "s", "time of the last event", a.last);
    v("interrupted", "", "`yes` if a signal ended the audit", a.interrupted ? "yes" : "no");
    v("tolerance", "1", "relative tolerance", a.tolerances.relative);
    v("gap_tolerance", "m", "largest gap or overlap of bodies in contact", a.tolerances.gap);
    v("time_rounding", "s", "rounding of the latest time",
        rounding_of(std::max(std::abs(a.first), std::abs(a.last))));
    const auto name = [](auto kind_or_check) { return info(kind_or_check).name; };
    v.each("violations", "by kind, the most frequent first", a.findings.ranked(), name,
        [&](Kind kind) { violations(v, kind); });
    v.each("looks_like", "by name ([audit.md](audit.md#what-a-log-looks-like))", a.diagnoses,
        &Diagnosis::name, [&](const Diagnosis& d) {
          v("events", "1", "number of events that it explains", d.events);
          v("of", "1", "number of events that are wrong", d.of);
          v("text", "", "", d.text);
        });
    v.group("energy", "balance of energy of the impacts whose states are all in the log", [&] {
      const Energies& e = a.energies;
      v("impacts", "1", "number of impacts", e.impacts);
      v("wall_work", "J", "", e.wall_work.value());
      v("milling_dose", "J", "", e.milling_dose.value());
      v("supplied", "J", "energy supplied by the least separation speed", e.supplied.value());
      v("supplying_impacts", "1", "number of impacts in which it supplied energy", e.supplying);
      v("kinetic_change", "J", "", e.kinetic_change.value());
      v("closure", "J", "wall work - dose + supplied - change", e.closure());
    });
    v.group("energy_created",
        "energy created by impacts, beyond what the least separation speed supplies", [&] {
          v("impacts", "1", "number of impacts", a.energies.creating);
          v("energy", "J", "", a.energies.created);
        });
    const auto made = [&](Check check) { return a.findings.judged_number(check); };
    const auto unresolved = [&](Check check) { return a.findings.unresolved_number(check); };
    v.by_name("checked", "1", "number of times that each check was made",
        checks_with([](Check) { return true; }), name, made);
    v.by_name("unresolved", "1",
        "number of times that the tolerance was as large as the value checked",
        checks_with(unresolved), name, unresolved);
    v.by_name("not_checked", "", "checks that were not made, and the columns that they need",
        a.not_made, name, [](Check check) { return info(check).columns; });
    v("undecided", "1", "questions about missed impacts that no scalar could answer", a.undecided);
  }
 private:
  void violations(auto& v, Kind kind) const {
    const Tally& tally = a.findings.of(kind);
    v("count", "1", "", tally.count);
    v("share", "1", "share of the checks made", share_of(a, kind));
    v("worst", "`unit`", "", tally.worst);
    v("unit", "", "", info(kind).unit);
    v("meaning", "", "", info(kind).meaning);
    if (v.has(!tally.notes.empty()))
      v.by_name("notes", "1", "probable reasons, and how many violations have them", tally.notes,
          &decltype(tally.notes)::value_type::first, &decltype(tally.notes)::value_type::second);
    v.numbered("examples", "the worst, by rank", tally.examples, [&](const Finding& f) {
      v("line", "1", "line of the log", f.line);
      v("time", "s", "", f.time);
      v("ball", "", "", f.ball);
      v("partner_kind", "", "`wall` or `ball`", f.with_wall ? "wall" : "ball");
      v("partner", "", "", f.partner);
      v("size", "`unit`", "size of the violation", f.size);
      v("found", "", "null if it does not apply", f.found);
      v("expected", "", "null if it does not apply", f.expected);
      if (v.has(*f.note != '\0')) v("note", "", "a probable reason", f.note);
    });
  }
};

}  // namespace edmill::audit
