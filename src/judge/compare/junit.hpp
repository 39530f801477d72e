// Verdicts as JUnit's XML, which servers of continuous integration show.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace edmill::compare {

/// A name, and what is wrong; nothing where the text is empty.
using JunitCase = std::pair<std::string, std::string>;

/// @param suite  "edmill audit of log.csv"
std::string junit_text(const std::string& suite, const std::vector<JunitCase>& cases);

}  // namespace edmill::compare
