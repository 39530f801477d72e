// The physical model without the balls: a vessel on its motion, gravity and what contacts do.
#pragma once

#include <type_traits>

#include "base/vector.hpp"
#include "model/contact_law.hpp"
#include "model/motion.hpp"
#include "model/vessel.hpp"

namespace edmill::model {

template <class Real>
struct Mill {
  AnyMotion<Real> motion;
  AnyVessel<Real> vessel;
  Vec3<Real> gravity;  ///< [m/s^2]
  ContactLaw<Real> ball_ball;
  ContactLaw<Real> ball_wall;
};

/// The mill in another scalar: exact when that is wider, rounded otherwise.
template <class To, class From>
Mill<To> mill_cast(const Mill<From>& m) {
  const auto law = [](const ContactLaw<From>& l) {
    return convert_law<To>(l, [](const From& x) { return static_cast<To>(x); });
  };
  return {m.motion.template cast<To>(), m.vessel.template cast<To>(), vector_cast<To>(m.gravity),
          law(m.ball_ball), law(m.ball_wall)};
}

/// Calls f(motion, vessel): in double with the SPEX and the cylinder as what they are, so that f is compiled
/// for them, with everything else as it is given.
template <class Real, class F>
[[gnu::always_inline]] inline decltype(auto) with_parts(const AnyMotion<Real>& motion,
                                                        const AnyVessel<Real>& vessel, F&& f) {
  if constexpr (std::is_same_v<Real, double>) {
    const auto* spex = motion.template get_if<SpexMotion<Real>>();
    const auto* cylinder = vessel.template get_if<CylinderVessel<Real>>();
    if (spex && cylinder) [[likely]]
      return f(*spex, *cylinder);
  }
  return f(motion, vessel);
}

/// A pose as M has it.
template <class M>
const typename M::Pose& pose_of(const AnyPose<typename M::Scalar>& pose) {
  if constexpr (std::is_same_v<typename M::Pose, AnyPose<typename M::Scalar>>)
    return pose;
  else
    return *std::get_if<typename M::Pose>(&pose);
}

}  // namespace edmill::model
