// Makes a run in the scalar of a given name.
#include "base/scalar_list.hpp"
#include "run/any_run.hpp"
#include "run/event_source.hpp"

namespace edmill::run {

std::unique_ptr<AnyRun> make_run(
    const std::string& precision, const casefile::CaseSpec& spec, const RunSetup& setup) {
  return with_scalar(precision, [&]<class Real>() {
    // Files and texts contain only the digits that the case asks for and a few more.
    auto digits = ChosenDigits<Real>();
    if constexpr (requires { digits.shown; })
      if (spec.digits) digits.shown = static_cast<unsigned>(*spec.digits) + 3;
    const auto scope = digits.use();
    return make_run_in<Real>(spec, setup);
  });
}

std::unique_ptr<EventSource> make_source(const std::string& precision,
    const casefile::CaseSpec& spec, bool to_end, const std::atomic<bool>* interrupt) {
  return with_scalar(
      precision, [&]<class Real>() { return make_source_in<Real>(spec, to_end, interrupt); });
}

}  // namespace edmill::run
