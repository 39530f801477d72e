// Restitution models: how much of the approach and slip speed an impact gives back. (2.23), (2.24)
#pragma once

#include "edmill/core/instant.hpp"

namespace edmill::model {

template <class Real>
struct Restitution {
  Real normal;      ///< e_n in [0, 1]
  Real tangential;  ///< e_t in [-1, 1]
};

enum class ContactModel {
  walton_braun,  ///< Coulomb sliding with a lowest tangential restitution; (2.24) for balls of any mass
  constant,      ///< both restitutions given
};

/// A new law is a new enumerator here, a branch in `restitution` and a row in casefile/contact_table.cpp.
template <class Real>
struct ContactLaw {
  ContactModel model = ContactModel::walton_braun;
  Real restitution_normal{1};
  Real restitution_tangential{1};  ///< of `constant`
  Real friction{0};                ///< mu of `walton_braun`
  Real min_tangential{-1};         ///< lowest e_t of `walton_braun`
  Real collapse_time{0};           ///< t_c [s]; zero turns the rule off

  /// @param approach_speed  |g_n| > 0 [m/s]
  /// @param slip_speed      |g_t| >= 0 [m/s]
  /// @param compliance      1 + M/(m_i J_i) + M/(m_j J_j), for a wall 1 + 1/J_i; makes the tangential impulse
  ///                        exactly mu times the normal impulse while sliding (theory.md, section 5)
  /// @param collapsing      an impact within t_c of a previous one of either body: e_n is 1, the tangential
  ///                        law is kept with that e_n
  /// @param resting         in collapse despite t_c (theory.md, section 6): neither component loses anything
  Restitution<Real> restitution(const Real& approach_speed, const Real& slip_speed, const Real& compliance,
                                bool collapsing, bool resting = false) const {
    if (resting) return {Real(1), Real(1)};
    const Real normal = collapsing ? Real(1) : restitution_normal;
    if (model == ContactModel::constant) return {normal, restitution_tangential};
    const Real sliding = friction * (1 + normal) * compliance * approach_speed;
    // 1 - sliding / slip >= min_tangential, without dividing by a vanishing slip.
    if (sliding >= (1 - min_tangential) * slip_speed)
      return {normal, slip_speed > 0 ? min_tangential : Real(1)};
    return {normal, 1 - sliding / slip_speed};
  }
};

}  // namespace edmill::model
