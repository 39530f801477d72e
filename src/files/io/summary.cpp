#include "io/summary.hpp"

#include <algorithm>
#include <utility>

#include "base/scalar_list.hpp"
#include "base/statistics.hpp"
#include "io/fields.hpp"

namespace edmill::io {

namespace {

/// Calls `Visit` with key, unit, meaning and value of every field of summary.json in its order.
template <class Real, class Visit> struct FieldList {
  const Summary<Real>& s;
  Visit& v;

  void visit() {
    const auto& p = s.provenance;
    v("format", "", "", "edmill summary 1");
    v("version", "", "version of the program", p.version);
    v("commit", "", "commit of the program", p.commit);
    v("compiler", "", "compiler that built the program", p.compiler);
    v("case_file", "", "", p.case_file);
    v("case_digest", "",
        "SHA-256 of the case's canonical text: units and comments do not change it", p.case_digest);
    v("settings", "", "keys that `--set` has overridden, with their values", p.settings);
    v("reported", "", "whether the run was made with `--report`", p.reported);
    v("seed", "", "seed of the case", p.seed);
    v("precision", "", "name of the scalar", p.precision);
    if (p.right_digits)
      v("right_digits", "",
          "number of correct digits of every event and of the final state, if digits were "
          "requested; two runs have confirmed them ([precision.md](precision.md#ask-for-digits))",
          *p.right_digits);
    v("end_reason", "",
        "`end_time` or the key of another stop rule, `inelastic_collapse`, `stalled`, "
        "`interrupted`, `undecided`; for a run from Python or C++ also `stopped`, by an observer",
        model::name(s.end_reason));
    if (!s.error.empty()) v("error", "", "why the run ended before its end", s.error);
    v("start_time", "s", "start of the statistics", s.start_time);
    v("end_time", "s", "end of the statistics", s.end_time);
    v("duration", "s", "duration of the statistics", s.duration());

    v.group("collisions", "number of collisions", [&] {
      by_partner("1", [&](std::size_t k) { return s.collisions[k]; });
      v("total", "1", "of all", s.total_collisions());
    });
    v.group("collision_rate",
        "collisions per time; null, as every rate, if the statistics cover no time",
        [&] { visit_rates(s.collisions); });
    v.group("impact_rate",
        "rate of the collisions without contacts at rest, in which the least separation speed acts",
        [&] { visit_rates(s.impacts); });
    v("fast_impact_rate", "1/s", "rate of impacts with an approach speed above 1 m/s",
        per_second(Real(number(s.fast_impacts))));
    const Real impact_dose = s.milling_dose - s.touched_dose;
    v("mean_impact_speed", "m/s",
        "mean approach speed along the normal, weighted by dose, without contacts at rest",
        s.speed_by_dose > 0 && impact_dose > 0 ? std::optional<Real>(s.speed_by_dose / impact_dose)
                                               : std::nullopt);
    v.group("impact_energy_by_dose",
        "kinetic energy of the approach along the normal, M/2 v^2, before any of it is dissipated; "
        "without contacts at rest",
        [&] { by_dose(s.impact_energy); });
    v.group("dissipated_energy_by_dose", "dose of single impacts, without contacts at rest",
        [&] { by_dose(s.dissipated_energy); });
    v("milling_dose", "J", "energy dissipated by all impacts", s.milling_dose);
    v("milling_dose_rate", "W", "", per_second(s.milling_dose));
    v("inverse_milling_dose_rate", "s/J", "null if there is no dose",
        s.duration() > 0 && s.milling_dose > 0 ? std::optional<Real>(s.duration() / s.milling_dose)
                                               : std::nullopt);
    v.group("milling_dose_by_partner", "parts of the milling dose by partner",
        [&] { by_partner("J", [&](std::size_t k) { return s.dose_by_partner[k]; }); });
    if (s.powder_mass) {
      const Real dose = s.milling_dose / *s.powder_mass;
      v("powder_mass", "kg",
          "mass of the powder; this and the next three only if the case has powder",
          *s.powder_mass);
      v("charge_ratio", "1", "mass of the balls divided by that of the powder",
          Real(*s.ball_mass / *s.powder_mass));
      v("specific_milling_dose", "J/kg", "dose divided by the mass of the powder", dose);
      v("specific_milling_dose_rate", "W/kg", "", per_second(dose));
    }

    v("wall_work", "J", "work of the walls on the balls", s.wall_work);
    v("wall_work_rate", "W", "", per_second(s.wall_work));
    v.group("energy", "energies of all balls", [&] {
      v("kinetic_start", "J", "at `start_time`", s.energy_at_start.kinetic);
      v("potential_start", "J", "at `start_time`", s.energy_at_start.potential);
      v("kinetic_end", "J", "at `end_time`", s.energy_at_end.kinetic);
      v("potential_end", "J", "at `end_time`", s.energy_at_end.potential);
      v("closure", "J", "wall work - dose + supplied energy - change of the energies",
          s.energy_closure);
      v("closure_relative", "1",
          "closure relative to the dose, or to the kinetic energy at the start or end if that is "
          "larger",
          Real(s.energy_closure / s.energy_scale()));
    });
    v.group("least_separation", "impacts that separated at the least separation speed", [&] {
      visit_impacts(s.touched_impacts, s.touched_dose);
      v("supplied_energy", "J", "energy that these impacts supply", s.supplied_energy);
      v("supplied_energy_share", "1",
          "share of the supplied energy in the dose, or in the kinetic energy as in `energy`",
          ratio(s.supplied_energy, s.energy_scale()));
    });
    v.group("stalls",
        "impacts without friction because a ball was in a stall ([theory.md](theory.md), section "
        "6)",
        [&] { visit_impacts(s.stall_impacts, s.stall_dose); });

    const auto& i = s.intervals;
    v.group("intervals",
        "half-widths of 95 % intervals under the names of the rates; none for a run of fewer than "
        "five drive periods ([theory.md](theory.md), section 8)",
        [&] {
          v("batches", "1", "number of batches of the statistics", i.batches);
          v("batch_length", "s", "length of a batch", i.batch_length);
          if (!i.any()) return;
          const Real rate = s.milling_dose / s.duration();
          v("milling_dose_rate", "W", "", i.dose_rate.half_width);
          if (s.milling_dose > 0)
            v("inverse_milling_dose_rate", "s/J", "",
                i.dose_rate.half_width / static_cast<double>(rate * rate));
          if (s.powder_mass)
            v("specific_milling_dose_rate", "W/kg", "",
                i.dose_rate.half_width / static_cast<double>(*s.powder_mass));
          v("wall_work_rate", "W", "", i.wall_work_rate.half_width);
          v.group("impact_rate", "", [&] {
            by_partner("1/s", [&](std::size_t k) { return i.impact_rates[k].half_width; });
            v("total", "1/s", "of all", i.impact_rate.half_width);
          });
          v("fast_impact_rate", "1/s", "", i.fast_impact_rate.half_width);
          v.group("milling_dose_rate_by_partner", "", [&] {
            by_partner("W", [&](std::size_t k) { return i.dose_rates[k].half_width; });
            v("total", "W", "of all", i.dose_rate.half_width);
          });
          v("milling_dose_rate_of_batches", "W", "dose rate of each batch, in the order of time",
              i.dose_rate.means);
          if (!i.several_states.empty())
            v("several_states", "",
                "why other seeds may settle in another state; absent if there is no sign of it",
                i.several_states);
        });
    v.group("warnings",
        "by kind, why the numbers may not be reliable: `too_few_collisions`, `too_short`, "
        "`transient`, `several_states`, `wide_interval`, `precision`, `supplied_energy`, "
        "`by_rule`, `stall_share`, `energy`, `end_reason`",
        [&] {
          for (const auto& warning : s.warnings) v(warning.kind, "", "", warning.text);
        });

    if (s.target)
      v.group(
          "target", "milling time to the target dose, if the case has `powder.target_dose`", [&] {
            v("dose", "J/kg", "target dose", s.target->dose);
            v("counts", "", "part of the dose that counts", s.target->counts);
            v("counted_dose_rate", "W", "", s.target->counted_dose_rate);
            if (s.intervals.any())
              v("counted_dose_rate_half_width", "W", "", s.intervals.counted_dose_rate.half_width);
            v("milling_time", "s", "time to the target dose; null if no dose counts",
                s.milling_time());
            if (const auto width = s.milling_time_half_width())
              v("milling_time_half_width", "s", "", *width);
          });
    if (s.collapse)
      v.group("inelastic_collapse", "the inelastic collapse, if the run ended in one", [&] {
        v("ball", "", "number of the ball", s.collapse->ball);
        v("partner_kind", "", "`wall` or `ball`", s.collapse->with_wall ? "wall" : "ball");
        v("partner", "", "number of the partner", s.collapse->partner);
        v("accumulation_time", "s", "time at which infinitely many impacts have happened",
            s.collapse->accumulation_time);
      });
    if (s.stall)
      v.group("stalled", "bodies that cannot separate, if the run ended because of them", [&] {
        v("time", "s", "simulated time at which the run stalled", s.stall->time);
        v("balls", "", "numbers of the balls", s.stall->balls);
        v("walls", "", "numbers of the walls", s.stall->walls);
        v("impacts", "1", "number of impacts of these bodies at that time", s.stall->impacts);
      });

    if (!s.notes.empty())
      v.group("notes",
          "numbers of further observers of every run "
          "([extending.md](extending.md#an-observer-of-every-run)); absent if there are none",
          [&] {
            for (const auto& [name, value] : s.notes) v(name, "", "", value);
          });
    v.group("escalations",
        "number of decisions passed to each wider scalar, and made by a rule (`rule`: "
        "[theory](theory.md), section 4)",
        [&] {
          for (const auto& e : s.escalations)
            v.group(e.scalar, "", [&] {
              v("wall", "1", "decisions about contacts with walls", e.wall);
              v("pair", "1", "decisions about contacts of balls", e.pair);
              v("order", "1", "decisions which of two contacts is first", e.order);
            });
        });
    v("simultaneous_contacts", "1",
        "impacts that a rule put before another contact of the ball at the same time "
        "([theory](theory.md), section 4)",
        s.simultaneous_contacts);
    v("deepest_overlap", "m", "deepest overlap of bodies, by rounding, in all impacts",
        s.deepest_overlap);
    v("impacts_since_start", "1", "number of impacts of the whole run", s.total_impacts);
    v("cpu_seconds", "s", "processor time of the whole run", s.cpu_seconds);
    v("collisions_per_cpu_second", "1/s", "impacts per second of processor time",
        ratio(number(s.total_impacts), s.cpu_seconds));
  }

  /// The amount over the time simulated; nothing when that is none.
  std::optional<Real> per_second(const Real& amount) const {
    return s.duration() > 0 ? std::optional<Real>(amount / s.duration()) : std::nullopt;
  }
  static double number(std::uint64_t count) { return static_cast<double>(count); }
  /// The share of a part in a whole; 0 if the whole is 0.
  template <class Number> static Number ratio(const Number& part, const Number& whole) {
    return whole > 0 ? Number(part / whole) : Number(0);
  }
  void visit_rates(const std::vector<std::uint64_t>& counts) {
    const auto rate = [&](std::uint64_t count) { return per_second(Real(number(count))); };
    by_partner("1/s", [&](std::size_t k) { return rate(counts[k]); });
    v("total", "1/s", "of all",
        rate(std::accumulate(counts.begin(), counts.end(), std::uint64_t{0})));
  }
  void visit_impacts(std::uint64_t count, const Real& dose) {
    v("impacts", "1", "number of impacts", count);
    v("impact_share", "1", "share of all impacts",
        ratio(number(count), number(s.total_collisions())));
    v("milling_dose", "J", "milling dose of these impacts", dose);
    v("milling_dose_share", "1", "share of the whole dose", ratio(dose, s.milling_dose));
  }
  void by_dose(const QuantilesByDose& energy) {
    v("median", "J", "impacts below it dissipate half of the dose of all impacts", energy.half);
    v("90_percent", "J", "impacts below it dissipate 90 % of the dose of all impacts",
        energy.ninety);
  }
  void by_partner(const char* unit, const auto& value_of) {
    for (int k = 0; k < s.partners.count(); ++k)
      v(s.partners[k].key, unit, s.partners[k].meaning, value_of(static_cast<std::size_t>(k)));
  }
};

struct FactsVisitor {
  Facts facts = Facts("the summary of the run");
  std::string path = {};  ///< of the group

