// Warnings about the results of a run. docs/report.md defines each.
#pragma once

#include <string>
#include <vector>

#include "report/run_facts.hpp"
#include "report/series.hpp"

namespace edmill::report {

struct Warning {
  std::string kind;  ///< "separation_share", "supplied_energy", "transient", "too_few_collisions",
                     ///< "wide_interval", "end_reason", "energy"
  std::string text;
};

/// @param dose_rate  batches of the milling dose rate; none when the run has no series
std::vector<Warning> warnings_of(const RunFacts& facts, const Batches& dose_rate);

}  // namespace edmill::report
