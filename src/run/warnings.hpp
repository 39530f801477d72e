// What of a run is not to be trusted, and why.
#pragma once

#include <vector>

#include "io/summary.hpp"

namespace edmill::run {

/// What the warnings follow from, in double for any scalar.
struct Measures {
  model::EndReason end_reason{};
  double collisions = 0;
  double touched_dose_share = 0, stall_dose_share = 0;  ///< of the dose; without a dose, of the impacts
  bool has_dose = true;
  double supplied_share = 0, closure_share = 0;  ///< of io::Summary::energy_scale
  double by_rule_share = 0;                      ///< of the impacts
  double duration = 0;                           ///< of the statistics [s]
  std::vector<double> dose_rates;                ///< of batches of the run [W]
  std::optional<double> wanted_precision;        ///< of the dose rate
};

std::vector<io::Warning> warnings_of(const Measures& of);

template <class Real>
Measures measures_of(const io::Summary<Real>& s) {
  const auto part = [](const auto& some, const auto& all) {
    return all > 0 ? static_cast<double>(some) / static_cast<double>(all) : 0.0;
  };
  const bool has_dose = s.milling_dose > 0;
  const auto share = [&](const Real& dose, std::uint64_t impacts) {
    return has_dose ? part(dose, s.milling_dose) : part(impacts, s.total_collisions());
  };
  return {.end_reason = s.end_reason,
          .collisions = static_cast<double>(s.total_collisions()),
          .touched_dose_share = share(s.touched_dose, s.touched_impacts),
          .stall_dose_share = share(s.stall_dose, s.stall_impacts),
          .has_dose = has_dose,
          .supplied_share = part(s.supplied_energy, s.energy_scale()),
          .closure_share = part(s.energy_closure(), s.energy_scale()),
          .by_rule_share = part(s.simultaneous_contacts, s.total_impacts),
          .duration = static_cast<double>(s.duration()),
          .dose_rates = s.intervals.dose_rate.means,
          .wanted_precision = s.wanted_precision};
}

}  // namespace edmill::run
