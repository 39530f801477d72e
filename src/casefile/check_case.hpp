// Whether a case could have come from a file.
#pragma once

#include <string>
#include <vector>

#include "casefile/case_spec.hpp"

namespace edmill::casefile {

/// What the file of a case would be refused for, whose numbers have been changed since it was read.
std::vector<std::string> problems_of(const CaseSpec& spec);

}  // namespace edmill::casefile
