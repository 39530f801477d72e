// What of a run is not to be trusted, and why.
#pragma once

#include <optional>
#include <vector>

#include "io/summary.hpp"

namespace edmill::run {

/// @param wanted_precision  of the dose rate, relative
std::vector<io::Warning> warnings_of(const io::Facts& summary, const std::optional<double>& wanted_precision);

}  // namespace edmill::run
