#include "casefile/build_case_impl.hpp"

#define EDMILL_CASE(Real)                                       \
  template Real Quantity::to<Real>() const;                     \
  template model::Mill<Real> build_mill<Real>(const CaseSpec&); \
  template InitialCase<Real> build_case_in<Real>(const model::Mill<Real>&, const CaseSpec&, bool);

namespace edmill::casefile {
EDMILL_FOR_EACH_SCALAR(EDMILL_CASE)
template mpfr50 Quantity::to<mpfr50>() const;
}  // namespace edmill::casefile
