// A speed of a ball just after an impact.
#pragma once

#include "base/archive.hpp"
#include "base/vector.hpp"
#include "model/parts/parameter.hpp"

namespace edmill::model {

struct MaxBallSpeed {
  static constexpr Parameter key{"max_ball_speed", Dimension::speed,
                                 "the run ends when a ball is faster after an impact", Range::positive};

  template <class Real>
  struct Watch {
    Real limit;  ///< [m/s]

    bool is_met(const auto& impact, const auto& simulation) const {
      const auto too_fast = [&](int ball) {
        return squared_norm<Real>(simulation.flight(ball).velocity) > limit * limit;
      };
      return too_fast(impact.ball) || (!impact.with_wall && too_fast(impact.partner));
    }
    void archive(Archive&) {}
  };
};

}  // namespace edmill::model
