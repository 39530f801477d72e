// Contact laws: how fast two bodies leave an impact, and how much of their slip is left. (2.23'), (2.24')
#pragma once

namespace edmill::model {

enum class ContactModel {
  walton_braun,  ///< Coulomb sliding with a lowest tangential restitution; (2.24') for balls of any mass
  constant,      ///< both restitutions given
};

/// A new law is a new enumerator here, a branch in `restitution_of_slip` and a row in
/// casefile/contact_spec.cpp.
template <class Real>
struct ContactLaw {
  ContactModel model = ContactModel::walton_braun;
  Real restitution_normal{1};      ///< e_n in [0, 1]
  Real restitution_tangential{1};  ///< of `constant`, in [-1, 1]
  Real friction{0};                ///< mu of `walton_braun`
  Real min_tangential{-1};         ///< lowest e_t of `walton_braun`
  Real least_separation{0};        ///< v_s [m/s]: bodies leave an impact no slower; theory.md, section 6

  /// Speed at which the contact points leave each other along the normal, max(e_n |g_n|, v_s) [m/s]. (2.23')
  /// @param approach_speed  |g_n| >= 0 [m/s]
  Real separation_speed(const Real& approach_speed) const {
    const Real by_restitution = restitution_normal * approach_speed;
    return by_restitution < least_separation ? least_separation : by_restitution;
  }

  /// e_t, the part of the slip that an impact leaves, in [-1, 1]. (2.24')
  /// @param normal_change  |g_n| + g_n' >= 0 [m/s]: the normal impulse over the effective mass
  /// @param slip_speed     |g_t| >= 0 [m/s]
  /// @param compliance     1 + M/(m_i J_i) + M/(m_j J_j), for a wall 1 + 1/J_i; makes the tangential impulse
  ///                       exactly mu times the normal impulse while sliding (theory.md, section 5)
  Real restitution_of_slip(const Real& normal_change, const Real& slip_speed, const Real& compliance) const {
    if (model == ContactModel::constant) return restitution_tangential;
    const Real sliding = friction * compliance * normal_change;
    // 1 - sliding / slip >= min_tangential, without dividing by a vanishing slip.
    if (sliding >= (1 - min_tangential) * slip_speed) return slip_speed > 0 ? min_tangential : Real(1);
    return 1 - sliding / slip_speed;
  }
};

}  // namespace edmill::model
