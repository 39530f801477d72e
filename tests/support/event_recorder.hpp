// Keeps every impact of a run.
#pragma once

#include <vector>

#include "core.hpp"

namespace edmill::testing {

template <class Real> class EventRecorder : public engine::Observer<Real> {
 public:
  void on_impact(const engine::Impact<Real>& impact, engine::Simulation<Real>&) override {
    impacts.push_back(impact);
  }
  std::vector<engine::Impact<Real>> impacts;
};

/// The double state of a case in another scalar, digit for digit.
template <class Real>
std::vector<model::BallState<Real>> cast_states(
    const std::vector<model::BallState<double>>& states) {
  std::vector<model::BallState<Real>> out;
  for (const auto& s : states)
    out.push_back(
        {vector_cast<Real>(s.position), vector_cast<Real>(s.velocity), vector_cast<Real>(s.spin)});
  return out;
}

}  // namespace edmill::testing
