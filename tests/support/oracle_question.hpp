// The solver's question to the oracle, in the oracle's plain numbers.
#pragma once

#include "arb_oracle.hpp"
#include "dynamics/wall_search.hpp"
#include "mill_parts.hpp"

namespace edmill::testing {

/// @param overtime  see OracleQuestion [s]
inline OracleQuestion question_of(
    const model::Mill<double>& mill, const dynamics::WallQuery<double>& q, double overtime = 0) {
  const auto array = [](const Vec3<double>& v) { return std::array<double, 3>{v[0], v[1], v[2]}; };
  OracleQuestion question{};
  question.period = mill.motion.period();
  if (const auto* chain = mill.motion.get_if<model::ChainMotion<double>>()) {
    question.chain.emplace();
    for (const auto& j : chain->joints().list) {
      OracleJoint joint{j.rotates, j.axis, j.shift, j.angle,
          {j.per_period.whole, j.per_period.bits}, {}, j.rotates ? 0 : j.speed};
      for (const auto& s : j.swings)
        joint.swings.push_back({s.amplitude, s.phase, {s.per_period.whole, s.per_period.bits}});
      question.chain->push_back(joint);
    }
  } else {
    const auto& motion = spex(mill);
    question.arm = motion.arm(), question.theta_max = motion.theta_max(),
    question.gamma_max = motion.gamma_max();
  }
  if (const auto* box = mill.vessel.get_if<model::BoxVessel<double>>())
    question.box = array(box->half);
  else if (const auto* sphere = mill.vessel.get_if<model::SphereVessel<double>>())
    question.sphere = sphere->radius;
  else if (const auto* rounded = mill.vessel.get_if<model::RoundedVessel<double>>())
    question.rounded = {rounded->core_radius(), rounded->core_half(), rounded->rounding()};
  else if (const auto* polyhedron = mill.vessel.get_if<model::PolyhedronVessel<double>>())
    for (const auto& [n, d] : polyhedron->planes())
      question.planes.push_back({n[0], n[1], n[2], d});
  else if (const auto* curved = mill.vessel.get_if<model::AlgebraicVessel<double>>())
    for (int wall = 0; wall < curved->wall_count(); ++wall) {
      auto& polynomial = question.polynomials.emplace_back();
      for (const auto& t : curved->form(wall).terms) polynomial.push_back({t.factor, t.powers});
    }
  else
    question.vessel_radius = cylinder(mill).radius,
    question.half_height = cylinder(mill).half_height;
  if (const auto* pistons = mill.vessel.pistons())
    for (const auto& p : pistons->given()) {
      OraclePiston piston{p.wall, p.distance, p.speed, {}};
      for (const auto& s : p.swings)
        piston.swings.push_back({s.amplitude, s.phase, {s.per_period.whole, s.per_period.bits}});
      question.pistons.push_back(piston);
    }
  question.gravity = array(mill.gravity);
  question.position = array(q.flight.position), question.velocity = array(q.flight.velocity);
  question.start_period = q.flight.start.period, question.start_offset = q.flight.start.offset;
  question.radius = q.radius;
  question.begin_period = q.begin.period, question.begin_offset = q.begin.offset;
  question.length = q.length, question.overtime = overtime;
  return question;
}

}  // namespace edmill::testing
