// One case from its initial state to its summary, without files and without the terminal.
#pragma once

#include <atomic>
#include <vector>

#include "edmill/core/instant.hpp"
#include "edmill/engine/observer.hpp"
#include "edmill/record/final_state.hpp"
#include "edmill/record/summary.hpp"
#include "edmill/setup/build_case.hpp"

namespace edmill::driver {

template <class Real>
struct Guests {
  std::vector<engine::Observer<Real>*> observers;  ///< told of every impact, in this order
  const std::atomic<bool>* interrupt = nullptr;    ///< ends the run when it becomes true
};

template <class Real>
struct Result {
  record::Summary<Real> summary;
  record::SavedState<Real> saved;  ///< at the end of the run
};

/// Runs `built` to the end that `spec` asks for. A decision that no scalar could make is told in the summary.
/// @pre `built` was made of `spec`
template <class Real>
Result<Real> simulate(const casefile::CaseSpec& spec, const setup::InitialCase<Real>& built,
                      const Guests<Real>& guests);

}  // namespace edmill::driver
