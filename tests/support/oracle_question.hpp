// The solver's question to the oracle, in the oracle's plain numbers.
#pragma once

#include "arb_oracle.hpp"
#include "dynamics/wall_search.hpp"
#include "mill_parts.hpp"

namespace edmill::testing {

/// @param overtime  see OracleQuestion [s]
inline OracleQuestion question_of(const model::Mill<double>& mill, const dynamics::WallQuery<double>& q,
                                  double overtime = 0) {
  return {testing::spex(mill).arm(),
          testing::spex(mill).theta_max(),
          testing::spex(mill).gamma_max(),
          mill.motion.period(),
          testing::cylinder(mill).radius,
          testing::cylinder(mill).half_height,
          {mill.gravity[0], mill.gravity[1], mill.gravity[2]},
          {q.flight.position[0], q.flight.position[1], q.flight.position[2]},
          {q.flight.velocity[0], q.flight.velocity[1], q.flight.velocity[2]},
          q.flight.start.period,
          q.flight.start.offset,
          q.radius,
          q.begin.period,
          q.begin.offset,
          q.length,
          overtime};
}

}  // namespace edmill::testing
