// The results of a run.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace edmill {

/// Results since the start of statistics. The keys of `json` are documented in docs/files.md.
template <class Real> struct Summary {
  Real start_time{}, end_time{};  ///< of the statistics [s]
  std::vector<std::string>
      partners;  ///< partners of a collision: the walls by id, then "ball_ball"
  std::vector<std::uint64_t> collisions;                ///< with each of them
  std::vector<Real> dose_by_partner;                    ///< [J]
  Real milling_dose{}, wall_work{}, supplied_energy{};  ///< [J]
  Real energy_closure{};                                ///< energy that is not accounted for [J]
  std::uint64_t simultaneous_contacts =
      0;  ///< contacts of one ball whose times no scalar could separate
  double cpu_seconds = 0;
  std::string
      end_reason;    ///< "end_time", "max_collisions", ...; "paused" while the run can be continued
  std::string json;  ///< as in summary.json
  /// Half-width of the 95 % interval of the milling dose rate [W]; empty if the run is too short
  /// for one.
  std::optional<double> milling_dose_rate_half_width;
  std::optional<Real> milling_time;   ///< to reach the target dose, if the case has one [s]
  std::vector<std::string> warnings;  ///< reasons to distrust the results, as sentences

  Real milling_dose_rate() const { return milling_dose / (end_time - start_time); }  ///< [W]
};

}  // namespace edmill
