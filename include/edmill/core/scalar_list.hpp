// The scalars of the core, in one place. Heavy: include it only where wide scalars are named.
#pragma once

#include <boost/multiprecision/float128.hpp>
#include <boost/multiprecision/mpfr.hpp>
//
#include <boost/multiprecision/eigen.hpp>

#include "edmill/core/scalar.hpp"

namespace edmill {

using float128 = boost::multiprecision::float128;
using mpfr50 = boost::multiprecision::number<
    boost::multiprecision::mpfr_float_backend<50, boost::multiprecision::allocate_stack>,
    boost::multiprecision::et_off>;

template <>
struct ScalarName<float128> {
  static constexpr std::string_view value = "float128";
};
template <>
struct ScalarName<mpfr50> {
  static constexpr std::string_view value = "mpfr50";
};

template <>
struct WiderScalar<double> {
  using type = float128;
};
template <>
struct WiderScalar<float128> {
  using type = mpfr50;
};
template <>
struct WiderScalar<mpfr50> {
  using type = void;
};

}  // namespace edmill

/// Applies `MACRO(Real)` to every scalar. Adding one takes a line here, its traits above, an instantiation
/// file in src/instances and the line in the case file's table of precisions.
#define EDMILL_FOR_EACH_SCALAR(MACRO) \
  MACRO(double)                       \
  MACRO(::edmill::float128)           \
  MACRO(::edmill::mpfr50)
