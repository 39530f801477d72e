// The rules beside the end time that can end a run.
#pragma once

#include <array>
#include <optional>
#include <tuple>
#include <utility>

#include "model/stop_rules/dose_rate_precision.hpp"
#include "model/stop_rules/max_ball_speed.hpp"
#include "model/stop_rules/max_collisions.hpp"
#include "model/stop_rules/max_milling_dose.hpp"

namespace edmill::model {

/// A rule has a key of [run], whose value is its limit and whose name is the reason of the end, and a Watch:
/// the limit in the run's scalar, `is_met(impact, simulation)` after each impact, `archive` of what changes,
/// and `begin(case)` where it needs the case. A new one is a file in model/stop_rules/ and a line here.
using StopRuleList = std::tuple<MaxCollisions, MaxMillingDose, MaxBallSpeed, DoseRatePrecision>;

inline constexpr std::size_t stop_rule_count = std::tuple_size_v<StopRuleList>;

/// Calls f(rule, its place in the list) for each.
constexpr void for_each_stop_rule(auto&& f) {
  [&]<std::size_t... place>(std::index_sequence<place...>) {
    (f(std::tuple_element_t<place, StopRuleList>{}, place), ...);
  }
  (std::make_index_sequence<stop_rule_count>{});
}

/// Limits in the order of the list, of the rules that are in force.
template <class Number>
using StopLimits = std::array<std::optional<Number>, stop_rule_count>;

/// The place of a rule in the list.
template <class Rule>
inline constexpr std::size_t place_of_rule = [] {
  std::size_t found = stop_rule_count;
  for_each_stop_rule([&]<class Each>(Each, std::size_t place) {
    if (std::is_same_v<Each, Rule>) found = place;
  });
  return found;
}();

}  // namespace edmill::model
