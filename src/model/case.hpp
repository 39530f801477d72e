// A case: everything that a run depends on, as plain SI values of one scalar.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/instant.hpp"
#include "base/vector.hpp"
#include "model/ball.hpp"
#include "model/counted_dose.hpp"
#include "model/mill.hpp"
#include "model/stop_rules.hpp"

namespace edmill::model {

/// The first rule that is met ends the run; at least one is set.
template <class Real>
struct StopRules {
  std::optional<Instant<Real>> end_time;
  StopLimits<Real> limits;
};

template <class Real>
struct Case {
  Mill<Real> mill;
  std::vector<BallProperties<Real>> balls;
  StopRules<Real> stop;
  Instant<Real> initial_time;      ///< of the initial state
  Instant<Real> statistics_start;  ///< statistics count from here on
  CountedDose<Real> counted_dose;  ///< toward the target dose
};

}  // namespace edmill::model
