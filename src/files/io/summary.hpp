// summary.json: the result of a run. Its fields, units and meanings are listed in summary.cpp.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/facts.hpp"
#include "model/outcome.hpp"
#include "model/parts/partners.hpp"

namespace edmill::io {

/// The origin of a run: case, settings and program.
struct Provenance {
  std::string case_file, case_digest;
  std::vector<std::string> settings;  ///< over the case file
  bool reported = false;              ///< with the outputs of the report
  std::string precision, version, commit, compiler;
  std::uint64_t seed = 0;
  std::optional<std::uint64_t> right_digits;  ///< to the end, where digits were asked for
};

/// 95 % intervals of the rates of one run, from batches of whole drive periods. Half-widths in the
/// units of the rates; none where the statistics have too few batches. Impacts are collisions that
/// the least separation speed does not decide: contacts at rest come in bursts.
struct Intervals {
  static constexpr std::size_t fewest = 5;
  static constexpr int fast =
      1;  ///< approach speed beyond which impacts are counted by themselves [m/s]

  /// A rate in each batch, and the half-width of its mean.
  struct Rate {
    std::vector<double> means;
    double half_width = 0;
  };
  static Rate of(std::vector<double> amounts, double length);

  std::size_t batches = 0;
  double batch_length = 0;                     ///< [s]
  std::vector<Rate> impact_rates, dose_rates;  ///< with each partner
  Rate impact_rate, fast_impact_rate, dose_rate, wall_work_rate, counted_dose_rate;
  std::string several_states;  ///< why other seeds may settle elsewhere; mostly empty

  bool any() const { return batches >= fewest; }
};

/// Energies below which impacts, not at rest, dissipate half and 90 % of the dose of all [J].
struct QuantilesByDose {
  std::optional<double> half, ninety;
};

/// A reason to doubt a number of a run.
struct Warning {
  std::string kind;  ///< "transient"
  std::string text;
};

/// The target dose, and the rate from which the milling time follows.
template <class Real> struct TargetDose {
  Real dose;               ///< wanted [J/kg]
  std::string counts;      ///< the part of the dose that counts, for readers
  Real counted_dose_rate;  ///< [W]
};

template <class Real> struct Summary {
  Provenance provenance;
  model::EndReason end_reason{};
  std::string error;                ///< of a decision that no scalar could make, or of a stall
  Real start_time{0}, end_time{0};  ///< of the statistics [s]
  Real period{0};                   ///< of the drive [s]
  model::Partners partners;
  std::vector<std::uint64_t> collisions;  ///< with each partner
  std::vector<std::uint64_t> impacts;     ///< of these, not at rest
  std::uint64_t fast_impacts = 0;         ///< above `Intervals::fast`
  Real speed_by_dose{0};  ///< of impacts, approach speed times dose, their sum [J m/s]
  QuantilesByDose impact_energy, dissipated_energy;
  std::vector<Real> dose_by_partner;   ///< [J]
  Real milling_dose{0}, wall_work{0};  ///< [J]
  model::Energy<Real> energy_at_start, energy_at_end;
  /// sum WE - sum MD + supplied energy - change of (KE + PE) [J]; zero up to rounding.
  Real energy_closure{0};
  std::uint64_t touched_impacts = 0;  ///< by the least separation speed (theory.md, section 6)
  Real touched_dose{0};               ///< of these impacts [J]
  Real supplied_energy{0};            ///< by these impacts [J]
  std::uint64_t stall_impacts = 0;    ///< without friction, since a ball was in a stall
  Real stall_dose{0};                 ///< of these impacts [J]
  std::optional<model::InelasticCollapse<Real>> collapse;
  std::optional<model::Stall<Real>> stall;
  std::vector<model::Escalations> escalations;
  std::optional<Real> powder_mass, ball_mass;
  std::uint64_t simultaneous_contacts = 0;  ///< of one ball at times that no scalar could separate
  Real deepest_overlap{0};                  ///< by rounding, at any impact [m]
  double cpu_seconds = 0;
  std::uint64_t total_impacts = 0;                  ///< since the start of the run
  std::vector<std::pair<std::string, Real>> notes;  ///< of observers (EveryRunList)
  Intervals intervals;
  std::vector<Warning> warnings;
  std::optional<double> wanted_precision;  ///< of the dose rate, relative
  std::optional<TargetDose<Real>> target;

  /// Milling time to the target dose [s]; nothing without one, or without a dose that counts.
  std::optional<Real> milling_time() const {
    if (!target || !powder_mass || !(target->counted_dose_rate > 0)) return std::nullopt;
    return Real(target->dose * *powder_mass / target->counted_dose_rate);
  }
  /// Half-width of its 95 % interval [s].
  std::optional<double> milling_time_half_width() const {
    const auto time = milling_time();
    if (!time || !intervals.any()) return std::nullopt;
    return static_cast<double>(*time) * intervals.counted_dose_rate.half_width /
        static_cast<double>(target->counted_dose_rate);
  }

  explicit Summary(const model::Partners& of = model::Partners())
      : partners(of), collisions(of.count()), impacts(of.count()),
        dose_by_partner(of.count(), Real(0)) {}

  Real duration() const { return end_time - start_time; }
  std::uint64_t total_collisions() const {
    return std::accumulate(collisions.begin(), collisions.end(), std::uint64_t{0});
  }
  /// Reference for supplied energy and closure [J]: the dose, or the larger kinetic energy of
  /// either end.
  Real energy_scale() const {
    return std::max({milling_dose, energy_at_start.kinetic, energy_at_end.kinetic});
  }
};

/// The fields of summary.json.
template <class Real> Facts facts_of(const Summary<Real>& summary);
/// @throws InputError when the field is absent or not an end reason
inline model::EndReason end_reason_of(const Facts& f) {
  constexpr const char *key = "end_reason", *expected = "why the run ended";
  const auto reason = model::end_reason_named(f.text(key, expected));
  if (!reason) throw f.wrong(key, expected);
  return *reason;
}
/// Kinetic energy of all balls at the begin or the end of the record, whichever is larger [J].
inline double kinetic_energy_of(const Facts& f) {
  return std::max(f.number("energy/kinetic_start"), f.number("energy/kinetic_end"));
}
/// Name of the reference for the shares of supplied energy and closure: "dose" or "kinetic energy".
inline const char* energy_scale_of(const Facts& f) {
  return f.number("milling_dose") < kinetic_energy_of(f) ? "kinetic energy" : "dose";
}
/// False if the dose consists of rounding errors only, as with elastic impacts.
inline bool has_dose(const Facts& f) {
  const double dose = f.number("milling_dose");
  return dose * 1e9 > std::max(dose, kinetic_energy_of(f));
}

/// Message about a stall: its time, the bodies, and how to avoid it.
template <class Real> std::string stall_message(const Summary<Real>& summary);

template <class Real> std::string summary_json(const Summary<Real>& summary);

/// The keys of summary.json, their units and meanings, as a table of Markdown.
std::string summary_reference();

}  // namespace edmill::io
