#include "tangent/tangent_map.hpp"

#include "dynamics/impulse.hpp"
#include "tangent/dual.hpp"

/// For messages.
template <>
std::string edmill::to_text<edmill::tangent::Dual<double>>(const tangent::Dual<double>& number) {
  return to_text(number.value);
}

namespace edmill::tangent {

namespace {

using Number = Dual<double>;

Vec3<Number> with_slopes(const Vec3<double>& value, const Vec3<double>& slope) {
  return {Number(value[0], slope[0]), Number(value[1], slope[1]), Number(value[2], slope[2])};
}
Vec3<double> slopes_of(const Vec3<Number>& v) { return {v[0].slope, v[1].slope, v[2].slope}; }

model::BallProperties<Number> constant(const model::BallProperties<double>& ball) {
  return {ball.radius, ball.mass, ball.reduced_inertia, ball.material};
}

/// By how much later the motion nearby has its impact. Bodies that do not approach each other have it at
/// once.
double delay(const Vec3<double>& normal, const Vec3<double>& gap, double approach_speed) {
  return approach_speed > 0 ? dot<double>(normal, gap) / approach_speed : 0;
}

/// A body of the motion nearby.
struct Nearby {
  Vec3<Number> position, velocity, spin;

  /// At its own impact, `delay` after the run's.
  Nearby(const Struck<double>& body, const Tangent<double>& t, const Vec3<double>& gravity, double delay)
      : position(with_slopes(body.position, t.position + body.velocity * delay)),
        velocity(with_slopes(body.velocity, t.velocity + gravity * delay)),
        spin(with_slopes(body.spin, t.spin)) {}
  /// Behind it, at the time of the run's.
  Tangent<double> back(const Struck<double>& body, const Vec3<double>& gravity, double delay) const {
    return {slopes_of(position) - body.velocity_after * delay, slopes_of(velocity) - gravity * delay,
            slopes_of(spin)};
  }
};

}  // namespace

struct TangentMap::InDuals {
  model::Mill<Number> mill;
  Vec3<double> gravity;
};

TangentMap::TangentMap(const model::Mill<double>& mill)
    : mill_(new InDuals{model::mill_cast<Number>(mill), mill.gravity}) {}
TangentMap::~TangentMap() = default;

void TangentMap::with_wall(const ImpactAt<double>& impact, int wall, const Struck<double>& struck,
                           std::span<Tangent<double>> directions) const {
  const auto& mill = mill_->mill;
  const auto ball = constant(struck.ball);
  const auto& law = mill.law_with_wall(ball, wall);
  for (auto& direction : directions) {
    const double later = delay(impact.normal, direction.position, impact.approach_speed);
    Nearby body(struck, direction, mill_->gravity, later);
    const Instant<Number> time{impact.time.period, Number(impact.time.offset, later)};
    const auto pose = mill.motion.pose(time);
    const auto place = mill.motion.position_in_vessel(pose, body.position);
    const Vec3<Number> normal =
        mill.motion.direction_to_inertial(pose, mill.vessel.inset(ball.radius).normal(wall, place));
    Vec3<Number> wall_velocity =
        mill.motion.wall_velocity(pose, Vec3<Number>(body.position - normal * ball.radius));
    if (const auto* pistons = mill.vessel.pistons())
      wall_velocity += normal * pistons->of_wall(wall, time).rate;
    dynamics::collide_with_wall<Number>(normal, ball, wall_velocity, body.velocity, body.spin, law,
                                        impact.in_stall);
    direction = body.back(struck, mill_->gravity, later);
  }
}

void TangentMap::of_pair(const ImpactAt<double>& impact, const Struck<double>& one, const Struck<double>& two,
                         std::span<Tangent<double>> of_one, std::span<Tangent<double>> of_two) const {
  const auto ball = constant(one.ball), partner = constant(two.ball);
  const auto& law = mill_->mill.law_between(ball, partner);
  for (std::size_t k = 0; k < of_one.size(); ++k) {
    const double later = delay(impact.normal, of_one[k].position - of_two[k].position, impact.approach_speed);
    Nearby a(one, of_one[k], mill_->gravity, later), b(two, of_two[k], mill_->gravity, later);
    const Vec3<Number> between = a.position - b.position;
    const Vec3<Number> normal = between * (Number(1) / norm<Number>(between));
    dynamics::collide_balls<Number>(normal, ball, partner, a.velocity, a.spin, b.velocity, b.spin, law,
                                    impact.in_stall);
    of_one[k] = a.back(one, mill_->gravity, later);
    of_two[k] = b.back(two, mill_->gravity, later);
  }
}

}  // namespace edmill::tangent
