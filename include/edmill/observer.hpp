// Interface for observers of a run.
#pragma once

#include "edmill/impact.hpp"

namespace edmill {

template <class Real> class Run;

/// Receives every impact just after it happened.
template <class Real> class Observer {
 public:
  virtual ~Observer() = default;
  /// @param impact  SI, inertial frame; the states of `run` are those after the impact
  /// @param run  at the time of the impact; `run.stop()` ends the run after it
  virtual void on_impact(const Impact<Real>& impact, Run<Real>& run) = 0;
};

}  // namespace edmill
