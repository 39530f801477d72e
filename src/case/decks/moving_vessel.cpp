#include "decks/moving_vessel.hpp"

#include <algorithm>

#include "decks/wall_mesh.hpp"

namespace edmill::decks {

MovingVessel::MovingVessel(const model::Mill<double>& mill,
                           const std::vector<model::BallProperties<double>>& balls, int facets)
    : mill_(mill),
      motions_{mill.motion},
      balls_(balls),
      clock_(mill.motion.period()),
      facets_(facets),
      surfaces_(mill.vessel.surfaces()) {
  for (const auto& body : mill_.bodies) motions_.emplace_back(body.motion);
  std::vector<double> radii;
  for (const auto& ball : balls_) {
    const auto k =
        static_cast<std::size_t>(std::find(radii.begin(), radii.end(), ball.radius) - radii.begin());
    inset_of_.push_back(k);
    if (k < radii.size()) continue;
    radii.push_back(ball.radius);
    insets_.push_back(mill_.vessel.inset(ball.radius));
  }
}

MovingVessel::Pose MovingVessel::at(double time) const {
  Pose poses;
  poses.reserve(motions_.size());
  for (const auto& motion : motions_) poses.push_back(motion.pose(clock_.at(time)));
  return poses;
}

const model::Tube<double>* MovingVessel::prism(int wall) const {
  return facets_ > 0 && frame_of(wall) == 0
             ? std::get_if<model::Tube<double>>(&surfaces_[static_cast<std::size_t>(wall)].kind())
             : nullptr;
}

// The gap follows from the overlap, which is a length; gap functions of vessels need not be.
double MovingVessel::gap(const Pose& pose, std::size_t ball, int wall, const Vector& position) const {
  const auto frame = frame_of(wall);
  const Vector place = motions_[frame].position_in_vessel(pose[frame], position);
  if (const auto* body = mill_.body_of(wall)) return -body->shape.overlap(0, place) - balls_[ball].radius;
  if (const auto* tube = prism(wall))
    return tube->radius - balls_[ball].radius -
           dot<double>(place - tube->frame.origin, facet_normal(*tube, facets_, place));
  return -inset(ball).overlap(wall, place);
}

Vector MovingVessel::normal(const Pose& pose, std::size_t ball, int wall, const Vector& position) const {
  const auto frame = frame_of(wall);
  const Vector p = motions_[frame].position_in_vessel(pose[frame], position);
  const auto* body = mill_.body_of(wall);
  const auto* tube = prism(wall);
  return motions_[frame].direction_to_inertial(pose[frame], body   ? body->shape.normal(0, p)
                                                            : tube ? Vector(-facet_normal(*tube, facets_, p))
                                                                   : inset(ball).normal(wall, p));
}

double MovingVessel::energy(const Pose& pose, std::size_t frame, std::size_t ball,
                            const BallState& state) const {
  const auto& b = balls_[ball];
  const auto& m = motions_[frame];
  const Vector u = m.to_vessel_frame(pose[frame], state.position, state.velocity).velocity;
  const Vector s = state.spin - m.angular_velocity(pose[frame]);
  return b.mass / 2 * squared_norm<double>(u) +
         b.reduced_inertia * b.mass * b.radius * b.radius / 2 * squared_norm<double>(s);
}

double MovingVessel::work(const Pose& poses, const BallState& before, const Pose& later,
                          const BallState& after, std::size_t frame, std::size_t ball,
                          const Vector& gravity) const {
  const auto& m = motions_[frame];
  const auto &from = poses[frame], &to = later[frame];
  // Coriolis's force does no work.
  const Vector force = m.in_axes(from, gravity - m.wall_acceleration(from, before.position)) +
                       m.in_axes(to, gravity - m.wall_acceleration(to, after.position));
  const Vector way = m.position_in_vessel(to, after.position) - m.position_in_vessel(from, before.position);
  const auto& b = balls_[ball];
  // The torque -J w' on a spin relative to the vessel.
  const Vector turn = m.angular_velocity(to) - m.angular_velocity(from);
  const Vector spins = before.spin - m.angular_velocity(from) + after.spin - m.angular_velocity(to);
  return b.mass / 2 * dot<double>(force, way) -
         b.reduced_inertia * b.mass * b.radius * b.radius / 2 * dot<double>(turn, spins);
}

BallState MovingVessel::inertial(const Pose& poses, const BallState& seen) const {
  const auto& m = mill_.motion;
  const auto& pose = poses.front();
  const Vector place = m.to_inertial(pose, seen.position);
  return {place, m.direction_to_inertial(pose, seen.velocity) + m.wall_velocity(pose, place),
          m.direction_to_inertial(pose, seen.spin) + m.angular_velocity(pose)};
}

BallState flown(const BallState& state, const Vector& gravity, double duration) {
  return {state.position + (state.velocity + gravity * (duration / 2)) * duration,
          state.velocity + gravity * duration, state.spin};
}

}  // namespace edmill::decks
