// Implementation of Quantity::to; included by the instantiation files only.
#pragma once

#include "edmill/casefile/quantity.hpp"
#include "edmill/core/scalar_list.hpp"

namespace edmill::casefile {

template <class Real>
Real Quantity::to() const {
  // Twice the digits and more, so that the last rounding is the only one that counts.
  using Wide = mpfr_of<2 * std::numeric_limits<Real>::digits10 + 20>;
  Wide result = Wide(numerator(value).str()) / Wide(denominator(value).str());
  Wide pi;
  mpfr_const_pi(pi.backend().data(), MPFR_RNDN);
  for (int k = 0; k < pi_power; ++k) result *= pi;
  for (int k = 0; k > pi_power; --k) result /= pi;
  return static_cast<Real>(result);
}

}  // namespace edmill::casefile
