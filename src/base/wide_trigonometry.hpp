// pi and, where a library has them, joint sine and cosine for the wide scalars.
#pragma once

#include <quadmath.h>

#include <boost/math/constants/constants.hpp>

#include "base/scalar_list.hpp"
#include "base/trigonometry.hpp"

namespace edmill::numerics {

template <>
struct Trigonometry<float128> {
  static float128 pi() { return float128(M_PIq); }
  static SinCos<float128> sin_cos(const float128& angle) {
    SinCos<float128> result;
    sincosq(angle.backend().value(), &result.sin.backend().value(), &result.cos.backend().value());
    return result;
  }
};

template <unsigned digits>
struct Trigonometry<mpfr_of<digits>> {
  using Real = mpfr_of<digits>;
  static Real pi() {
    static const Real value = [] {
      Real p;
      mpfr_const_pi(p.backend().data(), MPFR_RNDN);
      return p;
    }();
    return value;
  }
  static SinCos<Real> sin_cos(const Real& angle) {
    SinCos<Real> result;
    mpfr_sin_cos(result.sin.backend().data(), result.cos.backend().data(), angle.backend().data(), MPFR_RNDN);
    return result;
  }
};

}  // namespace edmill::numerics
