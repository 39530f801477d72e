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
  Number frequency{};                   ///< of a rotation at constant speed [1/s], of either sign
  TurnFraction per_period{};            ///< of frequency times the chain's period
  std::vector<Swing<Number>> swings{};  ///< along the axis, or about it
};

/// From the ground to the vessel, and the period of the clock.
template <class Number>
struct Joints {
  std::vector<Joint<Number>> list;
  Number period{};  ///< [s]
};

/// The same with each number converted.
template <class To, class From, class Convert>
Joints<To> converted_joints(const Joints<From>& from, const Convert& convert) {
  Joints<To> to{{}, convert(from.period)};
  for (const auto& j : from.list) {
    Joint<To> joint{j.rotates,
                    {convert(j.axis[0]), convert(j.axis[1]), convert(j.axis[2])},
                    {convert(j.shift[0]), convert(j.shift[1]), convert(j.shift[2])},
                    convert(j.angle),
                    convert(j.frequency),
                    j.per_period,
                    converted_swings<To>(j.swings, convert)};
    to.list.push_back(std::move(joint));
  }
  return to;
}

}  // namespace edmill::model
