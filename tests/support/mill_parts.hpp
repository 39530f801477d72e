// The motion and the vessel of a mill as tests take them apart.
#pragma once

#include "dynamics/any_wall_search.hpp"

namespace edmill::testing {

/// @pre the mill is a SPEX, or still
template <class Real>
const model::SpexMotion<Real>& spex(const model::Mill<Real>& mill) {
  return *mill.motion.template get_if<model::SpexMotion<Real>>();
}
template <class Real>
const model::CylinderVessel<Real>& cylinder(const model::Mill<Real>& mill) {
  return *mill.vessel.template get_if<model::CylinderVessel<Real>>();
}

template <class Real>
using GeneralMill = dynamics::MovingVessel<model::AnyMotion<Real>, model::AnyVessel<Real>>;
template <class Real>
using GeneralFunctions = dynamics::GapFunctions<model::AnyMotion<Real>, model::AnyVessel<Real>>;
template <class Real>
using GeneralSearch = dynamics::WallSearch<model::AnyMotion<Real>, model::AnyVessel<Real>>;

template <class Real>
GeneralMill<Real> moving(const model::Mill<Real>& mill) {
  return {mill.motion, mill.vessel, mill.gravity};
}
template <class Real>
GeneralSearch<Real> general_search(const model::Mill<Real>& mill) {
  return {mill.motion, mill.vessel, mill.gravity};
}

}  // namespace edmill::testing
