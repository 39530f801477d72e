// What observes every run, whoever starts it.
#pragma once

#include <tuple>
#include <utility>

#include "io/summary.hpp"
#include "run/stop_rules.hpp"

namespace edmill::run {

/// Each is made from the case, `Observer(const model::Case<Real>&)`. Where it has numbers for the summary, it
/// adds them by `note(summary)`. A new one is a file in run/ and a line here.
template <class Real>
using EveryRunList = std::tuple<StopRuleWatch<Real>>;

template <class Real>
class EveryRun {
 public:
  explicit EveryRun(const model::Case<Real>& of) : EveryRun(of, static_cast<EveryRunList<Real>*>(nullptr)) {}

  void attach_to(engine::Simulation<Real>& simulation) {
    std::apply([&](auto&... observer) { (simulation.attach(observer), ...); }, all_);
  }
  void note(io::Summary<Real>& summary) const {
    const auto one = [&](const auto& observer) {
      if constexpr (requires { observer.note(summary); }) observer.note(summary);
    };
    std::apply([&](const auto&... observer) { (one(observer), ...); }, all_);
  }
  void archive(Archive& a) {
    std::apply([&](auto&... observer) { a(observer...); }, all_);
  }

 private:
  template <class... Each>
  EveryRun(const model::Case<Real>& of, std::tuple<Each...>*) : all_(Each(of)...) {}

  EveryRunList<Real> all_;
};

}  // namespace edmill::run
