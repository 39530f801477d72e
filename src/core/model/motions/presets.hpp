// The mills that a case can name, by their usual parameters. Vertical is Y; the axis of a jar is
// its y.
#pragma once

#include "model/motions/joints.hpp"
#include "model/motions/spex.hpp"
#include "model/parts/parameter.hpp"

namespace edmill::model {

template <class Number> Joint<Number> axis_joint(bool rotates, std::size_t axis) {
  Joint<Number> joint;
  joint.rotates = rotates;
  joint.axis[axis] = Number{1};
  return joint;
}

/// [mill] type = "chain": joints as the case lists them.
template <class Number> struct Chain {
  static constexpr const char* name = "chain";
  Joints<Number> given;

  static void parameters(auto& part, auto&& visit) {
    for (auto& joint : part.given.list) {
      visit(Parameter{joint.rotates ? "rotate" : "translate", Dimension::none, ""}, joint.axis);
      visit(Parameter{"shift", Dimension::length, ""}, joint.shift);
      visit(Parameter{"angle", Dimension::angle, ""}, joint.angle);
      visit(Parameter{"speed", joint.rotates ? Dimension::angular_speed : Dimension::speed, ""},
          joint.speed);
      for (auto& swing : joint.swings)
        for (auto* number : {&swing.amplitude, &swing.frequency, &swing.phase})
          visit(Parameter{"swing", ""}, *number);
    }
  }
  Joints<Number> joints() const { return given; }
};

/// [mill] type = "planetary": a jar on a disc, both about vertical axes. In most mills `ratio` is
/// negative. Source: Burgio et al., Il Nuovo Cimento D 13 (1991) 459, whose jar turns against the
/// disc.
template <class Number> struct Planetary {
  static constexpr const char* name = "planetary";
  Number radius, period, ratio;

  static void parameters(auto& part, auto&& visit) {
    visit(positive_length("radius", "distance from the axis of the disc to the centre of the jar"),
        part.radius);
    visit(Parameter{"speed", Dimension::angular_speed, "speed of the disc, about Y", Range::drive},
        part.period);
    visit(Parameter{"ratio",
              "speed of the jar relative to the disc, divided by that of the disc: negative if "
              "the jar turns the other way, -1 if it keeps its orientation in space"},
        part.ratio);
  }
  Joints<Number> joints() const {
    auto disc = axis_joint<Number>(true, 1), arm = axis_joint<Number>(false, 0),
         jar = axis_joint<Number>(true, 1);
    disc.speed = Number{1} / period;
    arm.shift[0] = radius;
    jar.speed = ratio / period;
    return {{disc, arm, jar}, period};
  }
};

/// [mill] type = "drum": a vessel that turns about its y axis, which is horizontal, along Z.
template <class Number> struct Drum {
  static constexpr const char* name = "drum";
  Number period;

  static void parameters(auto& part, auto&& visit) {
    visit(Parameter{"speed", Dimension::angular_speed,
              "speed of the drum about its y axis, which is horizontal along Z", Range::drive},
        part.period);
  }
  Joints<Number> joints() const {
    auto lying = axis_joint<Number>(true, 0), turning = axis_joint<Number>(true, 1);
    lying.angle = Number{1} / Number{4};
    turning.speed = Number{1} / period;
    return {{lying, turning}, period};
  }
};

/// [mill] type = "vibratory": the vessel's centre is at A sin(phase) + B cos(phase), its axes stay.
/// One vector makes a line, two a circle or an ellipse.
template <class Number> struct Vibratory {
  static constexpr const char* name = "vibratory";
  std::array<Number, 3> amplitude, quarter;
  Number period;

  static void parameters(auto& part, auto&& visit) {
    visit(Parameter{"amplitude", Dimension::length,
              "amplitude A in the position of the centre, A sin(w t) + B cos(w t)"},
        part.amplitude);
    visit(Parameter{"amplitude_quarter", Dimension::length,
              "amplitude B in the position of the centre", Range::any, "0 m"},
        part.quarter);
    visit(Parameter{"speed", Dimension::angular_speed, "speed of the drive", Range::drive},
        part.period);
  }
  Joints<Number> joints() const {
    Joints<Number> chain{{}, period};
    const Number frequency = Number{1} / period;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      auto joint = axis_joint<Number>(false, axis);
      joint.swings.push_back({amplitude[axis], frequency, Number{}});
      joint.swings.push_back({quarter[axis], frequency, Number{1} / Number{4}});
      chain.list.push_back(joint);
    }
    return chain;
  }
};

