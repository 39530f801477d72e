// The motion and the vessel of a mill as tests take them apart.
#pragma once

#include <sstream>
#include <string>

#include "dynamics/wall_search.hpp"

namespace edmill::testing {

/// @pre the mill is a SPEX, or still
template <class Real> const model::SpexMotion<Real>& spex(const model::Mill<Real>& mill) {
  return *mill.motion.template get_if<model::SpexMotion<Real>>();
}
template <class Real> const model::CylinderVessel<Real>& cylinder(const model::Mill<Real>& mill) {
  return *mill.vessel.template get_if<model::CylinderVessel<Real>>();
}

/// Slope of the gap function of a wall near contact, by distance.
template <class Real>
Real gap_per_metre(const model::Mill<Real>& mill, int wall, const Real& ball_radius) {
  if (const auto* tube = mill.vessel.template get_if<model::CylinderVessel<Real>>())
    return wall == 2 ? Real(2 * (tube->radius - ball_radius)) : Real(1);
  if (const auto* sphere = mill.vessel.template get_if<model::SphereVessel<Real>>())
    return 2 * (sphere->radius - ball_radius);
  if (const auto* rounded = mill.vessel.template get_if<model::RoundedVessel<Real>>()) {
    const Real room = rounded->rounding() - ball_radius;
    return wall < 2 ? Real(2 * room)
        : wall == 2 ? Real(2 * (rounded->core_radius() + room))
                    : Real(1);
  }
  return Real(1);
}

/// Whether a joint translates at constant speed: the bounds then hold until the end of the case
/// only.
inline bool slides(const auto& mill) {
  bool found = false;
  mill.motion.visit([&](const auto& motion) {
    if constexpr (requires { motion.joints(); })
      for (const auto& j : motion.joints().list) found = found || (!j.rotates && j.speed != 0);
  });
  return found;
}

/// Every digit of the motion and of the vessel.
inline std::string text_of(const model::Mill<double>& mill) {
  std::ostringstream out;
  out << std::hexfloat;
  if (const auto* chain = mill.motion.get_if<model::ChainMotion<double>>())
    for (const auto& j : chain->joints().list)
      out << (j.rotates ? "turn " : "shift ") << j.axis[0] << " " << j.axis[1] << " " << j.axis[2]
          << " " << j.shift[0] << " " << j.shift[1] << " " << j.shift[2] << " " << j.angle << " "
          << j.speed << " swings " << j.swings.size() << "; ";
  else
    out << "arm " << spex(mill).arm() << " theta_max " << spex(mill).theta_max() << " gamma_max "
        << spex(mill).gamma_max();
  out << " period " << mill.motion.period();
  if (const auto* box = mill.vessel.get_if<model::BoxVessel<double>>())
    out << ", box " << box->half.transpose();
  else if (const auto* sphere = mill.vessel.get_if<model::SphereVessel<double>>())
    out << ", sphere " << sphere->radius;
  else if (const auto* rounded = mill.vessel.get_if<model::RoundedVessel<double>>())
    out << ", rounded " << rounded->core_radius() << " " << rounded->core_half() << " "
        << rounded->rounding();
  else if (const auto* polyhedron = mill.vessel.get_if<model::PolyhedronVessel<double>>())
    for (const auto& [n, d] : polyhedron->planes())
      out << ", plane " << n.transpose() << " at " << d;
  else if (mill.vessel.get_if<model::AlgebraicVessel<double>>())
    out << ", " << mill.vessel.wall_count() << " curved walls";
  else
    out << " R_v " << cylinder(mill).radius << " h/2 " << cylinder(mill).half_height;
  return out.str();
}

template <class Real>
using GeneralMill = dynamics::MovingVessel<model::AnyMotion<Real>, model::AnyVessel<Real>>;
template <class Real>
using GeneralFunctions = dynamics::GapFunctions<model::AnyMotion<Real>, model::AnyVessel<Real>>;
template <class Real>
using GeneralSearch = dynamics::WallSearch<model::AnyMotion<Real>, model::AnyVessel<Real>>;

template <class Real> GeneralMill<Real> moving(const model::Mill<Real>& mill) {
  return {mill.motion, mill.vessel, mill.gravity};
}
template <class Real> GeneralSearch<Real> general_search(const model::Mill<Real>& mill) {
  return {mill.motion, mill.vessel, mill.gravity};
}

}  // namespace edmill::testing
