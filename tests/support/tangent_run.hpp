// A run in double with what its observers of nearby motions need.
#pragma once

#include <functional>

#include "core.hpp"
#include "tangent/spectrum.hpp"

namespace edmill::testing {

/// Calls f(at, bodies, impact) for each of the first impacts.
class TangentObserver : public engine::Observer<double> {
 public:
  using Call = std::function<void(
      const tangent::ImpactAt&, const tangent::Struck (&)[2], const engine::Impact<double>&)>;

  TangentObserver(std::size_t impacts, Call call) : left_(impacts), call_(std::move(call)) {}

  void on_impact(
      const engine::Impact<double>& impact, engine::Simulation<double>& simulation) override {
    tangent::Struck bodies[2];
    const auto fill = [&](int place, int ball) {
      const auto& flight = simulation.flight(ball);
      bodies[place] = {ball, flight.position, impact.velocity_before[place],
          impact.spin_before[place], flight.velocity};
    };
    fill(0, impact.ball);
    if (!impact.with_wall) fill(1, impact.partner);
    call_({impact.time, impact.normal, impact.outcome.approach_speed, impact.outcome.in_stall},
        bodies, impact);
    if (--left_ == 0) simulation.request_stop(engine::EndReason::stopped);
  }
 private:
  std::size_t left_;
  Call call_;
};

}  // namespace edmill::testing
