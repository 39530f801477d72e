#include "base/scalar_list.hpp"
#include "io/final_state_impl.hpp"
#include "io/summary_impl.hpp"

#define EDMILL_RECORDS(Real)                                                                              \
  template void write_final_state<Real>(std::ostream&, const SavedState<Real>&, const DriveClock<Real>&); \
  template SavedState<Real> read_final_state<Real>(const std::string&);                                   \
  template std::string summary_json<Real>(const Summary<Real>&);                                          \
  template std::string stall_message<Real>(const Summary<Real>&);                                         \
  template Summary<double> in_double<Real>(const Summary<Real>&);

namespace edmill::io {
EDMILL_FOR_EACH_SCALAR(EDMILL_RECORDS)
}
