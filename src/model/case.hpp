// A case: everything that a run depends on, as plain SI values of one scalar.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/instant.hpp"
#include "base/vector.hpp"
#include "model/ball.hpp"
#include "model/mill.hpp"

namespace edmill::model {

/// The first rule that is met ends the run; at least one is set.
template <class Real>
struct StopRules {
  std::optional<Instant<Real>> end_time;
  std::optional<std::uint64_t> max_collisions;
  std::optional<Real> max_milling_dose;  ///< [J] since the start of the run
  std::optional<Real> max_ball_speed;    ///< [m/s] of a ball just after an impact
};

template <class Real>
struct Case {
  Mill<Real> mill;
  std::vector<BallProperties<Real>> balls;
  StopRules<Real> stop;
  Instant<Real> initial_time;      ///< of the initial state
  Instant<Real> statistics_start;  ///< statistics count from here on
};

}  // namespace edmill::model
