// Roots with the same bits everywhere: powers by pow() differ between libraries.
#pragma once

#include <cmath>

namespace edmill::numerics {

/// x^(1/5) to a few roundings, by arithmetic alone. @pre x >= 0
template <class Real>
Real fifth_root(const Real& x) {
  using std::frexp;
  using std::ldexp;
  if (!(x > 0)) return Real(0);
  int exponent;
  Real m = frexp(x, &exponent);
  const int whole = (exponent - (exponent % 5 + 5) % 5) / 5;
  m = ldexp(m, exponent - 5 * whole);  // in [1/2, 16)
  // The tangent of the root at 1 lies above it, and from above Newton's method falls until rounding ends it.
  for (Real y = (m + 4) / 5;;) {
    const Real square = y * y, next = (4 * y + m / (square * square)) / 5;
    if (!(next < y)) return ldexp(y, whole);
    y = next;
  }
}

}  // namespace edmill::numerics
