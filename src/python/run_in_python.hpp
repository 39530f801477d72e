// Runs for Python: what a run gathers, and callables as observers, laws and progress.
#pragma once

#include <pybind11/pybind11.h>

namespace edmill::python {

/// `run`, and the classes that its callables see.
void add_runs(pybind11::module_& m);

}  // namespace edmill::python
