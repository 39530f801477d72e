// The slip that Coulomb friction leaves.
#pragma once

#include "model/parts/parameter.hpp"

namespace edmill::model {

/// e_t = max(beta, 1 - mu c (|g_n| + g_n') / |g_t|): sliding all through the impact, or reversed by the part
/// beta. (2.24')
template <class Number>
Number coulomb_slip(const Number& friction, const Number& min_tangential, const Number& normal_change,
                    const Number& slip_speed, const Number& compliance) {
  const Number sliding = friction * compliance * normal_change;
  // 1 - sliding / slip >= min_tangential, without dividing by a vanishing slip.
  if (sliding >= (1 - min_tangential) * slip_speed) return slip_speed > 0 ? min_tangential : Number(1);
  return 1 - sliding / slip_speed;
}

/// What a law of the normal restitution alone takes for the slip.
template <class Number>
struct CoulombSlip {
  Number friction{0};         ///< mu
  Number min_tangential{-1};  ///< beta, the lowest e_t

  static void parameters(auto& slip, auto&& visit) {
    visit(Parameter{"friction", Dimension::none, "mu", {0, 1000000}}, slip.friction);
    visit(Parameter{"min_tangential", Dimension::none, "least e_t", {-1, 1}, "-1"}, slip.min_tangential);
  }

  Number restitution_of_slip(const Number& normal_change, const Number& slip_speed,
                             const Number& compliance) const {
    return coulomb_slip(friction, min_tangential, normal_change, slip_speed, compliance);
  }
};

}  // namespace edmill::model
