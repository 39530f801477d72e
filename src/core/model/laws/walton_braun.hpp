// Constant restitutions, and the slip that remains with Coulomb friction.
#pragma once

#include "model/parts/parameter.hpp"

namespace edmill::model {

/// Both restitutions are constant.
template <class Number>
struct ConstantRestitution {
  static constexpr const char* name = "constant";

  Number normal{1};      ///< e_n
  Number tangential{1};  ///< e_t

  static void parameters(auto& law, auto&& visit) {
    visit(Parameter{"restitution", "coefficient of restitution along the normal, e_n", {0, 1}}, law.normal);
    visit(Parameter{"restitution_tangential", "tangential coefficient of restitution, e_t", {-1, 1}},
          law.tangential);
  }

  const Number& restitution(const Number&) const { return normal; }
  const Number& restitution_of_slip(const Number&, const Number&, const Number&) const { return tangential; }
};

/// The tangential part of laws that define only the normal restitution: e_t = max(beta, 1 - mu c (|g_n| +
/// g_n') / |g_t|). The contact slides throughout the impact, or its slip is reversed by the factor beta.
/// (2.24')
template <class Number>
struct CoulombSlip {
  Number friction{0};         ///< mu
  Number min_tangential{-1};  ///< beta, the lowest e_t

  static void parameters(auto& slip, auto&& visit) {
    visit(Parameter{"friction", "coefficient of friction, mu", {0, 1000000}}, slip.friction);
    visit(Parameter{"min_tangential", "smallest tangential coefficient of restitution, e_t", {-1, 1}, "-1"},
          slip.min_tangential);
  }

  Number restitution_of_slip(const Number& normal_change, const Number& slip_speed,
                             const Number& compliance) const {
    const Number sliding = friction * compliance * normal_change;
    // 1 - sliding / slip >= min_tangential, without dividing by a vanishing slip.
    if (sliding >= (1 - min_tangential) * slip_speed) return slip_speed > 0 ? min_tangential : Number(1);
    return 1 - sliding / slip_speed;
  }
};

/// Coulomb friction while sliding, a lowest tangential restitution while sticking.
/// Source: Walton and Braun 1986; Barahona 2011, (2.24), for balls of any mass as in theory.md, section 5.
template <class Number>
struct WaltonBraun {
  static constexpr const char* name = "walton-braun";

  Number normal{1};           ///< e_n
  Number friction{0};         ///< mu
  Number min_tangential{-1};  ///< lowest e_t

  static void parameters(auto& law, auto&& visit) {
    visit(Parameter{"restitution", "coefficient of restitution along the normal, e_n", {0, 1}}, law.normal);
    CoulombSlip<Number>::parameters(law, visit);
  }

  const Number& restitution(const Number&) const { return normal; }
  Number restitution_of_slip(const Number& normal_change, const Number& slip_speed,
                             const Number& compliance) const {
    const CoulombSlip<Number> slip{friction, min_tangential};
    return slip.restitution_of_slip(normal_change, slip_speed, compliance);
  }
};

}  // namespace edmill::model
