// Elastic, perfectly plastic spheres.
#pragma once

#include <cmath>

#include "base/trigonometry.hpp"
#include "model/laws/coulomb_slip.hpp"
#include "model/parts/contact_bodies.hpp"

namespace edmill::model {

/// Hertz's force up to a contact pressure, a constant pressure beyond, elastic unloading: e_n is 1 below the
/// yield speed and falls as v^(-1/4) far above it. Source: Thornton 1997, (40) and (33).
template <class Number>
struct ElasticPlastic : CoulombSlip<Number> {
  static constexpr const char* name = "elastic-plastic";

  Number modulus{1};         ///< E* [Pa]
  Number yield_pressure{1};  ///< p_y [Pa] at the centre of the contact

  static void parameters(auto& law, auto&& visit) {
    visit(effective_modulus, law.modulus);
    visit(Parameter{"yield_pressure", Dimension::pressure, "contact pressure at which yielding begins",
                    Range::positive},
          law.yield_pressure);
    CoulombSlip<Number>::parameters(law, visit);
  }

  /// v_y [m/s], at which the energy of the approach takes Hertz's pressure to p_y:
  /// M v_y^2 = 16/15 E* a^5 / R^2, a = pi p_y R / (2 E*).
  Number yield_speed(const ContactBodies<Number>& bodies) const {
    using std::sqrt;
    const Number radius = bodies.effective_radius();
    const Number strain = numerics::pi<Number>() * yield_pressure / (2 * modulus);
    const Number cube = strain * strain * strain, size = radius * radius * radius;
    return sqrt(16 * modulus * (strain * strain * cube * size) / (15 * bodies.effective_mass));
  }
  Number restitution(const Number& approach_speed, const ContactBodies<Number>& bodies) const {
    using std::sqrt;
    const Number yield = yield_speed(bodies);
    if (!(approach_speed > yield)) return Number(1);
    const Number ratio = yield / approach_speed, square = ratio * ratio;
    const Number unloading = ratio / (ratio + 2 * sqrt((6 - square) / 5));
    const Number e = sqrt(6 * sqrt(Number(3)) / 5 * (1 - square / 6) * sqrt(unloading));
    return e < 1 ? e : Number(1);
  }
};

}  // namespace edmill::model
