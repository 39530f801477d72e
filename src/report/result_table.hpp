// The result table of a run on the terminal.
#pragma once

#include <string>

#include "io/summary.hpp"

namespace edmill::report {

template <class Real>
std::string result_table(const io::Summary<Real>& summary);

}  // namespace edmill::report
