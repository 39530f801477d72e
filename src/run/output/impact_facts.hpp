// All data of one impact, and the variables that outputs derive from it.
#pragma once

#include <array>
#include <cmath>

#include "base/elementary.hpp"
#include "base/scalar.hpp"
#include "base/vector.hpp"
#include "engine/simulation.hpp"
#include "model/ball.hpp"
#include "model/variables.hpp"

namespace edmill::output {

/// One of the two bodies of an impact. A wall has only a velocity, at the contact point.
template <class Real> struct ImpactBody {
  const model::BallProperties<Real>* ball = nullptr;  ///< null for a wall
  Vec3<Real> velocity_before = Vec3<Real>::Zero(),
             velocity_after = Vec3<Real>::Zero();  ///< of the centre, inertial frame [m/s]
  Vec3<Real> spin_before = Vec3<Real>::Zero(), spin_after = Vec3<Real>::Zero();  ///< [rad/s]
  Real flight_time{0};  ///< since its last impact, or the start of the run [s]

  Real translational_energy(const Vec3<Real>& velocity) const {
    return ball ? Real(ball->mass / 2 * squared_norm<Real>(velocity)) : Real(0);
  }
  Real spin_energy(const Vec3<Real>& spin) const {
    return ball ? Real(ball->reduced_inertia * ball->mass * ball->radius * ball->radius / 2 *
                      squared_norm<Real>(spin))
                : Real(0);
  }
};

/// Length of the parabola that ended with `velocity` after `time` in free flight [m].
template <class Real>
Real path_length(const Vec3<Real>& velocity, const Vec3<Real>& gravity, const Real& time) {
  using std::sqrt;
  const Real strength = norm<Real>(gravity);
  if (strength == 0) return norm<Real>(velocity) * time;
  // u: speed along gravity, w: across. L = [u sqrt(u^2 + w^2) + w^2 asinh(u / w)] / 2g, end less
  // start.
  const Vec3<Real> down = gravity * (1 / strength);
  const Real last = dot<Real>(velocity, down), first = last - strength * time;
  const Real across2 = squared_norm<Real>(velocity - down * last);
  const auto asinh = [&](const Real& x) {
    return numerics::log_of_one_plus<Real>(x + x * x / (1 + sqrt(1 + x * x)));
  };
  const auto positive = [](const Real& x) { return x < 0 ? Real(-x) : x; };
  const Real u1 = positive(last), u0 = positive(first);
  const Real q1 = sqrt(u1 * u1 + across2), q0 = sqrt(u0 * u0 + across2);
  if ((last < 0) != (first < 0)) {  // it turned on the way: two arcs from the top
    Real sum = u1 * q1 + u0 * q0;
    if (across2 > 0) sum += across2 * (asinh(u1 / sqrt(across2)) + asinh(u0 / sqrt(across2)));
    return sum / (2 * strength);
  }
  // One arc: differences are factored, so that short flights keep their digits.
  const Real steps = strength * time, sum = u1 + u0;
  if (sum == 0) return sqrt(across2) * time;
  Real arc = steps * sum * (u1 * u1 + u0 * u0 + across2) / (u1 * q1 + u0 * q0);
  if (across2 > 0) {
    // asinh(a) - asinh(b) = asinh((a^2 - b^2) / (a sqrt(1 + b^2) + b sqrt(1 + a^2)))
    arc += across2 * asinh(steps * sum / (u1 * q0 + u0 * q1));
  }
  return arc / (2 * strength);
}

/// One impact, for outputs and for the formulas of model/impact_variables.def; just before and
/// after it.
template <class Real> struct ImpactFacts {
  const engine::Impact<Real>& impact;
  const engine::Simulation<Real>& simulation;  ///< just after the impact
  Real time_previous;  ///< of the last impact of any ball, or the start of the run [s]
  int walls;           ///< how many there are
  const dynamics::ImpactOutcome<Real>& outcome = impact.outcome;
  Real time = simulation.clock().seconds(impact.time);  ///< [s]
  const Vec3<Real>& gravity = simulation.mill().gravity;
  const Vec3<Real>& normal = impact.normal;
  ImpactBody<Real> one = body(0, impact.ball);  ///< the ball
  ImpactBody<Real> two = impact.with_wall
      ? ImpactBody<Real>{nullptr, impact.wall_velocity, impact.wall_velocity}
      : body(1, impact.partner);  ///< its partner
  Vec3<Real> contact_point = simulation.flight(impact.ball).position -
      impact.normal * one.ball->radius;  ///< inertial frame [m]

  Vec3<Real> relative_before() const { return one.velocity_before - two.velocity_before; }
  Vec3<Real> relative_after() const { return one.velocity_after - two.velocity_after; }
  Vec3<Real> contact_before() const {
    return relative_before() - cross<Real>(rolling(one.spin_before, two.spin_before), normal);
  }
  Vec3<Real> contact_after() const {
    return relative_after() - cross<Real>(rolling(one.spin_after, two.spin_after), normal);
  }

  static Real size(const Vec3<Real>& v) { return norm<Real>(v); }
  Real normal_size(const Vec3<Real>& v) const {
    const Real part = dot<Real>(v, normal);
    return part < 0 ? Real(-part) : part;
  }
  Real tangential_size(const Vec3<Real>& v) const {
    return norm<Real>(v - normal * dot<Real>(v, normal));
  }
  /// Angle between the normal and a velocity, 0 to pi; 0 for a velocity of zero [rad].
  Real angle(const Vec3<Real>& v) const {
    const Real across = tangential_size(v), along = dot<Real>(v, normal);
    return across == 0 && along == 0 ? Real(0) : numerics::angle_between<Real>(across, along);
  }
  static Real energy(
      const ImpactBody<Real>& body, const Vec3<Real>& velocity, const Vec3<Real>& spin) {
    return body.translational_energy(velocity) + body.spin_energy(spin);
  }
  Real free_path(const ImpactBody<Real>& body) const {
    return body.ball ? path_length<Real>(body.velocity_before, gravity, body.flight_time) : Real(0);
  }

  /// State of a ball just before the impact, or at an instant since the previous one. The
  /// simulation itself already has the states after the impact.
  /// @param at  not before the last impact, not after the present one [s]
  model::BallState<Real> state_before(int ball, const Real& at) const {
    const bool is_one = ball == impact.ball, is_two = !impact.with_wall && ball == impact.partner;
    if (!is_one && !is_two) return simulation.state_at(ball, simulation.clock().at(at));
    const auto& own = is_one ? one : two;
    const Real back = time - at;
    return {
        simulation.flight(ball).position - own.velocity_before * back + gravity * (back * back / 2),
        own.velocity_before - gravity * back, own.spin_before};
  }
 private:
  ImpactBody<Real> body(int place, int ball) const {
    return {.ball = &simulation.properties(ball),
        .velocity_before = impact.velocity_before[place],
        .velocity_after = simulation.flight(ball).velocity,
        .spin_before = impact.spin_before[place],
        .spin_after = simulation.spin(ball),
        .flight_time = impact.flight_time[place]};
  }
  Vec3<Real> rolling(const Vec3<Real>& spin_one, const Vec3<Real>& spin_two) const {
    const Vec3<Real> first = spin_one * one.ball->radius;
    return two.ball ? Vec3<Real>(first + spin_two * two.ball->radius) : first;
  }
};

/// Evaluates a variable of model::impact_variables by its formula; 0 or 1 for a flag.
template <class Real> using VariableFormula = Real (*)(const ImpactFacts<Real>&);

template <class Real> VariableFormula<Real> variable_formula(int place) {
  using Facts = ImpactFacts<Real>;
#define EDMILL_FLAG(name, thesis, meaning, formula) \
  [](const Facts& f) -> Real { return (static_cast<void>(f), (formula) ? Real(1) : Real(0)); },
#define EDMILL_COUNT(name, thesis, meaning, formula) \
  [](const Facts& f) -> Real { return Real(formula); },
#define EDMILL_VARIABLE(name, thesis, unit, meaning, formula) \
  [](const Facts& f) -> Real { return Real(formula); },
  static constexpr std::array<VariableFormula<Real>, model::impact_variables.size()> formulas{
#include "model/impact_variables.def"
  };
#undef EDMILL_FLAG
#undef EDMILL_COUNT
#undef EDMILL_VARIABLE
  return formulas[place];
}

}  // namespace edmill::output
