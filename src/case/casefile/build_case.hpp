// From a case as read to the values of one scalar and the balls' initial states.
#pragma once

#include <vector>

#include "base/instant.hpp"
#include "casefile/case_spec.hpp"
#include "model/case.hpp"

namespace edmill::casefile {

template <class Real>
struct InitialCase {
  model::Case<Real> the_case;
  std::vector<model::BallState<Real>> states;  ///< at `start`
  Instant<Real> start;
};

/// Values of the case in one scalar, without balls.
template <class Real>
model::Mill<Real> build_mill(const CaseSpec& spec);

/// Case and initial state in a mill, the file's or another: explicit balls first, then the batches, placed at
/// random by the case's seed.
/// @throws InputError when balls overlap, lie outside the vessel, cannot be placed, or an initial state does
/// not fit, and for what this scalar cannot resolve
/// @param resolved  whether the last of these is asked for
template <class Real>
InitialCase<Real> build_case_in(const model::Mill<Real>& mill, const CaseSpec& spec, bool resolved = true);
template <class Real>
InitialCase<Real> build_case(const CaseSpec& spec, bool resolved = true) {
  return build_case_in(build_mill<Real>(spec), spec, resolved);
}

}  // namespace edmill::casefile
