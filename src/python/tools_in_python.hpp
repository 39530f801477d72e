// Studies, judges and reports for Python. They run on a thread of their own, so that Ctrl-C can end them.
#pragma once

#include <pybind11/pybind11.h>

namespace edmill::python {

/// `sweep`, `optimize`, `compare`, `audit` and `report`.
void add_tools(pybind11::module_& m);

}  // namespace edmill::python
