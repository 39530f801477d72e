// Whether a case could have come from a file.
#pragma once

#include <string>
#include <vector>

#include "casefile/case_spec.hpp"

namespace edmill::casefile {

/// For a case whose numbers have been changed since it was read: what a file with these numbers would be
/// refused for.
std::vector<std::string> problems_of(const CaseSpec& spec);

}  // namespace edmill::casefile
