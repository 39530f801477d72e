// Student's and Fisher's distributions, in double throughout: long double is not the same number everywhere.
#pragma once

#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/students_t.hpp>

namespace edmill::numerics {

using InDouble = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
using Student = boost::math::students_t_distribution<double, InDouble>;
using Fisher = boost::math::fisher_f_distribution<double, InDouble>;

}  // namespace edmill::numerics
