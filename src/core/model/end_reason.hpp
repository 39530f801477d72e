// Why a run ended.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "model/stop_rules.hpp"

namespace edmill::model {

enum class EndReason {
  end_time,
  max_cpu_time,        ///< of a run in a study
  inelastic_collapse,  ///< a Zeno point of the exact model
  stalled,             ///< the clock stands still: no motion separates bodies that are pressed together
  undecided,           ///< no scalar could make a decision
  interrupted,
  stopped,         ///< by an observer
  paused,          ///< an observer wants something done between two events; the run goes on
  first_stop_rule  ///< and so on, in the order of StopRuleList
};

/// The reason of an end by the rule at this place of StopRuleList.
inline constexpr EndReason reason_of_rule(std::size_t place) {
  return static_cast<EndReason>(static_cast<std::size_t>(EndReason::first_stop_rule) + place);
}

/// By their numbers.
inline constexpr auto end_reason_names = [] {
  std::array<std::string_view, static_cast<std::size_t>(EndReason::first_stop_rule) + stop_rule_count> names{
      "end_time", "max_cpu_time", "inelastic_collapse", "stalled", "undecided", "interrupted",
      "stopped",  "paused"};
  for_each_stop_rule([&](auto rule, std::size_t place) {
    names[static_cast<std::size_t>(reason_of_rule(place))] = rule.key.key;
  });
  return names;
}();

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
