// A run in progress; included by the instantiation files only, through simulate_impl.hpp.
#pragma once

#include "run/cpu_limit.hpp"
#include "run/every_run.hpp"
#include "run/run_statistics.hpp"
#include "run/simulate.hpp"

namespace edmill::run {

/// The stages of a run: up to the start of statistics, then with them to the end, with checkpoints in
/// between.
template <class Real>
class RunDriver {
 public:
  RunDriver(const casefile::InitialCase<Real>& built, const Guests<Real>& guests)
      : guests_(guests),
        simulation_(built.the_case, built.states, built.start, guests.interrupt),
        every_run_(built.the_case),
        statistics_(model::partners_of(built.the_case.mill.vessel), built.the_case.counted_dose),
        first_(built.start) {
    every_run_.attach_to(simulation_);
    for (auto* observer : guests.observers) simulation_.attach(*observer);
    start_ = built.the_case.statistics_start;
    if (start_ < first_) start_ = first_;
    const auto& end_time = built.the_case.stop.end_time;
    end_ = end_time.value_or(Instant<Real>::never());
    EDMILL_REQUIRE(start_ <= end_ || !end_time, "statistics start before the end");
    if (!guests.checkpoints.restored.empty()) restore();
    if (const auto& every = guests.checkpoints.every) {
      watch_.emplace(*every, static_cast<double>(simulation_.seconds()));
      simulation_.attach(*watch_);
    }
  }
  RunDriver(const RunDriver&) = delete;
  RunDriver& operator=(const RunDriver&) = delete;

  /// To the end of the run, or to `limit` when that is earlier.
  /// @return paused at the limit
  /// @throws UndecidedError when no scalar could make a decision
  engine::EndReason go(const Instant<Real>& limit = Instant<Real>::never()) {
    using engine::EndReason;
    if (!counting_ && start_ == first_) start_counting();
    for (;;) {
      const auto& goal = counting_ ? end_ : start_;
      const bool limited = limit < goal;
      const auto reason = simulation_.run_until(limited ? limit : goal, guests_.interrupt);
      if (reason == EndReason::paused) {
        save();
      } else if (reason == EndReason::end_time && limited) {
        return EndReason::paused;
      } else if (reason == EndReason::end_time && !counting_) {
        start_counting();
      } else {
        if (reason == EndReason::interrupted) save();
        return reason;
      }
    }
  }

  engine::Simulation<Real>& simulation() { return simulation_; }
  const engine::Simulation<Real>& simulation() const { return simulation_; }
  const run::RunStatistics<Real>& statistics() const { return statistics_; }
  const run::EveryRun<Real>& every_run() const { return every_run_; }
  /// Start of statistics; the current time before they have begun [s].
  Real counted_from() const { return simulation_.clock().seconds(counting_ ? start_ : simulation_.now()); }
  model::Energy<Real> energy_at_start() const {
    return counting_ ? energy_at_start_ : simulation_.energy_at(simulation_.now());
  }
  double cpu_spent() const { return cpu_before_ + (cpu_seconds() - cpu_begun_); }

  void archive(Archive& a) {
    a(simulation_, every_run_, statistics_, counting_, energy_at_start_);
    for (auto* observer : guests_.observers) a(*observer);
    double cpu = cpu_spent();
    a(cpu);
    if (a.loading()) cpu_before_ = cpu;
  }

 private:
  void start_counting() {
    counting_ = true;
    energy_at_start_ = simulation_.energy_at(start_);
    statistics_.begin(start_);
    simulation_.attach(statistics_);
  }

  void save() {
    if (!guests_.checkpoints.save) return;
    Archive archive;
    archive(*this);
    guests_.checkpoints.save(archive.bytes());
    if (watch_) watch_->made();
  }
  void restore() {
    Archive archive(guests_.checkpoints.restored);
    archive(*this);
    archive.finish();
    if (counting_) simulation_.attach(statistics_);
  }

  double cpu_begun_ = cpu_seconds();
  double cpu_before_ = 0;  ///< of the run's earlier processes [s]
  const Guests<Real>& guests_;
  engine::Simulation<Real> simulation_;
  run::EveryRun<Real> every_run_;
  run::RunStatistics<Real> statistics_;
  std::optional<run::CheckpointWatch<Real>> watch_;
  Instant<Real> first_, start_, end_;  ///< of the run, of statistics, of the run
  bool counting_ = false;              ///< statistics have begun
  model::Energy<Real> energy_at_start_;
};

}  // namespace edmill::run
