// From the name of a scalar to a run in it.
#include "base/with_scalar.hpp"
#include "casefile/right_digits.hpp"
#include "run/any_run.hpp"
#include "run/event_source.hpp"

namespace edmill::run {

std::unique_ptr<AnyRun> make_run(const std::string& precision, const casefile::CaseSpec& spec,
                                 const RunSetup& setup) {
  return with_scalar(precision, [&]<class Real>() {
    const auto shown = casefile::only_right_digits<Real>(spec);
    return make_run_in<Real>(spec, setup);
  });
}

std::unique_ptr<EventSource> make_source(const std::string& precision, const casefile::CaseSpec& spec,
                                         bool to_end, const std::atomic<bool>* interrupt) {
  return with_scalar(precision, [&]<class Real>() { return make_source_in<Real>(spec, to_end, interrupt); });
}

}  // namespace edmill::run
