// Coulomb friction while sliding, a lowest tangential restitution while sticking. (2.24')
#pragma once

#include "model/laws/coulomb_slip.hpp"

namespace edmill::model {

/// Source: Walton and Braun 1986; Barahona 2011, (2.24), for balls of any mass as in theory.md, section 5.
template <class Number>
struct WaltonBraun {
  static constexpr const char* name = "walton-braun";

  Number normal{1};           ///< e_n
  Number friction{0};         ///< mu
  Number min_tangential{-1};  ///< lowest e_t

  static void parameters(auto& law, auto&& visit) {
    visit(Parameter{"restitution", Dimension::none, "e_n", {0, 1}}, law.normal);
    visit(Parameter{"friction", Dimension::none, "mu", {0, 1000000}}, law.friction);
    visit(Parameter{"min_tangential", Dimension::none, "least e_t", {-1, 1}, "-1"}, law.min_tangential);
  }

  const Number& restitution(const Number&) const { return normal; }
  Number restitution_of_slip(const Number& normal_change, const Number& slip_speed,
                             const Number& compliance) const {
    return coulomb_slip(friction, min_tangential, normal_change, slip_speed, compliance);
  }
};

}  // namespace edmill::model
