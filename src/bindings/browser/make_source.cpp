// The judge's runs in double, the page's only scalar.
#include "run/event_source.hpp"

namespace edmill::run {

std::unique_ptr<EventSource> make_source(const std::string&, const casefile::CaseSpec& spec, bool to_end,
                                         const std::atomic<bool>* interrupt) {
  return make_source_in<double>(spec, to_end, interrupt);
}

}  // namespace edmill::run
