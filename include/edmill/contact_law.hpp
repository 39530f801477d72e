// A user-defined contact law.
#pragma once

namespace edmill {

/// A user-defined contact law: the normal restitution of an impact and the part of the slip that
/// remains. Whatever the law returns, bodies separate no slower than the least separation speed of
/// the case (docs/theory.md, section 6). A value outside its range, or an impact that gains energy,
/// ends the run with an InputError.
template <class Real> class CustomLaw {
 public:
  virtual ~CustomLaw() = default;

  /// e_n in [0, 1]. @param approach_speed  |g_n| >= 0 [m/s]
  virtual Real restitution(const Real& approach_speed) const = 0;

  /// e_t, the ratio of the slip after to the slip before the impact, in [-1, 1]; beyond that the
  /// impact adds energy. (2.24')
  /// @param normal_change  |g_n| + g_n' >= 0 [m/s]: the normal impulse over the effective mass
  /// @param slip_speed     |g_t| >= 0 [m/s]
  /// @param compliance     1 + M/(m_i J_i) + M/(m_j J_j), for a wall 1 + 1/J_i; the tangential
  /// impulse over
  ///                       the effective mass is (1 - e_t) |g_t| / compliance
  virtual Real restitution_of_slip(
      const Real& normal_change, const Real& slip_speed, const Real& compliance) const = 0;
};

}  // namespace edmill
