// When friction rests: theory.md, section 6.
#pragma once

namespace edmill::model {

/// The least separation speed v_s bounds the impacts of a pair that nothing else touches. In a wedge of
/// several bodies friction can pass the energy that v_s supplies from pair to pair without end, at one
/// instant. So friction rests in a stall: after `impacts` impacts in a row that each came without time to
/// move, those that follow are frictionless until the ball moves again.
///
/// A ball has had no time to move when its flight was shorter than v_s / `acceleration`. Bodies that are
/// pressed together by less than that acceleration part for longer, by 2 v_s / a.
struct StallRule {
  int impacts = 32;
  int acceleration = 30000;  ///< far above that of any mill [m/s^2]

  /// @param least_separation  v_s of the law of the impact [m/s]; without one no flight is too short
  template <class Real>
  bool has_moved(const Real& flight_time, const Real& least_separation) const {
    return !(flight_time * acceleration < least_separation);
  }
};

}  // namespace edmill::model
