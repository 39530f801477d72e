// The arithmetic that bounds and bits rest on, whatever the host has chosen.
#pragma once

#include <cfenv>

namespace edmill {

/// Until the end of the scope numbers are rounded to nearest, with subnormal ones and without traps; then the
/// thread has its own floating-point environment again. Threads that are started in the scope inherit it.
class StandardArithmetic {
 public:
  StandardArithmetic() {
    std::fegetenv(&before_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~StandardArithmetic() { std::fesetenv(&before_); }
  StandardArithmetic(const StandardArithmetic&) = delete;
  StandardArithmetic& operator=(const StandardArithmetic&) = delete;

 private:
  std::fenv_t before_;
};

}  // namespace edmill
