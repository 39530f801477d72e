// pi and, where a library has them, joint sine and cosine for the wide scalars.
#pragma once

#include <quadmath.h>

#include <boost/math/constants/constants.hpp>

#include "edmill/core/scalar_list.hpp"
#include "edmill/numerics/trigonometry.hpp"

namespace edmill::numerics {

template <>
inline float128 pi<float128>() {
  return float128(M_PIq);
}

template <>
inline mpfr50 pi<mpfr50>() {
  static const mpfr50 value = [] {
    mpfr50 p;
    mpfr_const_pi(p.backend().data(), MPFR_RNDN);
    return p;
  }();
  return value;
}

template <>
inline SinCos<float128> sin_cos<float128>(const float128& angle) {
  SinCos<float128> result;
  sincosq(angle.backend().value(), &result.sin.backend().value(), &result.cos.backend().value());
  return result;
}

template <>
inline SinCos<mpfr50> sin_cos<mpfr50>(const mpfr50& angle) {
  SinCos<mpfr50> result;
  mpfr_sin_cos(result.sin.backend().data(), result.cos.backend().data(), angle.backend().data(), MPFR_RNDN);
  return result;
}

}  // namespace edmill::numerics
