// The quantities of one ball at one instant that outputs can show (thesis D.4.7): one row each, defined here.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "edmill/core/vector.hpp"
#include "edmill/model/ball.hpp"

namespace edmill::model {

struct BallVariable {
  std::string_view name, thesis, unit, meaning;
};

inline constexpr std::array ball_variables{
    BallVariable{"density", "dDensity", "kg/m3", "density"},
    BallVariable{"mass", "dMass", "kg", "mass"},
    BallVariable{"reduced_inertia", "dReducedMOI", "1", "moment of inertia over mass and radius squared"},
    BallVariable{"inertia", "dMOI", "kg m2", "moment of inertia"},
    BallVariable{"speed", "dTransSpeed", "m/s", "speed"},
    BallVariable{"spin", "dRotSpeed", "rad/s", "spin"},
    BallVariable{"translational_energy", "dTransEnergy", "J", "kinetic energy of the centre's motion"},
    BallVariable{"spin_energy", "dRotEnergy", "J", "kinetic energy of the spin"},
    BallVariable{"energy", "dTotalEnergy", "J", "both"},
};

inline std::optional<int> find_ball_variable(std::string_view name) {
  for (int k = 0; k < static_cast<int>(ball_variables.size()); ++k)
    if (ball_variables[k].name == name || ball_variables[k].thesis == name) return k;
  return std::nullopt;
}

/// Value of a row of `ball_variables`.
/// @param pi  of the scalar
template <class Real>
Real ball_variable(int row, const BallProperties<Real>& ball, const BallState<Real>& state, const Real& pi) {
  const Real inertia = ball.reduced_inertia * ball.mass * ball.radius * ball.radius;
  const auto translational = [&] { return Real(ball.mass / 2 * squared_norm<Real>(state.velocity)); };
  const auto rotational = [&] { return Real(inertia / 2 * squared_norm<Real>(state.spin)); };
  switch (row) {
    case 0:
      return ball.mass / (4 * pi / 3 * ball.radius * ball.radius * ball.radius);
    case 1:
      return ball.mass;
    case 2:
      return ball.reduced_inertia;
    case 3:
      return inertia;
    case 4:
      return norm<Real>(state.velocity);
    case 5:
      return norm<Real>(state.spin);
    case 6:
      return translational();
    case 7:
      return rotational();
    default:
      return translational() + rotational();
  }
}

}  // namespace edmill::model
