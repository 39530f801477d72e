// A case in double from its initial state to its summary, without files.
#pragma once

#include <optional>
#include <string>

#include "base/errors.hpp"
#include "casefile/build_case.hpp"
#include "run/run_driver.hpp"

namespace edmill {

/// A decision that no scalar could make is reported in the summary.
/// @param observer  notified of every impact
/// @pre `built` was made of `spec`
inline io::Summary<double> simulated(const casefile::CaseSpec& spec,
    const casefile::InitialCase<double>& built, engine::Observer<double>* observer = nullptr) {
  run::Guests<double> guests;
  if (observer) guests.observers.push_back(observer);
  std::optional<run::RunDriver<double>> driver;
  auto end_reason = model::EndReason::undecided;
  std::string error;
  try {
    driver.emplace(built, guests);
    end_reason = driver->go();
  } catch (const UndecidedError& undecided) {
    error = undecided.what();
  }
  auto summary = run::summary_of(spec, built, driver);
  run::finish_summary(summary, end_reason, error);
  return summary;
}

}  // namespace edmill
