// Where the vessel is in pictures. In double: nothing is computed from it.
#pragma once

#include "base/vector.hpp"
#include "model/motion.hpp"

namespace edmill::output {

/// The vessel frame at a time [s], in the inertial one.
template <class Real>
Frame<double> vessel_frame(const model::AnyMotion<Real>& motion, double time) {
  const auto own = motion.template cast<double>();
  const auto pose = own.pose(DriveClock<double>(own.period()).at(time));
  return {own.to_inertial(pose, Vec3<double>::Zero()), own.axis_x(pose), own.axis_y(pose), own.axis_z(pose)};
}

}  // namespace edmill::output
