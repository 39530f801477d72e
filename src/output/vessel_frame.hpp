// Where the vessel is in pictures. In double: nothing is computed from it.
#pragma once

#include <cmath>

#include "base/frame.hpp"
#include "model/mill_motion.hpp"

namespace edmill::output {

/// The vessel frame at a time [s], in the inertial one.
template <class Real>
Frame<double> vessel_frame(const model::MillMotion<Real>& motion, double time) {
  const model::MillMotion<double> m{static_cast<double>(motion.arm), static_cast<double>(motion.theta_max),
                                    static_cast<double>(motion.gamma_max),
                                    static_cast<double>(motion.period)};
  const auto pose = model::pose_at<double>(m, std::fmod(time, m.period));
  return {model::to_inertial<double>(pose, m.arm, Vec3<double>::Zero()), model::vessel_axis_x(pose),
          model::vessel_axis_y(pose), model::vessel_axis_z(pose)};
}

/// Where the vessel's centre is in the middle of its motion [m].
template <class Real>
Vec3<double> middle_of(const model::MillMotion<Real>& motion) {
  return {0, static_cast<double>(motion.arm), 0};
}

}  // namespace edmill::output
