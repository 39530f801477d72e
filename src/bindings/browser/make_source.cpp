// Runs that judges make, in double, which is the only scalar of the page.
#include "run/event_source.hpp"

namespace edmill::run {

std::unique_ptr<EventSource> make_source(const std::string&, const casefile::CaseSpec& spec, bool to_end,
                                         const std::atomic<bool>* interrupt) {
  return make_source_in<double>(spec, to_end, interrupt);
}

}  // namespace edmill::run
