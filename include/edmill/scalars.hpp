// The scalars of a run. Slow to compile; `Run<double>` does not need this header.
#pragma once

// float128 is IEEE's binary128, rounded to nearest: its results are the same bits on every machine.
// On x86-64 it is a type of the compiler; elsewhere, or if EDMILL_PORTABLE_FLOAT128 is defined, a
// class of Boost.
#if defined(__x86_64__) && defined(__SIZEOF_FLOAT128__) && !defined(EDMILL_PORTABLE_FLOAT128)
#define EDMILL_NATIVE_FLOAT128
#include <boost/multiprecision/float128.hpp>

#include "edmill/detail/square_root.hpp"
#else
#include <boost/multiprecision/cpp_bin_float.hpp>
#endif
#if !defined(EDMILL_WITHOUT_MPFR)
#include "edmill/detail/chosen_digits.hpp"
#endif

namespace edmill {

#if defined(EDMILL_NATIVE_FLOAT128)
using float128 = boost::multiprecision::float128;
#else
using float128 = boost::multiprecision::number<
    boost::multiprecision::cpp_bin_float<113, boost::multiprecision::digit_base_2, void, short,
        -16382, 16383>,
    boost::multiprecision::et_off>;
#endif

// The third scalar, `mpfr`, has as many digits as `mpfr::Digits` sets (default: 50).

}  // namespace edmill
