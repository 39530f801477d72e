// When a checkpoint is due.
#pragma once

#include <chrono>
#include <type_traits>

#include "engine/simulation.hpp"

namespace edmill::run {

/// How often checkpoints are made.
struct CheckpointInterval {
  double seconds;          ///< above 0
  bool simulated = false;  ///< of simulated time; otherwise of wall-clock time
};

/// Pauses the run when a checkpoint is due. A checkpoint does not change the run, so it does not matter
/// when it is made, nor that simulated time is taken in double.
template <class Real>
class CheckpointWatch : public engine::Observer<Real> {
 public:
  CheckpointWatch(const CheckpointInterval& interval, double start)
      : interval_(interval), next_(start + interval.seconds), made_(Clock::now()) {}

  void on_impact(const engine::Impact<Real>&, engine::Simulation<Real>& simulation) override {
    if (interval_.simulated) {
      const auto now = static_cast<double>(simulation.seconds());
      if (now < next_) return;
      next_ = now + interval_.seconds;
    } else {
      // Reading a clock costs more than a collision, so it is not read at each one.
      if (++since_look_ < look_every_) return;
      since_look_ = 0;
      if (Clock::now() - made_ < std::chrono::duration<double>(interval_.seconds)) return;
    }
    simulation.request_pause();
  }
  /// Counts the interval from now on.
  void made() { made_ = Clock::now(); }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr int look_every_ = std::is_same_v<Real, double> ? 1024 : 16;
  CheckpointInterval interval_;
  double next_;
  Clock::time_point made_;
  int since_look_ = 0;
};

}  // namespace edmill::run
