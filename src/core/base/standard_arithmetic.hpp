// The floating-point environment that bounds and reproducible bits rely on, whatever the host's.
#pragma once

#include <cfenv>

namespace edmill {

/// Sets the default floating-point environment in a scope: rounding to nearest, subnormal numbers,
/// no traps. Threads that are started in the scope inherit it.
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
