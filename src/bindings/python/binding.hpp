// How a source adds functions and classes to the module, how its functions release and take
// Python's lock, and how Ctrl-C ends long work.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <future>
#include <thread>
#include <utility>
#include <vector>

#include "base/standard_arithmetic.hpp"

namespace edmill::python {

/// The module. Its functions run with the standard arithmetic, whatever the host has chosen.
class Module : public pybind11::module_ {
 public:
  explicit Module(const pybind11::module_& m) : module_(m) {}
  /// @tparam Guard  objects that exist during the call: `Unlocked` for long work without Python
  template <class... Guard> void def(const char* name, auto&& function) {
    module_::def(name, std::forward<decltype(function)>(function),
        pybind11::call_guard<StandardArithmetic, Guard...>());
  }
};

/// Each source has one at namespace scope, `const Binding functions([](Module& m) { ... });`, and
/// no list names it. The class Case and the exceptions are in the module before.
class Binding {
 public:
  explicit Binding(void (*add)(Module&)) { all().push_back(add); }

  static void add_all(const pybind11::module_& module) {
    Module m(module);
    for (const auto add : all()) add(m);
  }
 private:
  static std::vector<void (*)(Module&)>& all() {
    static std::vector<void (*)(Module&)> bindings;
    return bindings;
  }
};

/// Calls Python from where no lock or object of Python is left to destroy. When the interpreter
/// ends, Python ends a daemon thread that waits for its lock by unwinding the stack (pthread_exit),
/// which destructors of C++ do not permit: the thread sleeps instead to the end, as in Python 3.14.
template <class Call> auto call_python(const Call& call) {
  try {
    return call();
  } catch (...) {  // never an exception of C++: `call` calls functions of C
    for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
  }
}

/// Releases Python's lock in its scope, so that other threads of Python can run.
class Unlocked {
 public:
  Unlocked() : state_(PyEval_SaveThread()) {}
  ~Unlocked() {
    call_python([this] { PyEval_RestoreThread(state_); });
  }
 private:
  PyThreadState* state_;
};

/// Holds Python's lock in its scope, so that Python can be called.
class Locked {
 public:
  Locked() : state_(call_python(PyGILState_Ensure)) {}
  ~Locked() { PyGILState_Release(state_); }
 private:
  PyGILState_STATE state_;
};

/// Lets Python's signal handlers run. @return whether Ctrl-C came
inline bool control_c_came() {
  if (call_python(PyErr_CheckSignals) == 0) return false;
  PyErr_Clear();
  return true;
}

/// The new object that a function of C returns. @throws py::error_already_set
template <class Make> pybind11::object made_by(const Make& make) {
  PyObject* made = call_python(make);
  if (!made) throw pybind11::error_already_set();
  return pybind11::reinterpret_steal<pybind11::object>(made);
}

/// Calls a callable of Python and returns its result. @throws py::error_already_set
template <class... Argument>
pybind11::object call(const pybind11::object& callable, Argument&&... argument) {
  const auto arguments = pybind11::make_tuple(std::forward<Argument>(argument)...);
  return made_by([&] { return PyObject_CallObject(callable.ptr(), arguments.ptr()); });
}

/// Calls work(flag) on a thread of its own, while this one lets Python's signal handlers run:
/// Ctrl-C sets the flag, which the work obeys, and is raised when that has ended.
auto with_interrupt(const auto& work) {
  std::atomic<bool> interrupt{false};
  auto done = std::async(std::launch::async, [&] { return work(&interrupt); });
  bool raised = false;
  for (;;) {
    {
      const Unlocked others;
      if (done.wait_for(std::chrono::milliseconds(100)) == std::future_status::ready) break;
    }
    if (control_c_came()) raised = interrupt = true;
  }
  auto result = done.get();
  if (raised) {
    PyErr_SetNone(PyExc_KeyboardInterrupt);
    throw pybind11::error_already_set();
  }
  return result;
}
/// Calls work(arguments..., options) in the same way, with the flag among the options.
auto with_interrupt(auto options, const auto& work, const auto&... arguments) {
  return with_interrupt([&](std::atomic<bool>* flag) {
    options.interrupt = flag;
    return work(arguments..., options);
  });
}

}  // namespace edmill::python
