#include "base/scalar_list.hpp"
#include "io/final_state_impl.hpp"

#define EDMILL_FINAL_STATE(Real)                                                                          \
  template void write_final_state<Real>(std::ostream&, const SavedState<Real>&, const DriveClock<Real>&); \
  template SavedState<Real> read_final_state<Real>(const std::string&);

namespace edmill::io {
EDMILL_FOR_EACH_SCALAR(EDMILL_FINAL_STATE)
}
