// A case: everything that a run depends on, as plain SI values of one scalar.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/instant.hpp"
#include "base/vector.hpp"
#include "model/ball.hpp"
#include "model/contact_law.hpp"
#include "model/mill_motion.hpp"
#include "model/vessel.hpp"

namespace edmill::model {

/// The first rule that is met ends the run; at least one is set.
template <class Real>
struct StopRules {
  std::optional<Instant<Real>> end_time;
  std::optional<std::uint64_t> max_collisions;
  std::optional<Real> max_milling_dose;  ///< [J] since the start of the run
  std::optional<Real> max_ball_speed;    ///< [m/s] of a ball just after an impact
};

/// Where a vessel of this kind is filled: the physical model without the balls' states.
template <class Real>
struct Mill {
  MillMotion<Real> motion;
  CylinderVessel<Real> vessel;
  Vec3<Real> gravity;  ///< [m/s^2]
  ContactLaw<Real> ball_ball;
  ContactLaw<Real> ball_wall;
};

/// The mill in another scalar: exact when that is wider, rounded otherwise.
template <class To, class From>
Mill<To> mill_cast(const Mill<From>& m) {
  const auto law = [](const ContactLaw<From>& l) {
    return convert_law<To>(l, [](const From& x) { return static_cast<To>(x); });
  };
  return {{static_cast<To>(m.motion.arm), static_cast<To>(m.motion.theta_max),
           static_cast<To>(m.motion.gamma_max), static_cast<To>(m.motion.period)},
          {static_cast<To>(m.vessel.radius), static_cast<To>(m.vessel.half_height)},
          vector_cast<To>(m.gravity),
          law(m.ball_ball),
          law(m.ball_wall)};
}

template <class Real>
struct Case {
  Mill<Real> mill;
  std::vector<BallProperties<Real>> balls;
  StopRules<Real> stop;
  Instant<Real> initial_time;      ///< of the initial state
  Instant<Real> statistics_start;  ///< statistics count from here on
};

}  // namespace edmill::model
