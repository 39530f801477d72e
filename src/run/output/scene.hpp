// Pictures of the mill as X3D (ISO/IEC 19775-1) and as VTK XML, in double: no result needs them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/archive.hpp"
#include "base/vector.hpp"
#include "casefile/output_spec.hpp"
#include "model/motion.hpp"
#include "model/parts/surface.hpp"

namespace edmill::output {

struct SceneBall {
  double radius;  ///< [m]
  casefile::Colour colour;
  Vec3<double> position = Vec3<double>::Zero();  ///< inertial frame [m]
  Vec3<double> velocity = Vec3<double>::Zero(), spin = Vec3<double>::Zero();
  double milling_dose = 0;  ///< of the impacts that the ball had a part in [J]

  void archive(Archive& a) { a(radius, colour, position, velocity, spin, milling_dose); }
};

struct SceneVessel {
  std::vector<model::Mesh> walls;  ///< by id, in the vessel frame
  casefile::Colour colour;
  Frame<double> frame;

  void archive(Archive& a) { a(walls, colour, frame); }
};

struct Scene {
  SceneVessel vessel;
  std::vector<SceneVessel> bodies{};  ///< inside the vessel, each with one mesh
  Vec3<double> eye = Vec3<double>::Zero(),
               target = Vec3<double>::Zero();  ///< viewer and viewed point [m]
  std::vector<SceneBall> balls{};
  std::optional<SceneBall> contact{};  ///< marks the contact point
  double time;                         ///< [s]

  void archive(Archive& a) { a(vessel, bodies, eye, target, balls, contact, time); }
};

/// The frame of the vessel or of a body at a time [s], in the inertial one.
template <class Motion> Frame<double> frame_of(const Motion& motion, double time) {
  const auto own = motion.template cast<double>();
  const auto pose = own.pose(DriveClock<double>(own.period()).at(time));
  return {own.to_inertial(pose, Vec3<double>::Zero()), own.axis_x(pose), own.axis_y(pose),
      own.axis_z(pose)};
}

/// The motion in an animation: keys are fractions of its duration, from 0 to 1.
struct SceneMotion {
  double duration;  ///< of one playback [s]
  using Frames = std::vector<std::pair<double, Frame<double>>>;
  Frames vessel;
  std::vector<Frames> bodies;
  using Path = std::vector<std::pair<double, Vec3<double>>>;
  std::vector<std::pair<std::size_t, Path>>
      pistons;              ///< by wall, relative to the place in the scene [m]
  std::vector<Path> balls;  ///< of each ball
  Path contact;             ///< where the scene marks the contact point

  void archive(Archive& a) { a(duration, vessel, bodies, pistons, balls, contact); }
};

/// Places the viewer so that all walls are visible in all of these frames.
/// @param walls  in the vessel frame; a wall that moves is in its outermost position
void look_at(
    const std::vector<model::Mesh>& walls, const std::vector<Frame<double>>& frames, Scene& scene);

/// An X3D 3.3 page: a still picture or, with `motion`, an animation that is repeated forever.
std::string x3d_text(const Scene& scene, const SceneMotion* motion = nullptr);

/// The balls as VTK PolyData: points with diameter, velocity, spin and milling dose.
std::string vtp_balls(const Scene& scene);

/// The vessel's inner surface as VTK PolyData.
std::string vtp_vessel(const Scene& scene);

/// A ParaView collection. @param frames  time and the file names of its parts
std::string pvd_text(const std::vector<std::pair<double, std::vector<std::string>>>& frames);

}  // namespace edmill::output
