// Reads the X3D page that an output `animation` has written: the bodies in it and their motion.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <string>
#include <vector>

#include "base/vector.hpp"
#include "model/parts/surface.hpp"

namespace edmill::report {

/// Values over the fraction of the playback, from 0 to 1.
struct Track {
  std::vector<double> keys;  ///< ascending
  Eigen::MatrixXd values;    ///< a column for each key

  /// The two columns around a fraction, and the second one's share; a column twice at the ends.
  struct Between {
    Eigen::Index before, after;
    double share;
  };
  Between between(double fraction) const;
  /// Linear interpolation between the keys.
  Eigen::VectorXd at(double fraction) const;
};

/// A ball, or the mark of the contact point.
struct MovingSphere {
  double radius;       ///< [m]
  std::string colour;  ///< #rrggbb
  Track place;         ///< [m]
};

struct MovingVessel {
  std::vector<model::Mesh> walls;  ///< by id, in the vessel frame
  std::vector<Track> shifts;       ///< of each wall in the vessel, one that moves or none [m]
  std::string colour;              ///< #rrggbb
  double opacity;                  ///< from 0 to 1
  Track place;                     ///< of the vessel frame [m]
  Track turn;                      ///< axis and angle [rad]

  /// Interpolated between keys; rotations take the shorter way.
  Eigen::Isometry3d pose(double fraction) const;
};

struct Animation {
  double duration;           ///< of one playback [s]
  Vec3<double> eye, target;  ///< positions of the viewer and of the centre of the view [m]
  MovingVessel vessel;
  std::vector<MovingVessel> bodies;  ///< in it, each with one wall
  std::vector<MovingSphere> spheres;
};

/// @throws InputError when the file is no animation
Animation read_animation(const std::filesystem::path& file);

}  // namespace edmill::report
