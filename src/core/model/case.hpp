// A case: everything that a run depends on, as plain SI values of one scalar.
#pragma once

#include <optional>
#include <vector>

#include "base/instant.hpp"
#include "model/ball.hpp"
#include "model/mill.hpp"
#include "model/stop_rules.hpp"

namespace edmill::model {

/// Which part of the dose counts. Gentle impacts may not work the powder (thesis, section 6), so
/// counting can be restricted to doses from a limit on, and to the part along the normal.
template <class Number> struct CountedDose {
  bool normal_only = false;
  Number least{0};  ///< smallest dose of an impact, or of its normal part, that counts [J]

  bool all() const { return !normal_only && !(least > 0); }
  /// @param outcome  of an impact  @return [J]
  Number of(const auto& outcome) const {
    const Number& dose = normal_only ? outcome.normal_dose : outcome.milling_dose;
    return dose < least ? Number(0) : dose;
  }
};

/// The first rule that is met ends the run; at least one is set.
template <class Real> struct StopRules {
  std::optional<Instant<Real>> end_time;
  StopLimits<Real> limits;
};

template <class Real> struct Case {
  Mill<Real> mill;
  std::vector<BallProperties<Real>> balls;
  StopRules<Real> stop;
  Instant<Real> initial_time;      ///< of the initial state
  Instant<Real> statistics_start;  ///< statistics count from here on
  CountedDose<Real> counted_dose;  ///< toward the target dose
};

}  // namespace edmill::model
