// Spheres with Hertz's force: viscoelastic ones, and elastic ones that yield.
#pragma once

#include <cmath>

#include "base/elementary.hpp"
#include "model/ball.hpp"
#include "model/laws/walton_braun.hpp"

namespace edmill::model {

inline constexpr Parameter effective_modulus{
    "effective_modulus", Dimension::pressure,
    "effective modulus E*, with 1/E* = (1 - nu_i^2)/E_i + (1 - nu_j^2)/E_j", Range::positive};

/// Viscoelastic spheres: M x" + k (x^(3/2) + 3/2 A x^(1/2) x') = 0 with k = 4/3 E* R^(1/2), until the force
/// vanishes. The restitution depends only on v* = (3/2 A)^(1/2) ((k/M)^2 v)^(1/10). Sources: Ramirez,
/// Poeschel, Brilliantov and Schwager 1999; the rational approximation by Mueller and Poeschel 2011.
template <class Number>
struct Viscoelastic : CoulombSlip<Number> {
  static constexpr const char* name = "viscoelastic";

  Number modulus{1};           ///< E* [Pa]
  Number dissipative_time{1};  ///< A [s]

  static void parameters(auto& law, auto&& visit) {
    visit(effective_modulus, law.modulus);
    visit(Parameter{"dissipative_time", Dimension::time, "time A of the dissipative force", Range::positive},
          law.dissipative_time);
    CoulombSlip<Number>::parameters(law, visit);
  }

  Number restitution(const Number& approach_speed, const ContactBodies<Number>& bodies) const {
    using std::sqrt;
    const Number stiffness = 4 * modulus * sqrt(bodies.effective_radius()) / 3;
    const Number by_mass = stiffness / bodies.effective_mass;
    const Number scaled = sqrt(3 * dissipative_time / 2) *
                          sqrt(numerics::fifth_root(Number(by_mass * by_mass * approach_speed)));
    return by_scaled_speed(scaled);
  }
  /// e_n(v*).
  static Number by_scaled_speed(const Number& v) {
    const auto c = [](int millionths) { return Number(millionths) / 1000000; };
    const Number one = 1 + c(501086) * v;
    return one / (one + v * v * (c(1153450) + v * (c(577977) + v * c(532178))));
  }
};

/// Elastic, perfectly plastic: Hertz's force up to a contact pressure, a constant pressure beyond, elastic
/// unloading. e_n is 1 below the yield speed and falls as v^(-1/4) far above it. Source: Thornton 1997, (40)
/// and (33).
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

  /// Yield speed v_y [m/s], at which the energy of the approach raises Hertz's pressure to p_y: M v_y^2 =
  /// 16/15 E* a^5 / R^2, a = pi p_y R / (2 E*).
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
