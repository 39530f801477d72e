// How a source adds functions and classes to the module.
#pragma once

#include <pybind11/pybind11.h>

namespace edmill::python {

/// Each source has one at namespace scope, `const Binding functions([](py::module_& m) { ... });`, and no
/// list names it. The class Case and the exceptions are in the module before.
class Binding {
 public:
  explicit Binding(void (*add)(pybind11::module_&)) : add_(add), next_(first()) { first() = this; }

  static void add_all(pybind11::module_& m) {
    for (const Binding* b = first(); b; b = b->next_) b->add_(m);
  }

 private:
  static const Binding*& first() {
    static const Binding* binding = nullptr;
    return binding;
  }

  void (*add_)(pybind11::module_&);
  const Binding* next_;
};

}  // namespace edmill::python
