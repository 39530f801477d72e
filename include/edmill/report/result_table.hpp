// The result table of a run on the terminal.
#pragma once

#include <string>

#include "edmill/record/summary.hpp"

namespace edmill::report {

template <class Real>
std::string result_table(const record::Summary<Real>& summary);

}  // namespace edmill::report
