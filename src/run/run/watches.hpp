// Observers that look at a clock now and then: how far a run is, what time it takes, when a checkpoint is
// due.
#pragma once

#include <chrono>
#include <ctime>
#include <functional>
#include <optional>
#include <type_traits>
#include <utility>

#include "engine/simulation.hpp"
#include "run/any_run.hpp"
#include "run/simulate.hpp"

namespace edmill::run {

/// Processor time of this thread: several runs can share a process.
inline double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Reading a clock costs more than a collision, so it is not read at each one.
template <class Real>
struct SeldomLook {
  int every = std::is_same_v<Real, double> ? 1024 : 16, since = 0;

  bool is_due() {
    if (++since < every) return false;
    since = 0;
    return true;
  }
};

/// Ends a run that has taken `limit` [s] of processor time.
template <class Real>
class CpuLimit : public engine::Observer<Real> {
 public:
  explicit CpuLimit(double limit) : end_(cpu_seconds() + limit) {}

  void on_impact(const engine::Impact<Real>&, engine::Simulation<Real>& simulation) override {
    if (look_.is_due() && cpu_seconds() > end_) simulation.request_stop(engine::EndReason::max_cpu_time);
  }

 private:
  double end_;
  SeldomLook<Real> look_;
};

/// Reports how far a run is.
template <class Real>
class ProgressWatch : public engine::Observer<Real> {
 public:
  /// @param end  of the simulated time, where it is known [s]
  ProgressWatch(std::function<void(const Progress&)> show, std::optional<double> end)
      : show_(std::move(show)), end_(end) {}

  void on_impact(const engine::Impact<Real>& impact, engine::Simulation<Real>& simulation) override {
    dose_ += static_cast<double>(impact.outcome.milling_dose);
    if (look_.is_due()) show_({static_cast<double>(simulation.seconds()), end_, impact.index + 1, dose_});
  }

 private:
  static constexpr int every_ = std::is_same_v<Real, double> ? 4096 : 64;
  SeldomLook<Real> look_{every_, every_};  // at the first impact, too
  double dose_ = 0;
  std::function<void(const Progress&)> show_;
  std::optional<double> end_;
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
    } else if (!look_.is_due() || Clock::now() - made_ < std::chrono::duration<double>(interval_.seconds)) {
      return;
    }
    simulation.request_pause();
  }
  /// Counts the interval from now on.
  void made() { made_ = Clock::now(); }

 private:
  using Clock = std::chrono::steady_clock;
  CheckpointInterval interval_;
  double next_;
  Clock::time_point made_;
  SeldomLook<Real> look_;
};

}  // namespace edmill::run
