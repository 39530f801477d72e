// A contact law that a program brings along.
#pragma once

#include <memory>

#include "base/scalar.hpp"
#include "edmill/contact_law.hpp"
#include "edmill/errors.hpp"

namespace edmill::model {

/// It has no name in case files. In another scalar it is empty: searches, which are what the ladder does in
/// wider scalars, ask no law.
template <class Real>
struct LawOfProgram {
  static constexpr const char* name = "custom";

  std::shared_ptr<const edmill::CustomLaw<Real>> law;

  static void parameters(auto&, auto&&) {}

  /// @throws InputError unless the program's answer is in [0, 1]
  Real restitution(const Real& approach_speed) const {
    const Real e = law->restitution(approach_speed);
    if (!(e >= 0 && e <= 1))
      throw InputError("contact law of the program: restitution(" + to_text<Real>(approach_speed) +
                       "): found " + to_text<Real>(e) + ", expected 0 to 1");
    return e;
  }
  /// Measured contacts may reverse a little more than the slip; whether an impact gains energy by that is
  /// checked when all of it is known.
  /// @throws InputError unless the program's answer is in [-1.5, 1]
  Real restitution_of_slip(const Real& normal_change, const Real& slip_speed, const Real& compliance) const {
    const Real e = law->restitution_of_slip(normal_change, slip_speed, compliance);
    if (!(e >= -1.5 && e <= 1))
      throw InputError("contact law of the program: restitution_of_slip(" + to_text<Real>(normal_change) +
                       ", " + to_text<Real>(slip_speed) + ", " + to_text<Real>(compliance) + "): found " +
                       to_text<Real>(e) + ", expected -1.5 to 1");
    return e;
  }
};

}  // namespace edmill::model
