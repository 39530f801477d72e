// Tells how far a run is.
#pragma once

#include <cstdint>
#include <functional>
#include <type_traits>
#include <utility>

#include "engine/simulation.hpp"

namespace edmill::run {

template <class Real>
class Progress : public engine::Observer<Real> {
 public:
  /// @param show  gets the simulated time [s], the impacts since the start of the run, and the milling dose
  ///              since this observer was made [J]
  explicit Progress(std::function<void(double, std::uint64_t, double)> show) : show_(std::move(show)) {}

  void on_impact(const engine::Impact<Real>& impact, engine::Simulation<Real>& simulation) override {
    dose_ += static_cast<double>(impact.outcome.milling_dose);
    // Reading a clock costs more than a collision, so it is not read at each one.
    if (++since_look_ < look_every_) return;
    since_look_ = 0;
    show_(static_cast<double>(simulation.seconds()), impact.index + 1, dose_);
  }

 private:
  static constexpr int look_every_ = std::is_same_v<Real, double> ? 4096 : 64;
  int since_look_ = look_every_;
  double dose_ = 0;
  std::function<void(double, std::uint64_t, double)> show_;
};

}  // namespace edmill::run
