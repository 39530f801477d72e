#include "cli/dispatch.hpp"

#include "base/errors.hpp"
#include "instances/tools/instances.hpp"

namespace edmill::cli {

int run_case(const std::string& precision, const casefile::CaseSpec& spec, const RunOptions& options) {
#define EDMILL_RUN_IN(Real) \
  if (precision == ScalarName<Real>::value) return run_case<Real>(spec, options);
  EDMILL_FOR_EACH_SCALAR(EDMILL_RUN_IN)
#undef EDMILL_RUN_IN
  throw ContractError("no scalar named " + precision);
}

}  // namespace edmill::cli
