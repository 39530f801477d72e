// Viscoelastic spheres: Hertz's force with a dissipative part.
#pragma once

#include <cmath>

#include "base/elementary.hpp"
#include "model/laws/coulomb_slip.hpp"
#include "model/parts/contact_bodies.hpp"

namespace edmill::model {

/// M x" + k (x^(3/2) + 3/2 A x^(1/2) x') = 0 with k = 4/3 E* R^(1/2), until the force vanishes. Its
/// restitution depends on v* = (3/2 A)^(1/2) ((k/M)^2 v)^(1/10) alone. Sources: Ramirez, Poeschel,
/// Brilliantov and Schwager 1999; the rational approximation by Mueller and Poeschel 2011.
template <class Number>
struct Viscoelastic : CoulombSlip<Number> {
  static constexpr const char* name = "viscoelastic";

  Number modulus{1};           ///< E* [Pa]
  Number dissipative_time{1};  ///< A [s]

  static void parameters(auto& law, auto&& visit) {
    visit(effective_modulus, law.modulus);
    visit(Parameter{"dissipative_time", Dimension::time, "A of the dissipative force", Range::positive},
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

}  // namespace edmill::model
