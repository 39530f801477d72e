#include "run/linearised.hpp"

#include "base/wide_trigonometry.hpp"
#include "engine/simulation.hpp"

namespace edmill::run {

namespace {

using Vector = Vec3<mpfr>;

/// Two bodies, or one and a wall, at an impact and after it.
struct Collision {
  std::array<Vector, 2> position, velocity, spin;
  dynamics::ImpactOutcome<mpfr> outcome{};
};

/// The same time on the clock of a mill with another drive period.
Instant<mpfr> on_clock_of(const model::Mill<mpfr>& mill, const mpfr& period, const Instant<mpfr>& t,
                          const mpfr& later) {
  return {t.period, t.offset + mpfr(t.period) * (period - mill.motion.period()) + later};
}

mpfr gap_of(const model::Mill<mpfr>& mill, const mpfr& radius, int wall, const Instant<mpfr>& time,
            const Vector& position) {
  const auto place = mill.motion.position_in_vessel(mill.motion.pose(time), position);
  mpfr gap = -mill.vessel.inset(radius).overlap(wall, place);
  if (const auto* pistons = mill.vessel.pistons()) gap -= pistons->of_wall(wall, time).value;
  return gap;
}

void collide(const Perturbation& in, const engine::Impact<mpfr>& impact, const Instant<mpfr>& time,
             Collision& c) {
  const auto ball = static_cast<std::size_t>(impact.ball), partner = static_cast<std::size_t>(impact.partner);
  const auto& own = in.balls[ball];
  const bool rests = impact.outcome.in_stall;
  if (!impact.with_wall) {
    const Vector between = c.position[0] - c.position[1];
    const Vector normal = between * (mpfr(1) / norm<mpfr>(between));
    const auto& law = in.mill.law_between(own, in.balls[partner]);
    c.outcome = dynamics::collide_balls<mpfr>(normal, own, in.balls[partner], c.velocity[0], c.spin[0],
                                              c.velocity[1], c.spin[1], law, rests);
    return;
  }
  const auto& motion = in.mill.motion;
  const auto pose = motion.pose(time);
  const auto place = motion.position_in_vessel(pose, c.position[0]);
  const Vector normal =
      motion.direction_to_inertial(pose, in.mill.vessel.inset(own.radius).normal(impact.partner, place));
  Vector wall_velocity = motion.wall_velocity(pose, Vector(c.position[0] - normal * own.radius));
  if (const auto* pistons = in.mill.vessel.pistons())
    wall_velocity += normal * pistons->of_wall(impact.partner, time).rate;
  c.outcome = dynamics::collide_with_wall<mpfr>(normal, own, wall_velocity, c.velocity[0], c.spin[0],
                                                in.mill.law_with_wall(own, impact.partner), rests);
}

}  // namespace

struct Linearised::Body {
  int ball = -1;
  Vector position{0, 0, 0}, velocity{0, 0, 0}, spin{0, 0, 0}, velocity_after{0, 0, 0};
  mpfr flight_time{0};
};

Linearised::Linearised(Perturbation base, std::vector<Perturbation> others, unsigned digits)
    : base_(std::move(base)), others_(std::move(others)), digits_(digits) {
  for (const auto& other : others_) tangents_.push_back(other.initial);
}

EventDerivative Linearised::derivative(const engine::Impact<mpfr>& impact, const std::array<Body, 2>& bodies,
                                       std::size_t which) {
  const auto& other = others_[which];
  const mpfr& step = other.step;
  const auto& gravity = base_.mill.gravity;
  const Vector gravity_rate = (other.mill.gravity - gravity) / step;
  const std::size_t count = impact.with_wall ? 1 : 2;
  std::array<tangent::Tangent<mpfr>*, 2> t{};
  for (std::size_t k = 0; k < count; ++k) {
    const mpfr& dt = bodies[k].flight_time;
    t[k] = &tangents_[which][static_cast<std::size_t>(bodies[k].ball)];
    t[k]->fly(dt);
    t[k]->position += gravity_rate * mpfr(dt * dt / 2);
    t[k]->velocity += gravity_rate * dt;
  }
  const auto radius = [&](const Perturbation& in, std::size_t k) {
    return in.balls[static_cast<std::size_t>(bodies[k].ball)].radius;
  };
  const mpfr& period = base_.mill.motion.period();
  mpfr gap;
  if (impact.with_wall) {
    const auto at = [&](const Perturbation& in, const Vector& position) {
      return gap_of(in.mill, radius(in, 0), impact.partner, on_clock_of(in.mill, period, impact.time, 0),
                    position);
    };
    const Vector moved = bodies[0].position + t[0]->position * step;
    gap = (at(other, moved) - at(base_, bodies[0].position)) / step;
  } else {
    gap = dot<mpfr>(impact.normal, Vector(t[0]->position - t[1]->position)) -
          (radius(other, 0) + radius(other, 1) - radius(base_, 0) - radius(base_, 1)) / step;
  }
  const mpfr& approach = impact.outcome.approach_speed;
  const mpfr later = approach > 0 ? mpfr(gap / approach) : mpfr(0);

  Collision run, nearby;
  for (std::size_t k = 0; k < count; ++k) {
    const auto& b = bodies[k];
    run.position[k] = b.position, run.velocity[k] = b.velocity, run.spin[k] = b.spin;
    nearby.position[k] = b.position + (t[k]->position + b.velocity * later) * step;
    nearby.velocity[k] = b.velocity + (t[k]->velocity + gravity * later) * step;
    nearby.spin[k] = b.spin + t[k]->spin * step;
  }
  collide(base_, impact, impact.time, run);
  collide(other, impact, on_clock_of(other.mill, period, impact.time, later * step), nearby);

  EventDerivative d;
  const auto rate = [&](const mpfr& a, const mpfr& b) { return mpfr((b - a) / step); };
  const auto &o = run.outcome, &p = nearby.outcome;
  d.values = {later, rate(o.approach_speed, p.approach_speed), rate(o.slip_speed, p.slip_speed),
              rate(o.milling_dose, p.milling_dose), rate(o.wall_work, p.wall_work)};
  for (std::size_t k = 0; k < count; ++k) {
    t[k]->position += (bodies[k].velocity - run.velocity[k]) * later;
    t[k]->velocity = (nearby.velocity[k] - run.velocity[k]) / step - gravity * later;
    t[k]->spin = (nearby.spin[k] - run.spin[k]) / step;
    d.states_after[k] = *t[k];
  }
  return d;
}

void Linearised::on_impact(const engine::Impact<mpfr>& impact, engine::Simulation<mpfr>& simulation) {
  const mpfr::Digits evaluation(digits_);
  std::array<Body, 2> bodies;
  const auto fill = [&](std::size_t k, int ball) {
    const auto& flight = simulation.flight(ball);
    bodies[k] = {ball,
                 flight.position,
                 impact.velocity_before[k],
                 impact.spin_before[k],
                 flight.velocity,
                 impact.flight_time[k]};
  };
  fill(0, impact.ball);
  if (!impact.with_wall) fill(1, impact.partner);
  events_.emplace_back();
  for (std::size_t which = 0; which < others_.size(); ++which)
    events_.back().push_back(derivative(impact, bodies, which));
}

}  // namespace edmill::run
