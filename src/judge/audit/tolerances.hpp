// Tolerances of an audit. docs/audit.md, "Tolerances"
#pragma once

#include <algorithm>
#include <cmath>

#include "logs/event_log.hpp"
#include "model/mill.hpp"

namespace edmill::audit {

using logs::rounding_of;

/// How fast walls, and what an impact takes from them, change with time: bounds of the mill.
struct WallRates {
  double speed = 0;         ///< of any point of the walls [m/s]
  double acceleration = 0;  ///< of any [m/s^2]
  double turning = 0;       ///< of the vessel [rad/s]

  static WallRates of(const model::Mill<double>& mill) {
    const auto& motion = mill.motion;
    const double vessel = mill.vessel.reach();
    // Some of the points within r of the centre move with r times the angular speed or faster.
    constexpr double far = 1e6;
    WallRates rates{motion.wall_speed(vessel), motion.acceleration_within(motion.reach(vessel)),
                    motion.wall_speed(far) / far};
    if (const auto* pistons = mill.vessel.pistons()) {
      rates.speed += pistons->bound(1);
      rates.acceleration += pistons->bound(2) + 2 * rates.turning * pistons->bound(1);
    }
    return rates;
  }
};

struct Tolerances {
  double relative = 1e-9;
  double gap = 0;      ///< between bodies in contact [m]
  double reach = 0;    ///< largest distance of a ball from the fulcrum [m]
  double gravity = 0;  ///< [m/s^2]
  WallRates walls;

  /// How far walls may be from where they are at the logged time [m].
  double wall_places(double t) const { return std::min(rounding_of(t) * walls.speed, 2 * reach); }
  double touch(double t, bool with_wall) const { return gap + (with_wall ? wall_places(t) : 0); }
  /// Tolerance of the end of a flight from an impact at an earlier time.
  double position(double t, double path, double speed) const {
    return relative * (reach + path) + 2 * rounding_of(t) * (speed + 2 * rounding_of(t) * gravity);
  }
  double velocity(double t, double speed) const { return relative * speed + 2 * rounding_of(t) * gravity; }

  /// What the uncertain wall adds to the difference of two relative velocities of an impact with it, each
  /// seen along its normal or across [m/s].
  /// @param scale  no velocity of the impact is larger; a relative one is at most three of them
  /// @param bend   angle by which the normal turns where the ball is moved in the vessel [1/m]
  double of_wall(double t, double scale, double bend, double radius) const {
    const double turned = walls.turning + walls.speed * bend;  // of the normal [rad/s]
    const double moved = walls.acceleration + walls.turning * (walls.speed + radius * turned);
    return 2 * (3 * scale * std::min(rounding_of(t) * turned, 2.0) +
                std::min(rounding_of(t) * moved, 2 * walls.speed));
  }
};

}  // namespace edmill::audit
