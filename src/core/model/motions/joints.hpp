// The joints of a chain, as a case gives them.
#pragma once

#include <array>
#include <vector>

#include "model/parts/swing.hpp"

namespace edmill::model {

/// Turns what comes behind it about an axis, or shifts it.
template <class Number>
struct Joint {
  bool rotates = true;
  std::array<Number, 3> axis{};         ///< in the frame of the joint before; of any length
  std::array<Number, 3> shift{};        ///< of a translation [m]
  Number angle{};                       ///< of a rotation [turns]
  Number speed{};                       ///< constant, of either sign: [turns/s], or [m/s] along the axis
  TurnFraction per_period{};            ///< of the turns in a period of the clock
  std::vector<Swing<Number>> swings{};  ///< along the axis, or about it
};

/// From the ground to the vessel, and the period of the clock.
template <class Number>
struct Joints {
  std::vector<Joint<Number>> list;
  Number period{};  ///< [s]
  /// First and last of the run: translations at constant speed are bounded between them [s].
  std::array<Number, 2> times{};
};

/// The joints with each number converted.
template <class To, class From, class Convert>
Joints<To> converted_joints(const Joints<From>& from, const Convert& convert) {
  Joints<To> to{{}, convert(from.period), {convert(from.times[0]), convert(from.times[1])}};
  for (const auto& j : from.list) {
    Joint<To> joint{j.rotates,
                    {convert(j.axis[0]), convert(j.axis[1]), convert(j.axis[2])},
                    {convert(j.shift[0]), convert(j.shift[1]), convert(j.shift[2])},
                    convert(j.angle),
                    convert(j.speed),
                    j.per_period,
                    converted_swings<To>(j.swings, convert)};
    to.list.push_back(std::move(joint));
  }
  return to;
}

}  // namespace edmill::model
