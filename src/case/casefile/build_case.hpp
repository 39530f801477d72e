// Converts a case as read from its file to one scalar type, with the initial states of its balls.
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

/// Builds the case and its initial state in a mill, which need not be that of the file: explicit balls first,
/// then the batches, placed at random by the case's seed.
/// @param resolved  check that this scalar can resolve the case
/// @throws InputError when balls overlap, lie outside the vessel or cannot be placed, an initial state does
/// not fit, or the scalar cannot resolve the case
template <class Real>
InitialCase<Real> build_case_in(const model::Mill<Real>& mill, const CaseSpec& spec, bool resolved = true);
template <class Real>
InitialCase<Real> build_case(const CaseSpec& spec, bool resolved = true) {
  return build_case_in(build_mill<Real>(spec), spec, resolved);
}

}  // namespace edmill::casefile
