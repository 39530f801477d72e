// The page of a sweep or an optimisation: rates of all points with their intervals.
#pragma once

#include <string>

#include "study/study.hpp"

namespace edmill::report {

/// @param kind     "Sweep"
/// @param finding  lines of text, such as what an optimisation found; none when empty
std::string study_page(const study::Study& study, const std::string& kind, const std::string& finding);

}  // namespace edmill::report