  void operator()(std::string_view key, std::string_view, std::string_view, const auto& value) {
    facts.set(path + std::string(key), fact(value));
  }
  void group(std::string_view key, std::string_view, const auto& fill) {
    const auto outside = std::exchange(path, path + std::string(key) + "/");
    fill();
    path = outside;
  }
  template <class T> static Facts::Value fact(const T& value) {
    if constexpr (std::is_convertible_v<const T&, std::string_view>) {
      return std::string(std::string_view(value));
    } else if constexpr (std::is_same_v<T, bool> || std::is_same_v<T, Facts::Texts>) {
      return value;
    } else if constexpr (requires { *value; }) {
      return value ? fact(*value) : Facts::Value();
    } else if constexpr (requires { value.begin(); }) {
      return std::vector<double>(value.begin(), value.end());
    } else {
      return static_cast<double>(value);
    }
  }
};

/// For a visitor: all fields of a summary.
template <class Real> auto fields_of(const Summary<Real>& summary) {
  return [&](auto& visitor) {
    FieldList<Real, std::remove_reference_t<decltype(visitor)>>{summary, visitor}.visit();
  };
}

}  // namespace

template <class Real> Facts facts_of(const Summary<Real>& s) {
  FactsVisitor visitor;
  fields_of(s)(visitor);
  return visitor.facts;
}

std::string summary_reference() {
  Summary<double> s(model::Partners(
      std::vector<model::WallInfo>{{"", "and so on for every wall"}}));  // with every part
  s.provenance.right_digits = 0;
  s.error = "-";
  s.powder_mass = s.ball_mass = s.milling_dose = s.end_time = 1;
  s.intervals.batches = Intervals::fewest;
  s.intervals.impact_rates.resize(2);
  s.intervals.dose_rates.resize(2);
  s.intervals.several_states = "-";
  s.target = {1, "", 1};
  s.collapse.emplace();
  s.stall.emplace();
  s.notes = {{"NAME", 0}};
  s.escalations.push_back({"SCALAR", {}, {}, {}});
  return KeyTable::of(fields_of(s));
}

template <class Real> std::string stall_message(const Summary<Real>& s) {
  std::string bodies;
  const auto add = [&](const std::string& body) { bodies += (bodies.empty() ? "" : ", ") + body; };
  constexpr std::size_t most = 8;
  for (std::size_t k = 0; k < std::min(most, s.stall->balls.size()); ++k)
    add("ball " + std::to_string(s.stall->balls[k]));
  if (s.stall->balls.size() > most)
    add(std::to_string(s.stall->balls.size() - most) + " more balls");
  for (const int wall : s.stall->walls)
    add("wall " + std::to_string(wall) + " (" + s.partners[wall].label + ")");
  return "the run has stalled at " + to_text<Real>(s.stall->time) + " s: " + bodies +
      " hit each other " + std::to_string(s.stall->impacts) +
      " times while the simulated time did not advance, and no motion separates them; give them "
      "room (fewer or smaller balls, a piston that stops earlier), or end the run before";
}

template <class Real> std::string summary_json(const Summary<Real>& s) {
  return JsonFields::of(fields_of(s));
}

Intervals::Rate Intervals::of(std::vector<double> amounts, double length) {
  for (auto& amount : amounts) amount /= length;
  const double half_width = numerics::series_estimate(amounts).half_width.value_or(0);
  return {std::move(amounts), half_width};
}

#define EDMILL_SUMMARY(Real)                                      \
  template std::string summary_json<Real>(const Summary<Real>&);  \
  template std::string stall_message<Real>(const Summary<Real>&); \
  template Facts facts_of<Real>(const Summary<Real>&);
EDMILL_FOR_EACH_SCALAR(EDMILL_SUMMARY)

}  // namespace edmill::io
