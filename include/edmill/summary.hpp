// What a run came to.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace edmill {

/// From the start of statistics on. Keys of `json` and their meaning: docs/files.md.
template <class Real>
struct Summary {
  Real start_time{}, end_time{};          ///< of the statistics [s]
  std::vector<std::string> partners;      ///< what balls collide with: the walls by id, then "ball_ball"
  std::vector<std::uint64_t> collisions;  ///< with each of them
  std::vector<Real> dose_by_partner;      ///< [J]
  Real milling_dose{}, wall_work{}, supplied_energy{};  ///< [J]
  Real energy_closure{};                                ///< energy that is not accounted for [J]
  std::uint64_t simultaneous_contacts = 0;  ///< of one ball at times that no scalar could tell apart
  double cpu_seconds = 0;
  std::string end_reason;  ///< "end_time", "max_collisions", ...; "paused" while the run can go on
  std::string json;        ///< as in summary.json
  /// Of the 95 % interval of the milling dose rate [W]; nothing where the run is too short for one.
  std::optional<double> milling_dose_rate_half_width;
  std::optional<Real> milling_time;   ///< to the case's target dose, where it has one [s]
  std::vector<std::string> warnings;  ///< why numbers are not to be trusted, for readers

  Real milling_dose_rate() const { return milling_dose / (end_time - start_time); }  ///< [W]
};

}  // namespace edmill
