#include "base/scalar_list.hpp"
//
#include "casefile/case_spec.hpp"

namespace edmill::casefile {

const std::vector<std::string>& precisions() {
#define EDMILL_NAME_OF(Real) std::string(ScalarName<Real>::value),
  static const std::vector<std::string> names{EDMILL_FOR_EACH_SCALAR(EDMILL_NAME_OF)};
#undef EDMILL_NAME_OF
  return names;
}

}  // namespace edmill::casefile
