// What edmill's own programs do with a public Run.
#pragma once

#include <functional>

#include "edmill/run.hpp"

namespace edmill {

struct RunAccess {
  /// As `Run::commit`, with work that needs the folder for itself.
  template <class Real>
  static void commit(Run<Real>& run, const std::function<void()>& when_written) {
    run.commit(when_written);
  }
};

}  // namespace edmill
