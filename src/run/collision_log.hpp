// The text of collisions.csv: one line for each impact.
#pragma once

#include <string>

#include "base/scalar.hpp"
#include "engine/simulation.hpp"

namespace edmill::run {

/// SI; balls and impacts count from 0; every number has enough digits to round-trip in its scalar.
inline constexpr const char* collision_log_header =
    "index,time,ball,partner_kind,partner,approach_speed,slip_speed,milling_dose,wall_work";

/// What `states = true` adds: for the ball and for its partner position, velocity and spin before, velocity
/// and spin after the impact, in the inertial frame [m, m/s, rad/s]. Those of a wall are empty.
inline constexpr const char* collision_log_states =
    ",x,y,z,vx_before,vy_before,vz_before,wx_before,wy_before,wz_before"
    ",vx_after,vy_after,vz_after,wx_after,wy_after,wz_after"
    ",partner_x,partner_y,partner_z,partner_vx_before,partner_vy_before,partner_vz_before"
    ",partner_wx_before,partner_wy_before,partner_wz_before,partner_vx_after,partner_vy_after,partner_vz_"
    "after"
    ",partner_wx_after,partner_wy_after,partner_wz_after";

/// One impact as a line of the log.
/// @param states  with the bodies' states before and after
template <class Real>
std::string collision_line(const engine::Impact<Real>& impact, const engine::Simulation<Real>& simulation,
                           bool states) {
  const auto states_of = [&](int body) {
    const int ball = body == 0 ? impact.ball : impact.partner;
    const auto& flight = simulation.flight(ball);
    std::string text;
    for (const Vec3<Real>* vector : {&flight.position, &impact.velocity_before[body],
                                     &impact.spin_before[body], &flight.velocity, &simulation.spin(ball)})
      for (int axis = 0; axis < 3; ++axis) text += "," + to_text<Real>((*vector)[axis]);
    return text;
  };
  const auto& o = impact.outcome;
  std::string line =
      std::to_string(impact.index) + "," + to_text<Real>(simulation.clock().seconds(impact.time)) + "," +
      std::to_string(impact.ball) + (impact.with_wall ? ",wall," : ",ball,") + std::to_string(impact.partner);
  for (const Real* value : {&o.approach_speed, &o.slip_speed, &o.milling_dose, &o.wall_work})
    line += "," + to_text<Real>(*value);
  if (states) line += states_of(0) + (impact.with_wall ? std::string(15, ',') : states_of(1));
  return line;
}

}  // namespace edmill::run
