// The scalars of the core, in one place. Heavy: include it only where wide scalars are named.
#pragma once

#include <boost/multiprecision/eigen.hpp>

#include "base/archive.hpp"
#include "base/scalar.hpp"
#include "edmill/scalars.hpp"

namespace edmill {

template <>
struct ScalarName<float128> {
  static constexpr std::string_view value = "float128";
};
template <>
struct ScalarName<mpfr50> {
  static constexpr std::string_view value = "mpfr50";
};
template <>
struct ScalarName<mpfr100> {
  static constexpr std::string_view value = "mpfr100";
};
template <>
struct ScalarName<mpfr200> {
  static constexpr std::string_view value = "mpfr200";
};

inline void archive_value(Archive& a, float128& value) {
  a.raw(&value.backend().value(), sizeof value.backend().value());
}
/// All limbs, so that no bit depends on a conversion.
template <unsigned digits>
void archive_value(Archive& a, mpfr_of<digits>& value) {
  const auto number = value.backend().data();
  a(number->_mpfr_sign, number->_mpfr_exp);
  a.raw(number->_mpfr_d, mpfr_custom_get_size(mpfr_get_prec(number)));
}

template <>
struct WiderScalar<double> {
  using type = float128;
};
template <>
struct WiderScalar<float128> {
  using type = mpfr50;
};

}  // namespace edmill

/// Applies `MACRO(Real)` to every scalar. Adding one takes a line here, its traits above, an instantiation
/// file in src/instances and the line in the case file's table of precisions.
#define EDMILL_FOR_EACH_SCALAR(MACRO) \
  MACRO(double)                       \
  MACRO(::edmill::float128)           \
  MACRO(::edmill::mpfr50)             \
  MACRO(::edmill::mpfr100)            \
  MACRO(::edmill::mpfr200)
