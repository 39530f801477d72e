// Interface for observers inside edmill, and the impacts that they receive.
#pragma once

#include <cstdint>

#include "base/instant.hpp"
#include "dynamics/impulse.hpp"

namespace edmill::engine {

template <class Real> class Simulation;

/// One impact as observers of edmill itself get it; programs get `edmill::Impact`.
template <class Real> struct Impact {
  std::uint64_t index;  ///< counts from 0 since the start of the run
  Instant<Real> time;
  int ball;
  bool with_wall;
  int partner;  ///< ball or wall id
  dynamics::ImpactOutcome<Real> outcome;
  bool by_rule;  ///< another contact of its ball is at the same time: a rule put it first
  Real overlap;  ///< how deep the bodies overlap by rounding at the impact [m]; negative for a gap
  Vec3<Real> normal;              ///< unit, from the partner to the ball
  Vec3<Real> velocity_before[2];  ///< of the ball and, for balls, the partner [m/s]
  Vec3<Real> spin_before[2];      ///< [rad/s]
  Real flight_time[2];            ///< since the body's last impact, or the start of the run [s]
  Vec3<Real> wall_velocity;       ///< of the wall at the contact point; unused between balls [m/s]
};

template <class Real> class Observer {
 public:
  virtual ~Observer() = default;
  virtual void on_impact(const Impact<Real>& impact, Simulation<Real>& simulation) = 0;
  /// Saves or loads its state, for a checkpoint.
  virtual void archive(Archive&) {}
};

}  // namespace edmill::engine
