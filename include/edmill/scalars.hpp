// The scalars of a run. Heavy; `Run<double>` does not need it.
#pragma once

#include <boost/multiprecision/float128.hpp>
#include <boost/multiprecision/mpfr.hpp>

namespace edmill {

using float128 = boost::multiprecision::float128;
template <unsigned digits>
using mpfr_of = boost::multiprecision::number<
    boost::multiprecision::mpfr_float_backend<digits, boost::multiprecision::allocate_stack>,
    boost::multiprecision::et_off>;
using mpfr50 = mpfr_of<50>;
// Errors grow with every collision; these two are for certifying long sequences of events.
using mpfr100 = mpfr_of<100>;
using mpfr200 = mpfr_of<200>;

}  // namespace edmill
