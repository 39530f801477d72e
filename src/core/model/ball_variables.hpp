// Names, units, meanings and values of the quantities of one ball; see ball_variables.def.
#pragma once

#include <array>

#include "base/vector.hpp"
#include "model/ball.hpp"
#include "model/impact_variables.hpp"

namespace edmill::model {

struct BallVariable {
  std::string_view name, thesis, unit, meaning;
};

#define EDMILL_BALL_VARIABLE(name, thesis, unit, meaning, formula) BallVariable{#name, thesis, unit, meaning},
inline constexpr std::array ball_variables{
#include "model/ball_variables.def"
};
#undef EDMILL_BALL_VARIABLE

inline std::optional<int> find_ball_variable(std::string_view name) { return find_in(ball_variables, name); }

/// One ball as the rows of ball_variables.def see it.
template <class Real>
struct BallFacts {
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
Real ball_variable(int row, const BallProperties<Real>& ball, const BallState<Real>& state, const Real& pi) {
  using Facts = BallFacts<Real>;
#define EDMILL_BALL_VARIABLE(name, thesis, unit, meaning, formula) \
  [](const Facts& b) -> Real { return Real(formula); },
  static constexpr std::array<Real (*)(const Facts&), ball_variables.size()> formulas{
#include "model/ball_variables.def"
  };
#undef EDMILL_BALL_VARIABLE
  return formulas[static_cast<std::size_t>(row)]({ball, state, pi});
}

}  // namespace edmill::model
