// Student's distribution, in double throughout: long double is not the same number everywhere.
#pragma once

#include <boost/math/distributions/students_t.hpp>

namespace edmill::numerics {

using Student = boost::math::students_t_distribution<
    double, boost::math::policies::policy<boost::math::policies::promote_double<false>>>;

}  // namespace edmill::numerics
