// The live line of a long run, on a terminal only.
#pragma once

#include <atomic>
#include <chrono>
#include <optional>
#include <string>

#include "engine/simulation.hpp"

namespace edmill::run {

/// Writes the progress line to standard error.
class ProgressLine {
 public:
  /// @param end  of the simulated time [s]; none when only other rules stop the run
  explicit ProgressLine(std::optional<double> end);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// @param now          simulated time [s]
  /// @param collisions   since the start of the run
  /// @param milling_dose since this line was made [J]
  void show(double now, std::uint64_t collisions, std::optional<double> milling_dose = std::nullopt);

 private:
  using Clock = std::chrono::steady_clock;
  struct Look {
    Clock::time_point time;
    double now;
    std::uint64_t collisions;
  };
  std::optional<double> end_;
  std::optional<Look> first_;  ///< a resumed run did not begin here
  Clock::time_point shown_;
  bool visible_ = false;
};

template <class Real>
class Progress : public engine::Observer<Real> {
 public:
  explicit Progress(std::optional<double> end) : line_(end) {}

  void on_impact(const engine::Impact<Real>& impact, engine::Simulation<Real>& simulation) override {
    dose_ += static_cast<double>(impact.outcome.milling_dose);
    // Reading a clock costs more than a collision, so it is not read at each one.
    if (++since_look_ < look_every_) return;
    since_look_ = 0;
    line_.show(static_cast<double>(simulation.seconds()), impact.index + 1, dose_);
  }

 private:
  static constexpr int look_every_ = std::is_same_v<Real, double> ? 4096 : 64;
  int since_look_ = look_every_;
  double dose_ = 0;
  ProgressLine line_;
};

}  // namespace edmill::run
