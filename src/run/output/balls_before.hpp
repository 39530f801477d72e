// Where the balls were just before an impact.
#pragma once

#include "output/output.hpp"

namespace edmill::output {

/// The balls at an instant between the last impact and the present one, whose bodies have collided already.
template <class Real>
class BallsBefore {
 public:
  explicit BallsBefore(const ImpactFacts<Real>& f) : facts_(f) {}

  /// @param time  not before the last impact, not after the present one [s]
  model::BallState<Real> state(int ball, const Real& time) const {
    const auto& f = facts_;
    const auto& s = f.simulation;
    const bool one = ball == f.impact.ball, two = !f.impact.with_wall && ball == f.impact.partner;
    if (!one && !two) return s.state_at(ball, s.clock().at(time));
    const auto& body = one ? f.one : f.two;
    const Real back = f.time - time;
    return {s.flight(ball).position - body.velocity_before * back + f.gravity * (back * back / 2),
            body.velocity_before - f.gravity * back, body.spin_before};
  }

 private:
  const ImpactFacts<Real>& facts_;
};

}  // namespace edmill::output
