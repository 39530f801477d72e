// The result table of a run on the terminal.
#pragma once

#include <string>

#include "io/summary.hpp"

namespace edmill::report {

std::string result_table(const io::Summary<double>& summary);

}  // namespace edmill::report
