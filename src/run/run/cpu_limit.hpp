// Processor time, and a run that may not take more of it.
#pragma once

#include <ctime>
#include <type_traits>

#include "engine/simulation.hpp"

namespace edmill::run {

/// Processor time of this thread: several runs can share a process.
inline double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Ends a run that has taken `limit` [s] of processor time.
template <class Real>
class CpuLimit : public engine::Observer<Real> {
 public:
  explicit CpuLimit(double limit) : end_(cpu_seconds() + limit) {}

  void on_impact(const engine::Impact<Real>&, engine::Simulation<Real>& simulation) override {
    // Reading a clock costs more than a collision, so it is not read at each one.
    if (++since_look_ < look_every_) return;
    since_look_ = 0;
    if (cpu_seconds() > end_) simulation.request_stop(engine::EndReason::max_cpu_time);
  }

 private:
  static constexpr int look_every_ = std::is_same_v<Real, double> ? 1024 : 16;
  double end_;
  int since_look_ = 0;
};

}  // namespace edmill::run
