// Watches the stop rules of a case.
#pragma once

#include <tuple>

#include "engine/simulation.hpp"
#include "model/stop_rules.hpp"

namespace edmill::run {

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

}  // namespace edmill::run
