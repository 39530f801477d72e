// Reports how far a run is.
#pragma once

#include <functional>
#include <optional>
#include <type_traits>
#include <utility>

#include "engine/simulation.hpp"
#include "run/any_run.hpp"

namespace edmill::run {

template <class Real>
class ProgressWatch : public engine::Observer<Real> {
 public:
  /// @param end  of the simulated time, where it is known [s]
  ProgressWatch(std::function<void(const Progress&)> show, std::optional<double> end)
      : show_(std::move(show)), end_(end) {}

  void on_impact(const engine::Impact<Real>& impact, engine::Simulation<Real>& simulation) override {
    dose_ += static_cast<double>(impact.outcome.milling_dose);
    // Reading a clock costs more than a collision, so it is not read at each one.
    if (++since_look_ < look_every_) return;
    since_look_ = 0;
    show_({static_cast<double>(simulation.seconds()), end_, impact.index + 1, dose_});
  }

 private:
  static constexpr int look_every_ = std::is_same_v<Real, double> ? 4096 : 64;
  int since_look_ = look_every_;
  double dose_ = 0;
  std::function<void(const Progress&)> show_;
  std::optional<double> end_;
};

}  // namespace edmill::run
