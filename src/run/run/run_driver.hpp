// A run in progress, its observers, and its summary; included by the instantiation files only.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/errors.hpp"
#include "base/version.hpp"
#include "casefile/build_case.hpp"
#include "engine/simulation.hpp"
#include "io/final_state.hpp"
#include "io/summary.hpp"
#include "model/stop_rules.hpp"
#include "run/any_run.hpp"
#include "run/run_folder.hpp"
#include "run/run_statistics.hpp"

namespace edmill::run {

/// Watches the stop rules of a case.
template <class Real> class StopRuleWatch : public engine::Observer<Real> {
 public:
  explicit StopRuleWatch(const model::Case<Real>& of) {
    for_each([&]<class Watch>(std::optional<Watch>& watch, std::size_t place) {
      if (const auto& limit = of.stop.limits[place]) watch = Watch{*limit};
      if constexpr (requires { watch->begin(of); })
        if (watch) watch->begin(of);
    });
  }

  void on_impact(
      const engine::Impact<Real>& impact, engine::Simulation<Real>& simulation) override {
    for_each([&](auto& watch, std::size_t place) {
      if (watch && watch->is_met(impact, simulation))
        simulation.request_stop(model::reason_of_rule(place));
    });
  }
  void archive(Archive& a) override {
    for_each([&](auto& watch, std::size_t) {
      if (watch) a(*watch);
    });
  }
 private:
  template <class... Rule>
  static std::tuple<std::optional<typename Rule::template Watch<Real>>...> watches_of(
      std::tuple<Rule...>);

  /// Calls f(watch of the rule or none, place of the rule).
  template <class F> void for_each(F&& f) {
    std::size_t place = 0;
    std::apply([&](auto&... watch) { (f(watch, place++), ...); }, watches_);
  }

  decltype(watches_of(model::StopRuleList{})) watches_;
};

/// The observers of every run. Each is constructed from the case, `Observer(const
/// model::Case<Real>&)`, and may `note(summary)`. A new one is a file in run/ and a line here.
template <class Real> using EveryRunList = std::tuple<StopRuleWatch<Real>>;

template <class Real> class EveryRun {
 public:
  explicit EveryRun(const model::Case<Real>& of)
      : EveryRun(of, static_cast<EveryRunList<Real>*>(nullptr)) {}

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

template <class Real> struct Guests {
  std::vector<engine::Observer<Real>*> observers;  ///< notified of every impact, in this order
  const std::atomic<bool>* interrupt = nullptr;    ///< ends the run when it becomes true
  Checkpoints checkpoints{};                       ///< they include the observers
};

/// Limits how often a clock is read, since that costs more than a collision.
template <class Real> struct SeldomLook {
  int every = std::is_same_v<Real, double> ? 1024 : 16, since = 0;

  bool is_due() {
    if (++since < every) return false;
    since = 0;
    return true;
  }
};

/// Ends a run that has taken `limit` [s] of processor time.
template <class Real> class CpuLimit : public engine::Observer<Real> {
 public:
  explicit CpuLimit(double limit) : end_(cpu_seconds() + limit) {}

  void on_impact(const engine::Impact<Real>&, engine::Simulation<Real>& simulation) override {
    if (look_.is_due() && cpu_seconds() > end_)
      simulation.request_stop(engine::EndReason::max_cpu_time);
  }
 private:
  double end_;
  SeldomLook<Real> look_;
};

/// Reports the progress of a run.
template <class Real> class ProgressWatch : public engine::Observer<Real> {
 public:
  /// @param end  of the simulated time, where it is known [s]
  ProgressWatch(std::function<void(const Progress&)> show, std::optional<double> end)
      : show_(std::move(show)), end_(end) {}

  void on_impact(
      const engine::Impact<Real>& impact, engine::Simulation<Real>& simulation) override {
    dose_ += static_cast<double>(impact.outcome.milling_dose);
    if (look_.is_due())
      show_({static_cast<double>(simulation.seconds()), end_, impact.index + 1, dose_});
  }
 private:
  static constexpr int every_ = std::is_same_v<Real, double> ? 4096 : 64;
  SeldomLook<Real> look_{every_, every_};  // at the first impact, too
  double dose_ = 0;
  std::function<void(const Progress&)> show_;
  std::optional<double> end_;
};

/// Pauses the run when a checkpoint is due. It does not change the run: its moment does not matter.
template <class Real> class CheckpointWatch : public engine::Observer<Real> {
 public:
  CheckpointWatch(const CheckpointInterval& interval, double start)
      : interval_(interval), next_(start + interval.seconds), made_(Clock::now()) {}

  void on_impact(const engine::Impact<Real>&, engine::Simulation<Real>& simulation) override {
    if (interval_.simulated) {
      const auto now = static_cast<double>(simulation.seconds());
      if (now < next_) return;
      next_ = now + interval_.seconds;
    } else if (!look_.is_due() ||
        Clock::now() - made_ < std::chrono::duration<double>(interval_.seconds)) {
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

/// Runs up to the start of statistics, then with them to the end, with checkpoints in between.
template <class Real> class RunDriver {
 public:
  RunDriver(const casefile::InitialCase<Real>& built, const Guests<Real>& guests)
      : guests_(guests), simulation_(built.the_case, built.states, built.start, guests.interrupt),
        every_run_(built.the_case), statistics_(model::partners_of(built.the_case.mill),
                                        built.the_case.balls, built.the_case.counted_dose),
        first_(built.start), start_(std::max(first_, built.the_case.statistics_start)) {
    every_run_.attach_to(simulation_);
    for (auto* observer : guests.observers) simulation_.attach(*observer);
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

  /// Simulates to the end of the run, or to `limit` when that is earlier.
  /// @return the reason for the end; `paused` at the limit @throws UndecidedError
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
  const RunStatistics<Real>& statistics() const { return statistics_; }
  const EveryRun<Real>& every_run() const { return every_run_; }
  /// Start of statistics; the current time before they have begun [s].
  Real counted_from() const {
    return simulation_.clock().seconds(counting_ ? start_ : simulation_.now());
  }
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
  EveryRun<Real> every_run_;
  RunStatistics<Real> statistics_;
  std::optional<CheckpointWatch<Real>> watch_;
  Instant<Real> first_, start_, end_;  ///< start of the run, start of statistics, end of the run
  bool counting_ = false;              ///< statistics have begun
  model::Energy<Real> energy_at_start_;
};

/// Summary of what has been simulated so far.
/// @param driver  empty if the first contacts of the balls could not be decided
template <class Real>
io::Summary<Real> summary_of(const casefile::CaseSpec& spec,
    const casefile::InitialCase<Real>& built, const std::optional<RunDriver<Real>>& driver) {
  io::Summary<Real> summary(model::partners_of(built.the_case.mill));
  if (spec.powder_mass) summary.powder_mass = spec.powder_mass->template to<Real>();
  if (spec.target.dose)
    summary.target = {spec.target.dose->template to<Real>(), spec.target.counts(), Real(0)};
  constexpr auto precision = model::place_of_rule<model::DoseRatePrecision>;
  if (const auto& wanted = built.the_case.stop.limits[precision])
    summary.wanted_precision = static_cast<double>(*wanted);
  summary.ball_mass = Real(0);
  for (const auto& ball : built.the_case.balls) *summary.ball_mass += ball.mass;
  summary.provenance = {spec.file, spec.digest, spec.settings, spec.reported, scalar_name<Real>(),
      version(), commit(), compiler(), spec.seed, spec.right_digits};
  if (!driver) {
    summary.period = built.the_case.mill.motion.period();
    summary.start_time = summary.end_time = DriveClock<Real>(summary.period).seconds(built.start);
    summary.energy_at_start = summary.energy_at_end =
        model::energy_of(built.the_case.balls, built.states, built.the_case.mill.gravity);
    return summary;
  }
  using Totals = typename RunStatistics<Real>::Totals;
  const auto& simulation = driver->simulation();
  const auto& statistics = driver->statistics();
  summary.cpu_seconds = driver->cpu_spent();
  summary.start_time = driver->counted_from();
  summary.energy_at_start = driver->energy_at_start();
  summary.end_time = simulation.seconds();
  summary.period = simulation.clock().period();
  summary.energy_at_end = simulation.energy_at(simulation.now());
  for (int k = 0; k < summary.partners.count(); ++k) {
    const auto& totals = statistics.by_partner()[k];
    summary.collisions[k] = totals.collisions;
    summary.impacts[k] = totals.collisions - totals.touched;
    summary.dose_by_partner[k] = totals.milling_dose.value();
  }
  summary.milling_dose = statistics.milling_dose();
  summary.wall_work = statistics.wall_work();
  summary.fast_impacts = statistics.count(&Totals::fast);
  summary.speed_by_dose = statistics.sum(&Totals::speed_by_dose);
  const auto &approach = statistics.impact_energies(), &loss = statistics.dissipated_energies();
  summary.impact_energy = {approach.quantile(0.5), approach.quantile(0.9)};
  summary.dissipated_energy = {loss.quantile(0.5), loss.quantile(0.9)};
  summary.touched_impacts = statistics.count(&Totals::touched);
  summary.touched_dose = statistics.sum(&Totals::touched_dose);
  summary.supplied_energy = statistics.supplied_energy();
  summary.stall_impacts = statistics.count(&Totals::in_stall);
  summary.stall_dose = statistics.sum(&Totals::stall_dose);
  summary.collapse = simulation.collapse();
  summary.stall = simulation.stall();
  summary.simultaneous_contacts = simulation.counts().simultaneous_contacts;
  summary.deepest_overlap = simulation.counts().deepest_overlap;
  summary.total_impacts = simulation.counts().impacts;
  summary.escalations = simulation.escalations();
  const auto &first = summary.energy_at_start, &last = summary.energy_at_end;
  summary.energy_closure = summary.wall_work - summary.milling_dose + summary.supplied_energy -
      ((last.kinetic + last.potential) - (first.kinetic + first.potential));
  driver->every_run().note(summary);
  // An instant consists of whole periods and a remainder, whose sum is rounded: a time of the case
  // is exact.
  const auto name = [&](Real& seconds, const Instant<Real>& when, const casefile::Quantity& given) {
    if (seconds == simulation.clock().seconds(when)) seconds = given.template to<Real>();
  };
  name(summary.start_time, built.the_case.statistics_start, spec.statistics_start);
  if (spec.end_time) name(summary.end_time, *built.the_case.stop.end_time, *spec.end_time);
  if (summary.duration() > 0) {
    summary.intervals =
        statistics.intervals(simulation.now(), simulation.clock().period(), summary.duration());
    if (summary.target)
      summary.target->counted_dose_rate = statistics.counted_dose() / summary.duration();
  }
  return summary;
}

/// The balls as they are now.
template <class Real>
io::SavedState<Real> saved_state(
    const casefile::InitialCase<Real>& built, const std::optional<RunDriver<Real>>& driver) {
  if (!driver) return {built.start, built.states};
  const auto& simulation = driver->simulation();
  io::SavedState<Real> saved{simulation.now(), {}};
  for (int k = 0; k < simulation.ball_count(); ++k)
    saved.states.push_back(simulation.state_at(k, saved.time));
  return saved;
}

template <class Real>
void finish_summary(
    io::Summary<Real>& summary, model::EndReason end_reason, const std::string& error) {
  summary.end_reason = end_reason;
  summary.warnings = warnings_of(io::facts_of(summary), summary.wanted_precision);
  summary.error = summary.stall ? io::stall_message(summary) : error;
}

}  // namespace edmill::run
