// Both restitutions given.
#pragma once

#include "model/parts/parameter.hpp"

namespace edmill::model {

template <class Number>
struct ConstantRestitution {
  static constexpr const char* name = "constant";

  Number normal{1};      ///< e_n
  Number tangential{1};  ///< e_t

  static void parameters(auto& law, auto&& visit) {
    visit(Parameter{"restitution", Dimension::none, "e_n", {0, 1}}, law.normal);
    visit(Parameter{"restitution_tangential", Dimension::none, "e_t", {-1, 1}}, law.tangential);
  }

  const Number& restitution(const Number&) const { return normal; }
  const Number& restitution_of_slip(const Number&, const Number&, const Number&) const { return tangential; }
};

}  // namespace edmill::model
