// The live line of a long run, on a terminal only.
#pragma once

#include <atomic>
#include <chrono>
#include <optional>
#include <string>

#include "edmill/engine/simulation.hpp"

namespace edmill::observe {

/// Writes the progress line to standard error.
class ProgressLine {
 public:
  /// @param start, end  of the simulated time [s]; no end when only other rules stop the run
  ProgressLine(double start, std::optional<double> end);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(double now, std::uint64_t collisions);

 private:
  using Clock = std::chrono::steady_clock;
  double start_;
  std::optional<double> end_;
  Clock::time_point begun_, shown_;
  bool visible_ = false;
};

template <class Real>
class Progress : public engine::Observer<Real> {
 public:
  Progress(double start, std::optional<double> end) : line_(start, end) {}

  void on_impact(const engine::Impact<Real>& impact, engine::Simulation<Real>& simulation) override {
    // Reading a clock costs more than a collision: look at it now and then.
    if (++since_look_ < look_every_) return;
    since_look_ = 0;
    line_.show(static_cast<double>(simulation.seconds()), impact.index + 1);
  }

 private:
  static constexpr int look_every_ = std::is_same_v<Real, double> ? 4096 : 64;
  int since_look_ = 0;
  ProgressLine line_;
};

}  // namespace edmill::observe
