// The command `edmill report`.
#pragma once

#include <string>

namespace edmill::cli {

/// Makes the page of a run's folder and prints its path. @return an exit code
int run_report(const std::string& folder, bool quiet);

}  // namespace edmill::cli
