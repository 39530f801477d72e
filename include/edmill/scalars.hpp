// The scalars of a run. Heavy; `Run<double>` does not need it.
#pragma once

// float128 is IEEE's binary128, rounded to nearest: its results are the same bits on every machine. On x86-64
// the compiler has it; elsewhere, and where EDMILL_PORTABLE_FLOAT128 is defined, it is a class of Boost's.
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
using float128 =
    boost::multiprecision::number<boost::multiprecision::cpp_bin_float<
                                      113, boost::multiprecision::digit_base_2, void, short, -16382, 16383>,
                                  boost::multiprecision::et_off>;
#endif

// Beside it, `mpfr` has as many digits as `mpfr::Digits` chooses, 50 at first.

}  // namespace edmill
