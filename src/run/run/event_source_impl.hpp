// Implementation of make_source_in; included by the instantiation files only.
#pragma once

#include <algorithm>
#include <deque>
#include <optional>

#include "casefile/build_case.hpp"
#include "engine/simulation.hpp"
#include "output/collision_log.hpp"
#include "run/event_source.hpp"
#include "run/every_run.hpp"

namespace edmill::run {

template <class Real>
class RunningCase : public EventSource, private engine::Observer<Real> {
 public:
  RunningCase(const casefile::CaseSpec& spec, bool to_end, const std::atomic<bool>* interrupt)
      : spec_(spec), built_(casefile::build_case<Real>(spec)), interrupt_(interrupt), reached_(built_.start) {
    if (const auto& stop = built_.the_case.stop; to_end) {
      const auto is_set = [](const auto& limit) { return limit.has_value(); };
      if (std::any_of(stop.limits.begin(), stop.limits.end(), is_set)) stop_rules_.emplace(built_.the_case);
      if (stop.end_time) end_ = *stop.end_time;
    }
    begin(built_.states);
  }

  std::vector<Event> next(std::size_t count) override {
    const auto scope = digits_.use();
    while (waiting_.size() < count && !over_) advance();
    const auto end = waiting_.begin() + static_cast<std::ptrdiff_t>(std::min(count, waiting_.size()));
    std::vector<Event> events(waiting_.begin(), end);
    waiting_.erase(waiting_.begin(), end);
    return events;
  }
  std::size_t pass(std::size_t count) override {
    const auto scope = digits_.use();
    wanted_ = false;
    const auto before = impacts_;
    while (impacts_ - before < count && !over_) advance();
    wanted_ = true;
    return impacts_ - before;
  }
  bool has_collapsed() const override { return simulation_->collapse().has_value(); }
  double reached() const override { return static_cast<double>(simulation_->seconds()); }

  std::vector<Number> states() const override {
    std::vector<Number> numbers;
    for (const auto& state : states_now())
      for (const auto& vector : {state.position, state.velocity, state.spin})
        for (int axis = 0; axis < 3; ++axis) numbers.push_back(Number(vector[axis]));
    return numbers;
  }

  void continue_in([[maybe_unused]] unsigned digits) override {
    if constexpr (requires { digits_.digits; }) {
      if (over_) return;
      const auto states = states_now();
      digits_.digits = digits;
      const auto scope = digits_.use();
      built_.the_case.mill = casefile::build_mill<Real>(spec_);
      begin(states);
    }
  }

 private:
  void begin(const std::vector<model::BallState<Real>>& states) {
    simulation_.emplace(built_.the_case, states, reached_, interrupt_);
    simulation_->attach(*this);
  }
  /// By a window that is short compared with the duration of many events, so that few are computed in vain.
  void advance() {
    reached_ = simulation_->clock().after(reached_, simulation_->clock().period() / 16);
    const bool last = !(reached_ < end_);
    over_ = simulation_->run_until(last ? end_ : reached_, interrupt_) != engine::EndReason::end_time || last;
  }
  std::vector<model::BallState<Real>> states_now() const {
    const auto scope = digits_.use();
    std::vector<model::BallState<Real>> states;
    for (int k = 0; k < simulation_->ball_count(); ++k)
      states.push_back(simulation_->state_at(k, simulation_->now()));
    return states;
  }
  void on_impact(const engine::Impact<Real>& impact, engine::Simulation<Real>& simulation) override {
    if (stop_rules_) {
      auto numbered = impact;
      numbered.index = impacts_;  // simulations that went before have had impacts, too
      stop_rules_->on_impact(numbered, simulation);
    }
    ++impacts_;
    if (!wanted_) return;
    const auto record = output::record_of<Real>(impact, simulation);
    Event event{.ball = record.ball, .with_wall = record.with_wall, .partner = record.partner};
    for (std::size_t k = 0; k < model::logged_count; ++k) event[k] = Number(record[k]);
    event.by_rule = record.by_rule;
    event.put_in_order();
    waiting_.push_back(event);
  }

  ChosenDigits<Real> digits_;
  casefile::CaseSpec spec_;
  casefile::InitialCase<Real> built_;
  const std::atomic<bool>* interrupt_;
  std::optional<StopRuleWatch<Real>> stop_rules_;
  std::optional<engine::Simulation<Real>> simulation_;
  Instant<Real> reached_, end_ = Instant<Real>::never();
  std::uint64_t impacts_ = 0;
  bool wanted_ = true;  ///< events are kept
  std::deque<Event> waiting_;
  bool over_ = false;
};

template <class Real>
std::unique_ptr<EventSource> make_source_in(const casefile::CaseSpec& spec, bool to_end,
                                            const std::atomic<bool>* interrupt) {
  return std::make_unique<RunningCase<Real>>(spec, to_end, interrupt);
}

}  // namespace edmill::run
