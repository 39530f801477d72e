// Observers of every run, whoever starts it.
#pragma once

#include <tuple>
#include <utility>

#include "engine/simulation.hpp"
#include "io/summary.hpp"
#include "model/stop_rules.hpp"

namespace edmill::run {

/// Watches the stop rules of a case.
template <class Real>
class StopRuleWatch : public engine::Observer<Real> {
 public:
  explicit StopRuleWatch(const model::Case<Real>& of) {
    for_each([&]<class Watch>(std::optional<Watch>& watch, std::size_t place) {
      if (const auto& limit = of.stop.limits[place]) watch = Watch{*limit};
      if constexpr (requires { watch->begin(of); })
        if (watch) watch->begin(of);
    });
  }

  void on_impact(const engine::Impact<Real>& impact, engine::Simulation<Real>& simulation) override {
    for_each([&](auto& watch, std::size_t place) {
      if (watch && watch->is_met(impact, simulation)) simulation.request_stop(model::reason_of_rule(place));
    });
  }
  void archive(Archive& a) override {
    for_each([&](auto& watch, std::size_t) {
      if (watch) a(*watch);
    });
  }

 private:
  template <class... Rule>
  static std::tuple<std::optional<typename Rule::template Watch<Real>>...> watches_of(std::tuple<Rule...>);

  /// Calls f(watch of the rule or none, place of the rule).
  template <class F>
  void for_each(F&& f) {
    std::size_t place = 0;
    std::apply([&](auto&... watch) { (f(watch, place++), ...); }, watches_);
  }

  decltype(watches_of(model::StopRuleList{})) watches_;
};

/// The observers of every run. Each is constructed from the case, `Observer(const
/// model::Case<Real>&)`, and may `note(summary)`. A new one is a file in run/ and a line here.
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
