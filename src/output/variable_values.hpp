// Values of the variables of an impact, by the formulas of model/impact_variables.def.
#pragma once

#include <array>
#include <string>

#include "base/scalar.hpp"
#include "model/impact_variables.hpp"
#include "output/impact_facts.hpp"

namespace edmill::output {

/// Value of the variable at a place of model::impact_variables; 0 or 1 for a flag.
template <class Real>
using VariableFormula = Real (*)(const ImpactFacts<Real>&);

template <class Real>
VariableFormula<Real> variable_formula(int place) {
  using Facts = ImpactFacts<Real>;
#define EDMILL_FLAG(name, thesis, meaning, formula) \
  [](const Facts& f) -> Real { return (static_cast<void>(f), (formula) ? Real(1) : Real(0)); },
#define EDMILL_COUNT(name, thesis, meaning, formula) [](const Facts& f) -> Real { return Real(formula); },
#define EDMILL_VARIABLE(name, thesis, unit, meaning, formula) \
  [](const Facts& f) -> Real { return Real(formula); },
  static constexpr std::array<VariableFormula<Real>, model::impact_variables.size()> formulas{
#include "model/impact_variables.def"
  };
#undef EDMILL_FLAG
#undef EDMILL_COUNT
#undef EDMILL_VARIABLE
  return formulas[static_cast<std::size_t>(place)];
}

}  // namespace edmill::output
