// Long work that Ctrl-C ends.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <future>
#include <type_traits>

#include "python/binding.hpp"

namespace edmill::python {

/// Work on a thread of its own, while this one lets Python's signal handlers run: Ctrl-C sets the flag, which
/// the work obeys, and is raised when that has ended.
template <class Work>
std::invoke_result_t<Work> interruptible(std::atomic<bool>& interrupt, const Work& work) {
  auto done = std::async(std::launch::async, work);
  bool raised = false;
  for (;;) {
    {
      const Unlocked others;
      if (done.wait_for(std::chrono::milliseconds(100)) == std::future_status::ready) break;
    }
    if (call_python(PyErr_CheckSignals) != 0) {
      PyErr_Clear();
      raised = interrupt = true;
    }
  }
  auto result = done.get();
  if (raised) {
    PyErr_SetNone(PyExc_KeyboardInterrupt);
    throw pybind11::error_already_set();
  }
  return result;
}

}  // namespace edmill::python
