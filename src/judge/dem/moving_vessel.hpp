// The moving vessel of a case, and balls relative to it.
#pragma once

#include <vector>

#include "model/mill.hpp"

namespace edmill::dem {

using Vector = Vec3<double>;
using BallState = model::BallState<double>;

/// Motion and walls for balls of given radii. The motion of walls within the vessel (pistons) is ignored.
class MovingVessel {
 public:
  /// @param facets  of the prism that represents a round wall, as `meshes_of` makes it; 0 for a wall that is
  /// round
  MovingVessel(const model::Mill<double>& mill, const std::vector<model::BallProperties<double>>& balls,
               int facets = 0);

  using Pose = model::AnyPose<double>;
  Pose at(double time) const { return mill_.motion.pose(clock_.at(time)); }

  /// Gap of a ball's surface from a wall; negative for an overlap [m].
  double gap(const Pose& pose, std::size_t ball, int wall, const Vector& position) const;
  /// Unit normal of a wall at the position of a ball, into the vessel, in the inertial frame.
  Vector normal(const Pose& pose, std::size_t ball, int wall, const Vector& position) const;
  /// Velocity of the vessel's material at a position in the inertial frame [m/s].
  Vector wall_velocity(const Pose& pose, const Vector& place) const {
    return mill_.motion.wall_velocity(pose, place);
  }
  int walls() const { return mill_.vessel.wall_count(); }

  /// Kinetic energy of a ball relative to the vessel [J].
  double energy(const Pose& pose, std::size_t ball, const BallState& state) const;
  /// Work of gravity and of the fictitious forces and torques on a ball between two states, relative to the
  /// vessel [J]: the mean of the forces in both states times the displacement.
  double work(const Pose& from, const BallState& before, const Pose& to, const BallState& after,
              std::size_t ball, const Vector& gravity) const;

  /// Transforms a state from the vessel frame to the inertial frame.
  BallState inertial(const Pose& pose, const BallState& in_vessel) const;

  const model::BallProperties<double>& ball(std::size_t k) const { return balls_[k]; }
  std::size_t ball_count() const { return balls_.size(); }

 private:
  const model::AnyVessel<double>& inset(std::size_t ball) const { return insets_[inset_of_[ball]]; }
  /// The cylindrical wall, if a prism represents it; otherwise null.
  const model::Tube<double>* prism(int wall) const;

  model::Mill<double> mill_;
  std::vector<model::BallProperties<double>> balls_;
  DriveClock<double> clock_;
  std::vector<model::AnyVessel<double>> insets_;  ///< for each radius
  std::vector<std::size_t> inset_of_;             ///< of each ball
  int facets_;
  std::vector<model::WallSurface<double>> surfaces_;
};

/// Free flight from a state.
BallState flown(const BallState& state, const Vector& gravity, double duration);

}  // namespace edmill::dem
