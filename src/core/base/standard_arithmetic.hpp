// The floating-point environment that bounds and reproducible bits rely on, whatever the host program uses.
#pragma once

#include <cfenv>

namespace edmill {

/// Sets the default floating-point environment until the end of the scope: rounding to nearest, subnormal
/// numbers, no traps. Then the thread gets its previous environment back. Threads that are started in the
/// scope inherit it.
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
