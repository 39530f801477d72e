// Plain values that describe how a run went, and why it ended.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/archive.hpp"
#include "model/ball.hpp"
#include "model/stop_rules.hpp"

namespace edmill::model {

/// Why a run ended.
enum class EndReason {
  end_time,
  max_cpu_time,        ///< of a run in a study
  inelastic_collapse,  ///< a Zeno point of the exact model
  stalled,    ///< time no longer advances: no motion separates bodies that are pressed together
  undecided,  ///< no scalar could make a decision
  interrupted,
  stopped,         ///< by an observer
  paused,          ///< an observer asked for a pause between two events; the run can continue
  first_stop_rule  ///< and so on, in the order of StopRuleList
};

/// The end reason for the stop rule at this place of StopRuleList.
inline constexpr EndReason reason_of_rule(std::size_t place) {
  return static_cast<EndReason>(static_cast<std::size_t>(EndReason::first_stop_rule) + place);
}

/// Names of the end reasons, by their numbers.
inline constexpr auto end_reason_names = [] {
  std::array<std::string_view,
      static_cast<std::size_t>(EndReason::first_stop_rule) + stop_rule_count>
      names{"end_time", "max_cpu_time", "inelastic_collapse", "stalled", "undecided", "interrupted",
          "stopped", "paused"};
  for_each_stop_rule([&](auto rule, std::size_t place) {
    names[static_cast<std::size_t>(reason_of_rule(place))] = rule.key.key;
  });
  return names;
}();

/// The name of an end reason, as in `summary.json`.
inline constexpr std::string_view name(EndReason reason) {
  return end_reason_names[static_cast<std::size_t>(reason)];
}
inline constexpr std::optional<EndReason> end_reason_named(std::string_view name) {
  for (std::size_t k = 0; k < end_reason_names.size(); ++k)
    if (end_reason_names[k] == name) return static_cast<EndReason>(k);
  return std::nullopt;
}

/// Mechanical energy of all balls [J].
template <class Real> struct Energy {
  Real kinetic{0};    ///< translation and spin
  Real potential{0};  ///< -m g.r

  void archive(Archive& a) { a(kinetic, potential); }
  Energy& operator+=(const Energy& other) {
    kinetic += other.kinetic;
    potential += other.potential;
    return *this;
  }
};

/// The energy of one ball.
template <class Real>
Energy<Real> energy_of(
    const BallProperties<Real>& ball, const BallState<Real>& state, const Vec3<Real>& gravity) {
  const Real inertia = ball.reduced_inertia * ball.mass * ball.radius * ball.radius;
  return {ball.mass / 2 * squared_norm<Real>(state.velocity) +
          inertia / 2 * squared_norm<Real>(state.spin),
      -(ball.mass * dot<Real>(gravity, state.position))};
}

/// The energy of all balls.
template <class Real>
Energy<Real> energy_of(const std::vector<BallProperties<Real>>& balls,
    const std::vector<BallState<Real>>& states, const Vec3<Real>& gravity) {
  Energy<Real> total;
  for (std::size_t k = 0; k < balls.size(); ++k)
    total += energy_of<Real>(balls[k], states[k], gravity);
  return total;
}

/// Why a run could not continue: the exact model has a Zeno point at this time. (docs/theory.md,
/// section 6)
template <class Real> struct InelasticCollapse {
  int ball = -1;
  bool with_wall = false;
  int partner = -1;
  Real accumulation_time{};  ///< when the impacts accumulate [s]
};

/// Why a run could not continue: its clock no longer advanced. (docs/theory.md, section 6)
template <class Real> struct Stall {
  Real time{};                    ///< [s]
  std::vector<int> balls, walls;  ///< that hit each other at this instant, by id
  std::uint64_t impacts = 0;      ///< lower bound on the number of their impacts

  void archive(Archive& a) { a(time, balls, walls, impacts); }
};

/// Numbers of decisions that were passed to one wider scalar.
struct Escalations {
  std::string scalar;
  std::uint64_t wall = 0;
  std::uint64_t pair = 0;
  std::uint64_t order = 0;  ///< which of two contacts of one ball comes first

  void archive(Archive& a) { a(scalar, wall, pair, order); }
};

}  // namespace edmill::model
