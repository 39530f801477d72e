// A case file with the page's settings in it.
#pragma once

#include <string>

#include "casefile/case_spec.hpp"

namespace edmill::browser {

/// The text of a case whose values are those of its settings, so that it is the same case without them. Where
/// that cannot be done line by line, settings follow as comments.
/// @param log  whether an output "collisions" is added unless the case has one
std::string text_with_values(const casefile::CaseSpec& spec, bool log);

}  // namespace edmill::browser
