// The X3D page that an `animation` wrote, read back: what it shows and how that moves.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <string>
#include <vector>

#include "base/vector.hpp"

namespace edmill::report {

/// Values over the fraction of the playback, from 0 to 1; straight between its keys.
struct Track {
  std::vector<double> keys;  ///< ascending
  Eigen::MatrixXd values;    ///< a column for each key

  Eigen::VectorXd at(double fraction) const;
};

/// A Transform of X3D: turned about an axis, then moved.
struct Joint {
  Track translation;  ///< [m]
  Track rotation;     ///< axis and angle [rad]

  Eigen::Isometry3d pose(double fraction) const;
};

/// A ball, or the mark of the contact point.
struct MovingSphere {
  double radius;       ///< [m]
  std::string colour;  ///< #rrggbb
  Track place;         ///< [m]
};

/// A cylinder about the Y axis of its own frame.
struct MovingVessel {
  double radius, height;      ///< [m]
  std::string colour;         ///< #rrggbb
  double opacity;             ///< from 0 to 1
  std::vector<Joint> joints;  ///< from the inertial frame inwards

  Eigen::Isometry3d pose(double fraction) const;
};

struct Animation {
  double duration;           ///< of one playback [s]
  Vec3<double> eye, target;  ///< of who looks at it [m]
  MovingVessel vessel;
  std::vector<MovingSphere> spheres;
};

/// @throws InputError when the file is no animation
Animation read_animation(const std::filesystem::path& file);

}  // namespace edmill::report
