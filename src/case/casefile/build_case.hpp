// Converts a case as read from its file to one scalar type, with the initial states of its balls.
#pragma once

#include <vector>

#include "base/instant.hpp"
#include "casefile/case_spec.hpp"
#include "model/case.hpp"

namespace edmill::casefile {

template <class Real> struct InitialCase {
  model::Case<Real> the_case;
  std::vector<model::BallState<Real>> states;  ///< at `start`
  Instant<Real> start;
};

/// Values of the case in one scalar, without balls.
template <class Real> model::Mill<Real> build_mill(const CaseSpec& spec);

/// Builds the case and its initial state in a mill, which need not be that of the file: explicit
/// balls first, then the batches, placed at random by the case's seed.
/// @param resolved  check that this scalar can resolve the case
/// @throws InputError when balls do not fit, or the scalar cannot resolve the case
template <class Real>
InitialCase<Real> build_case_in(
    const model::Mill<Real>& mill, const CaseSpec& spec, bool resolved = true);
template <class Real> InitialCase<Real> build_case(const CaseSpec& spec, bool resolved = true) {
  return build_case_in(build_mill<Real>(spec), spec, resolved);
}

/// Volume of the vessel outside of the bodies at an instant [m3], by 20 000 points, to about 1 %.
double free_volume(const model::Mill<double>& mill, const Instant<double>& when);

/// Where a moving body comes so near to a wall or a body that no ball passes between them.
struct NarrowGap {
  std::string one, other;
  double width;  ///< the least [m]; 0 if they touch
  double time;   ///< of it [s]
};
/// All such places in a cycle of the slowest joint, or up to the end of the run. No gap changes
/// faster than both sides move: no passage is missed. Joined bodies are left out.
std::vector<NarrowGap> narrow_gaps(const CaseSpec& spec, const model::Mill<double>& mill);

}  // namespace edmill::casefile
