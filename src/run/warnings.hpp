// What of a run is not to be trusted, and why.
#pragma once

#include <vector>

#include "io/summary.hpp"

namespace edmill::run {

/// What the warnings follow from, in double for any scalar.
struct Measures {
  model::EndReason end_reason{};
  double collisions = 0;
  double touched_dose_share = 0, supplied_share = 0, stall_dose_share = 0,
         closure_share = 0;                ///< of the dose
  double duration = 0;                     ///< of the statistics [s]
  std::vector<double> dose_rates;          ///< of batches of the run [W]
  std::optional<double> wanted_precision;  ///< of the dose rate
};

std::vector<io::Warning> warnings_of(const Measures& of);

template <class Real>
Measures measures_of(const io::Summary<Real>& s) {
  const auto share = [&](const Real& energy) {
    return s.milling_dose > 0 ? static_cast<double>(energy / s.milling_dose) : 0.0;
  };
  return {s.end_reason,
          static_cast<double>(s.total_collisions()),
          share(s.touched_dose),
          share(s.supplied_energy),
          share(s.stall_dose),
          share(s.energy_closure()),
          static_cast<double>(s.duration()),
          s.intervals.dose_rate.means,
          s.wanted_precision};
}

}  // namespace edmill::run
