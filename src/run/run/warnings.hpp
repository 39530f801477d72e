// What of a run is not to be trusted, and why.
#pragma once

#include <string>
#include <vector>

#include "io/summary.hpp"

namespace edmill::run {

/// What the warnings follow from, in double for any scalar.
struct Measures {
  model::EndReason end_reason{};
  double collisions = 0;
  double touched_share = 0;     ///< of the dose, or of the impacts where there is no dose
  double stall_dose_share = 0;  ///< of the dose
  double supplied_share = 0, closure_share = 0;
  std::string energy_scale = "dose";  ///< of which these are shares
  bool has_dose = true;
  double by_rule_share = 0;                ///< of the impacts
  double duration = 0;                     ///< of the statistics [s]
  std::vector<double> dose_rates;          ///< of batches of the run [W]
  std::optional<double> wanted_precision;  ///< of the dose rate
};

std::vector<io::Warning> warnings_of(const Measures& of);

template <class Real>
Measures measures_of(const io::Summary<Real>& s) {
  const auto share = [](const Real& energy, const Real& of) {
    return of > 0 ? static_cast<double>(energy / of) : 0.0;
  };
  return {s.end_reason,
          static_cast<double>(s.total_collisions()),
          s.has_dose() ? share(s.touched_dose, s.milling_dose)
                       : share(Real(s.touched_impacts), Real(s.total_collisions())),
          share(s.stall_dose, s.milling_dose),
          share(s.supplied_energy, s.energy_scale()),
          share(s.energy_closure, s.energy_scale()),
          s.energy_scale_name(),
          s.has_dose(),
          s.total_impacts > 0
              ? static_cast<double>(s.simultaneous_contacts) / static_cast<double>(s.total_impacts)
              : 0.0,
          static_cast<double>(s.duration()),
          s.intervals.dose_rate.means,
          s.wanted_precision};
}

}  // namespace edmill::run
