// A contact law of the user's own.
#pragma once

namespace edmill {

/// How fast two bodies leave an impact, and how much of their slip is left. edmill keeps bodies from leaving
/// slower than the case's least separation speed, whatever the law says (docs/theory.md, section 6).
/// Answers beyond their ranges, and impacts that gain energy by them, end the run with an InputError.
template <class Real>
class CustomLaw {
 public:
  virtual ~CustomLaw() = default;

  /// e_n in [0, 1]. @param approach_speed  |g_n| >= 0 [m/s]
  virtual Real restitution(const Real& approach_speed) const = 0;

  /// e_t, the part of the slip that is left, in [-1, 1]; beyond that the impact adds energy. (2.24')
  /// @param normal_change  |g_n| + g_n' >= 0 [m/s]: the normal impulse over the effective mass
  /// @param slip_speed     |g_t| >= 0 [m/s]
  /// @param compliance     1 + M/(m_i J_i) + M/(m_j J_j), for a wall 1 + 1/J_i; the tangential impulse over
  ///                       the effective mass is (1 - e_t) |g_t| / compliance
  virtual Real restitution_of_slip(const Real& normal_change, const Real& slip_speed,
                                   const Real& compliance) const = 0;
};

}  // namespace edmill
