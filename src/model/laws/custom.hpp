// A contact law that a program brings along.
#pragma once

#include <memory>

#include "edmill/contact_law.hpp"

namespace edmill::model {

/// It has no name in case files. In another scalar it is empty: searches, which are what the ladder does in
/// wider scalars, ask no law.
template <class Real>
struct LawOfProgram {
  static constexpr const char* name = "custom";

  std::shared_ptr<const edmill::CustomLaw<Real>> law;

  template <class Law, class Visit>
  static void parameters(Law&, Visit&&) {}

  Real restitution(const Real& approach_speed) const { return law->restitution(approach_speed); }
  Real restitution_of_slip(const Real& normal_change, const Real& slip_speed, const Real& compliance) const {
    return law->restitution_of_slip(normal_change, slip_speed, compliance);
  }
};

}  // namespace edmill::model
