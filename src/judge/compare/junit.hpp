// Verdicts as JUnit's XML, which servers of continuous integration show.
#pragma once

#include <string>
#include <vector>

namespace edmill::compare {

struct JunitCase {
  std::string name;
  std::string problem = {};     ///< empty where there is none
  std::string not_judged = {};  ///< why it was skipped, if so
};

/// @param suite  "edmill audit of log.csv"
std::string junit_text(const std::string& suite, const std::vector<JunitCase>& cases);

}  // namespace edmill::compare