/// The SPEX as a chain: it turns about z by theta = theta_max cos(w t) + pi/2, goes the arm's
/// length along x, turns about x by gamma = gamma_max sin(w t). (2.2), (2.5), (2.7')
/// @param theta_max, gamma_max  [turns]
template <class Number>
Joints<Number> spex_joints(
    const Number& arm, const Number& theta_max, const Number& gamma_max, const Number& period) {
  const Number frequency = Number{1} / period, quarter = Number{1} / Number{4};
  auto theta = axis_joint<Number>(true, 2), gamma = axis_joint<Number>(true, 0);
  const Joint<Number> shift{.rotates = false, .shift = {arm}};
  theta.angle = quarter;
  theta.swings.push_back({theta_max, frequency, quarter});
  gamma.swings.push_back({gamma_max, frequency, Number{}});
  return {{theta, shift, gamma}, period};
}

namespace detail {

inline constexpr Parameter spex_arm{"arm", Dimension::length,
    "distance from the fulcrum to the centre of the vessel", Range::not_negative, "100 mm"};
inline constexpr Parameter spex_theta{"theta_max", Dimension::angle,
    "amplitude of the swing of the arm, thesis (2.9)", Range::quarter_turn, "15 deg"};
inline constexpr Parameter spex_gamma{"gamma_max", Dimension::angle,
    "amplitude of the rotation about the arm, thesis (2.9)", Range::quarter_turn, "15 deg"};
inline constexpr Parameter spex_speed{
    "speed", Dimension::angular_speed, "speed of the drive", Range::drive, "1098 rpm"};
inline constexpr Parameter no_angle{nullptr, Dimension::angle, "", Range::any, "0 rad"};

/// The parameters of SPEX mills. Each of these mills defines `keys` for the four.
template <class Number> struct SpexSizes {
  Number arm, theta_max, gamma_max, period;

  static void parameters(auto& part, auto&& visit) {
    const auto* key = part.keys;
    for (auto* number : {&part.arm, &part.theta_max, &part.gamma_max, &part.period})
      visit(*key++, *number);
  }
  SpexMotion<Number> motion() const { return {arm, theta_max, gamma_max, period}; }
};

}  // namespace detail

/// [mill] type = "spex8000", with the machine's sizes of Barahona 2011, appendix B.
template <class Number> struct Spex8000 : detail::SpexSizes<Number> {
  static constexpr const char* name = "spex8000";
  static constexpr Parameter keys[] = {
      detail::spex_arm, detail::spex_theta, detail::spex_gamma, detail::spex_speed};
};

/// [mill] type = "spex_2d": the swing of the arm alone, with the thesis's sizes. A planar model of
/// this mill is that of Davis, McDermott and Koch, Metall. Trans. A 19 (1988) 2867.
template <class Number> struct Spex2d : detail::SpexSizes<Number> {
  static constexpr const char* name = "spex_2d";
  static constexpr Parameter keys[] = {
      detail::spex_arm, detail::spex_theta, detail::no_angle, detail::spex_speed};
};

/// [mill] type = "still".
template <class Number> struct StillMill : detail::SpexSizes<Number> {
  static constexpr const char* name = "still";
  static constexpr Parameter keys[] = {
      {"arm", Dimension::length,
          "distance from the fulcrum to the centre of the vessel, whose "
          "x axis is the laboratory's Y and whose y axis is -X",
          Range::not_negative, "0 m"},
      detail::no_angle, detail::no_angle,
      {nullptr, Dimension::time, "", Range::positive, "0.0625 s"}};
};

}  // namespace edmill::model
