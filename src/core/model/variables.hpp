// Names, units and meanings of the variables of an impact, and of those of a ball with their
// values; see impact_variables.def and ball_variables.def.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "base/vector.hpp"
#include "model/ball.hpp"

namespace edmill::model {

enum class VariableKind { flag, count, number };

struct ImpactVariable {
  VariableKind kind;
  std::string_view name;
  std::string_view thesis;  ///< in tables D.3 to D.5; empty for those that the thesis does not have
  std::string_view unit;    ///< "1" without a dimension
  std::string_view meaning;
};

#define EDMILL_FLAG(name, thesis, meaning, formula) \
  ImpactVariable{VariableKind::flag, #name, thesis, "1", meaning},
#define EDMILL_COUNT(name, thesis, meaning, formula) \
  ImpactVariable{VariableKind::count, #name, thesis, "1", meaning},
#define EDMILL_VARIABLE(name, thesis, unit, meaning, formula) \
  ImpactVariable{VariableKind::number, #name, thesis, unit, meaning},
inline constexpr std::array impact_variables{
#include "model/impact_variables.def"
};
#undef EDMILL_FLAG
#undef EDMILL_COUNT
#undef EDMILL_VARIABLE

/// Index of a variable in a list, by its name here or in the thesis.
std::optional<int> find_in(const auto& variables, std::string_view name) {
  for (int k = 0; k < static_cast<int>(variables.size()); ++k)
    if (!name.empty() && (variables[k].name == name || variables[k].thesis == name)) return k;
  return std::nullopt;
}
inline std::optional<int> find_variable(std::string_view name) {
  return find_in(impact_variables, name);
}

struct BallVariable {
  std::string_view name, thesis, unit, meaning;
};

#define EDMILL_BALL_VARIABLE(name, thesis, unit, meaning, formula) \
  BallVariable{#name, thesis, unit, meaning},
inline constexpr std::array ball_variables{
#include "model/ball_variables.def"
};
#undef EDMILL_BALL_VARIABLE

inline std::optional<int> find_ball_variable(std::string_view name) {
  return find_in(ball_variables, name);
}

/// One ball, for the formulas in ball_variables.def.
template <class Real> struct BallFacts {
  const BallProperties<Real>& ball;
  const BallState<Real>& state;
  const Real& pi;  ///< of the scalar

  Real inertia() const { return ball.reduced_inertia * ball.mass * ball.radius * ball.radius; }
  Real translational_energy() const { return ball.mass / 2 * squared_norm<Real>(state.velocity); }
  Real spin_energy() const { return inertia() / 2 * squared_norm<Real>(state.spin); }
};

/// Value of a row of `ball_variables`.
/// @param pi  of the scalar
template <class Real>
Real ball_variable(
    int row, const BallProperties<Real>& ball, const BallState<Real>& state, const Real& pi) {
  using Facts = BallFacts<Real>;
#define EDMILL_BALL_VARIABLE(name, thesis, unit, meaning, formula) \
  [](const Facts& b) -> Real { return Real(formula); },
  static constexpr std::array<Real (*)(const Facts&), ball_variables.size()> formulas{
#include "model/ball_variables.def"
  };
#undef EDMILL_BALL_VARIABLE
  return formulas[row]({ball, state, pi});
}

}  // namespace edmill::model
