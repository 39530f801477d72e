// Why a run ended.
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace edmill::model {

enum class EndReason {
  end_time,
  max_collisions,
  max_milling_dose,
  max_ball_speed,
  max_cpu_time,        ///< of a run in a study
  inelastic_collapse,  ///< a Zeno point of the exact model
  stalled,             ///< the clock stands still: no motion parts bodies that are pressed together
  undecided,           ///< no scalar could make a decision
  interrupted,
  stopped,  ///< by an observer
  paused,   ///< an observer wants something done between two events; the run goes on
};

inline constexpr std::array<std::string_view, 11> end_reason_names = {
    "end_time", "max_collisions", "max_milling_dose", "max_ball_speed", "max_cpu_time", "inelastic_collapse",
    "stalled",  "undecided",      "interrupted",      "stopped",        "paused"};

/// As in `summary.json`.
inline constexpr std::string_view name(EndReason reason) {
  return end_reason_names[static_cast<std::size_t>(reason)];
}
inline constexpr std::optional<EndReason> end_reason_named(std::string_view name) {
  for (std::size_t k = 0; k < end_reason_names.size(); ++k)
    if (end_reason_names[k] == name) return static_cast<EndReason>(k);
  return std::nullopt;
}

}  // namespace edmill::model
