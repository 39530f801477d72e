// The walls of a case as triangles; its moving vessel with bodies and such walls, and balls
// relative to it.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "model/mill.hpp"

namespace edmill::decks {

using Triangle = std::array<Vec3<double>, 3>;

/// The triangles of one part of the vessel, and the angle beyond which an edge is one.
struct WallMesh {
  std::string name;
  std::vector<Triangle> triangles;
  double smooth_angle = 0;  ///< [deg] of facets that represent a round wall; 0 for flat walls
};

/// A round wall becomes a prism around it, whose facets touch it along their middles, one of them
/// on the vessel's x axis. Empty for a vessel that has none.
std::vector<WallMesh> meshes_of(const model::AnyVessel<double>& vessel, int facets);

/// The surface of a body, whose round parts are prisms within it.
WallMesh mesh_of(const model::RoundedBody<double>& body, const std::string& name);

/// Unit normal, out of the vessel, of the facet of that prism that is nearest to a position.
Vec3<double> facet_normal(const model::Tube<double>& tube, int facets, const Vec3<double>& place);

/// The text of an STL file (ASCII) of these meshes, placed as in this pose.
std::string stl_text(std::span<const WallMesh> meshes, const model::AnyMotion<double>& motion,
    const model::AnyPose<double>& pose);

using Vector = Vec3<double>;
using BallState = model::BallState<double>;

/// Motion and walls for balls of given radii. The motion of walls within the vessel (pistons) is
/// ignored. Frame 0 is the vessel's; each body has one of its own.
class MovingVessel {
 public:
  /// @param facets  of the prism that replaces a round wall, as in `meshes_of`; 0 if none does
  MovingVessel(const model::Mill<double>& mill,
      const std::vector<model::BallProperties<double>>& balls, int facets = 0);

  using Pose = std::vector<model::AnyPose<double>>;  ///< by frame
  Pose at(double time) const;
  std::size_t frame_of(int wall) const {
    return static_cast<std::size_t>(std::max(0, wall - mill_.vessel.wall_count() + 1));
  }

  /// Gap of a ball's surface from a wall; negative for an overlap [m].
  double gap(const Pose& pose, std::size_t ball, int wall, const Vector& position) const;
  /// Unit normal from a wall to a ball at a position, in the inertial frame.
  Vector normal(const Pose& pose, std::size_t ball, int wall, const Vector& position) const;
  /// Velocity of a wall's material at a position in the inertial frame [m/s].
  Vector wall_velocity(const Pose& pose, int wall, const Vector& place) const {
    const auto frame = frame_of(wall);
    return motions_[frame].wall_velocity(pose[frame], place);
  }
  int walls() const { return mill_.wall_count(); }
  bool has_bodies() const { return motions_.size() > 1; }

  /// Kinetic energy of a ball relative to a frame [J].
  double energy(
      const Pose& pose, std::size_t frame, std::size_t ball, const BallState& state) const;
  /// Work of gravity and of the fictitious forces and torques on a ball between two states,
  /// relative to a frame [J]: the mean of the forces in both states times the displacement.
  double work(const Pose& from, const BallState& before, const Pose& to, const BallState& after,
      std::size_t frame, std::size_t ball, const Vector& gravity) const;

  /// Transforms a state from the vessel frame to the inertial frame.
  BallState inertial(const Pose& pose, const BallState& in_vessel) const;

  const model::BallProperties<double>& ball(std::size_t k) const { return balls_[k]; }
  std::size_t ball_count() const { return balls_.size(); }
 private:
  const model::AnyVessel<double>& inset(std::size_t ball) const { return insets_[inset_of_[ball]]; }
  /// The cylindrical wall, if a prism represents it; otherwise null.
  const model::Tube<double>* prism(int wall) const;

  model::Mill<double> mill_;
  std::vector<model::AnyMotion<double>> motions_;  ///< by frame
  std::vector<model::BallProperties<double>> balls_;
  DriveClock<double> clock_;
  std::vector<model::AnyVessel<double>> insets_;  ///< for each radius
  std::vector<std::size_t> inset_of_;             ///< of each ball
  int facets_;
  std::vector<model::WallSurface<double>> surfaces_;
};

/// Free flight from a state.
BallState flown(const BallState& state, const Vector& gravity, double duration);

}  // namespace edmill::decks
