// pi and, where a library has them, joint sine and cosine for the wide scalars.
#pragma once

#include <quadmath.h>

#include <boost/math/constants/constants.hpp>

#include "base/scalar_list.hpp"
#include "base/trigonometry.hpp"

namespace edmill::numerics {

template <>
inline float128 pi<float128>() {
  return float128(M_PIq);
}

template <>
inline SinCos<float128> sin_cos<float128>(const float128& angle) {
  SinCos<float128> result;
  sincosq(angle.backend().value(), &result.sin.backend().value(), &result.cos.backend().value());
  return result;
}

namespace detail {

template <class Real>
Real mpfr_pi() {
  static const Real value = [] {
    Real p;
    mpfr_const_pi(p.backend().data(), MPFR_RNDN);
    return p;
  }();
  return value;
}

template <class Real>
SinCos<Real> mpfr_sin_and_cos(const Real& angle) {
  SinCos<Real> result;
  mpfr_sin_cos(result.sin.backend().data(), result.cos.backend().data(), angle.backend().data(), MPFR_RNDN);
  return result;
}

}  // namespace detail

#define EDMILL_MPFR_TRIGONOMETRY(Real)                   \
  template <>                                            \
  inline Real pi<Real>() {                               \
    return detail::mpfr_pi<Real>();                      \
  }                                                      \
  template <>                                            \
  inline SinCos<Real> sin_cos<Real>(const Real& angle) { \
    return detail::mpfr_sin_and_cos<Real>(angle);        \
  }
EDMILL_MPFR_TRIGONOMETRY(mpfr50)
EDMILL_MPFR_TRIGONOMETRY(mpfr100)
EDMILL_MPFR_TRIGONOMETRY(mpfr200)
#undef EDMILL_MPFR_TRIGONOMETRY

}  // namespace edmill::numerics
