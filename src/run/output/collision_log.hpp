// The text of collisions.csv: one line for each impact.
#pragma once

#include <string>

#include "base/scalar.hpp"
#include "engine/simulation.hpp"
#include "model/impact_record.hpp"

namespace edmill::output {

/// @param states  adds columns with position, velocity and spin before the impact, and velocity and
/// spin after it, of the ball and of its partner, in the inertial frame; those of a wall are empty
inline std::string collision_log_header(bool states) {
  std::string header = "index,time,ball,partner_kind,partner";
  for (const auto& quantity : model::logged_quantities)
    if (quantity.name != "time") header += "," + std::string(quantity.name);
  if (states) model::for_logged_vectors([&](const std::string& name) { header += "," + name; });
  return header;
}

template <class Real>
model::ImpactRecord<Real> record_of(
    const engine::Impact<Real>& impact, const engine::Simulation<Real>& simulation) {
  const auto& o = impact.outcome;
  return {.ball = impact.ball,
      .with_wall = impact.with_wall,
      .partner = impact.partner,
      .time = simulation.clock().seconds(impact.time),
      .approach_speed = o.approach_speed,
      .slip_speed = o.slip_speed,
      .milling_dose = o.milling_dose,
      .wall_work = o.wall_work,
      .by_rule = impact.by_rule};
}

/// One impact as a line of the log: SI; balls and impacts count from 0; every number has enough
/// digits to round-trip in its scalar.
/// @param states  adds the bodies' states before and after
template <class Real>
std::string collision_line(
    const engine::Impact<Real>& impact, const engine::Simulation<Real>& simulation, bool states) {
  const auto states_of = [&](int body) {
    const int ball = body == 0 ? impact.ball : impact.partner;
    const auto& flight = simulation.flight(ball);
    std::string text;
    for (const Vec3<Real>* vector : {&flight.position, &impact.velocity_before[body],
             &impact.spin_before[body], &flight.velocity, &simulation.spin(ball)})
      for (int axis = 0; axis < 3; ++axis) text += "," + to_text<Real>((*vector)[axis]);
    return text;
  };
  const auto record = record_of<Real>(impact, simulation);
  std::string line = std::to_string(impact.index) + "," + to_text<Real>(record.time) + "," +
      std::to_string(impact.ball) + (impact.with_wall ? ",wall," : ",ball,") +
      std::to_string(impact.partner);
  for (std::size_t k = model::approach_speed; k < model::logged_count; ++k)
    line += "," + to_text<Real>(record[k]);
  if (states) line += states_of(0) + (impact.with_wall ? std::string(15, ',') : states_of(1));
  return line;
}

}  // namespace edmill::output
