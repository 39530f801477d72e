// Stop rules other than the end time. A new rule is a branch here and a key in casefile/case_spec.cpp.
#pragma once

#include "base/compensated_sum.hpp"
#include "engine/simulation.hpp"

namespace edmill::run {

template <class Real>
class StopRuleWatch : public engine::Observer<Real> {
 public:
  explicit StopRuleWatch(const model::StopRules<Real>& rules) : rules_(rules) {}

  void on_impact(const engine::Impact<Real>& impact, engine::Simulation<Real>& simulation) override {
    using engine::EndReason;
    if (rules_.max_collisions && impact.index + 1 >= *rules_.max_collisions)
      simulation.request_stop(EndReason::max_collisions);
    if (rules_.max_milling_dose) {
      dose_ += impact.outcome.milling_dose;
      if (dose_.value() >= *rules_.max_milling_dose) simulation.request_stop(EndReason::max_milling_dose);
    }
    if (rules_.max_ball_speed) {
      const Real limit = *rules_.max_ball_speed * *rules_.max_ball_speed;
      const auto too_fast = [&](int ball) {
        return squared_norm<Real>(simulation.flight(ball).velocity) > limit;
      };
      if (too_fast(impact.ball) || (!impact.with_wall && too_fast(impact.partner)))
        simulation.request_stop(EndReason::max_ball_speed);
    }
  }
  void archive(Archive& a) override { a(dose_); }

 private:
  model::StopRules<Real> rules_;
  numerics::CompensatedSum<Real> dose_;
};

}  // namespace edmill::run
