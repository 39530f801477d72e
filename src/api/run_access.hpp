// What edmill's own programs do with a public Run.
#pragma once

#include <functional>
#include <string>

#include "edmill/run.hpp"

namespace edmill {

struct RunAccess {
  /// As `Run::commit`, with another case.toml, and work that needs the folder for itself.
  template <class Real>
  static void commit(Run<Real>& run, const std::string& case_text,
                     const std::function<void()>& when_written) {
    run.commit(case_text, when_written);
  }
};

}  // namespace edmill
