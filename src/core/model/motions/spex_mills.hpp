// The mills of the case file that move as a SPEX does, or not at all.
#pragma once

#include "model/motions/spex.hpp"
#include "model/parts/parameter.hpp"

namespace edmill::model {

namespace detail {

inline constexpr Parameter spex_arm{"arm", Dimension::length, "from the fulcrum to the centre of the vessel",
                                    Range::not_negative, "100 mm"};
inline constexpr Parameter spex_theta{"theta_max", Dimension::angle,
                                      "amplitude of the swing of the arm, thesis (2.9)", Range::quarter_turn,
                                      "15 deg"};
inline constexpr Parameter spex_gamma{"gamma_max", Dimension::angle,
                                      "amplitude of the rotation about the arm, thesis (2.9)",
                                      Range::quarter_turn, "15 deg"};
inline constexpr Parameter spex_speed{"speed", Dimension::angular_speed, "of the drive", Range::drive,
                                      "1098 rpm"};
inline constexpr Parameter no_angle{nullptr, Dimension::angle, "", Range::any, "0 rad"};

template <class Number>
struct SpexSizes {
  Number arm, theta_max, gamma_max, period;

  SpexMotion<Number> motion() const { return {arm, theta_max, gamma_max, period}; }
};

}  // namespace detail

/// [mill] type = "spex8000", with the machine's sizes of Barahona 2011, appendix B.
template <class Number>
struct Spex8000 : detail::SpexSizes<Number> {
  static constexpr const char* name = "spex8000";

  static void parameters(auto& part, auto&& visit) {
    visit(detail::spex_arm, part.arm);
    visit(detail::spex_theta, part.theta_max);
    visit(detail::spex_gamma, part.gamma_max);
    visit(detail::spex_speed, part.period);
  }
};

/// [mill] type = "spex_2d": the swing of the arm alone, in a plane. A planar model of this mill is that of
/// Davis, McDermott and Koch, Metall. Trans. A 19 (1988) 2867; the lengths and angles are the thesis's.
template <class Number>
struct Spex2d : detail::SpexSizes<Number> {
  static constexpr const char* name = "spex_2d";

  static void parameters(auto& part, auto&& visit) {
    visit(detail::spex_arm, part.arm);
    visit(detail::spex_theta, part.theta_max);
    visit(detail::no_angle, part.gamma_max);
    visit(detail::spex_speed, part.period);
  }
};

/// [mill] type = "still".
template <class Number>
struct StillMill : detail::SpexSizes<Number> {
  static constexpr const char* name = "still";

  static void parameters(auto& part, auto&& visit) {
    visit(Parameter{"arm", Dimension::length, "from the fulcrum to the centre of the vessel",
                    Range::not_negative, "0 m"},
          part.arm);
    visit(detail::no_angle, part.theta_max);
    visit(detail::no_angle, part.gamma_max);
    visit(Parameter{nullptr, Dimension::time, "", Range::positive, "0.0625 s"}, part.period);
  }
};

}  // namespace edmill::model
