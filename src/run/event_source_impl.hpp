// Implementation of make_source; included by the instantiation files only.
#pragma once

#include <deque>
#include <optional>

#include "casefile/build_case.hpp"
#include "engine/simulation.hpp"
#include "run/collision_log.hpp"
#include "run/event_source.hpp"

namespace edmill::run {

template <class Real>
class RunningCase : public EventSource, private engine::Observer<Real> {
 public:
  RunningCase(const casefile::CaseSpec& spec, bool to_end)
      : spec_(spec), built_(casefile::build_case<Real>(spec)), reached_(built_.start) {
    if (to_end && built_.the_case.stop.end_time) end_ = *built_.the_case.stop.end_time;
    begin(built_.states);
  }

  std::vector<Event> next(std::size_t count) override {
    const auto scope = digits_.use();
    while (waiting_.size() < count && !over_) {
      // A window that is short compared with the duration of that many events, so that few are computed in
      // vain.
      reached_ = simulation_->clock().after(reached_, simulation_->clock().period() / 16);
      const bool last = !(reached_ < end_);
      over_ = simulation_->run_until(last ? end_ : reached_) != engine::EndReason::end_time || last;
    }
    std::vector<Event> events;
    while (events.size() < count && !waiting_.empty()) {
      events.push_back(waiting_.front());
      waiting_.pop_front();
    }
    return events;
  }

  std::vector<Number> states() const override {
    std::vector<Number> numbers;
    for (const auto& state : states_now())
      for (const auto& vector : {state.position, state.velocity, state.spin})
        for (int axis = 0; axis < 3; ++axis) numbers.push_back(number_of(vector[axis]));
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
    simulation_.emplace(built_.the_case, states, reached_);
    simulation_->attach(*this);
  }
  std::vector<model::BallState<Real>> states_now() const {
    const auto scope = digits_.use();
    std::vector<model::BallState<Real>> states;
    for (int k = 0; k < simulation_->ball_count(); ++k)
      states.push_back(simulation_->state_at(k, simulation_->now()));
    return states;
  }
  static Number number_of(const Real& value) {
#if defined(EDMILL_WITHOUT_MPFR)
    return Number(value);
#else
    return to_mpfr(value);
#endif
  }
  void on_impact(const engine::Impact<Real>& impact, engine::Simulation<Real>& simulation) override {
    const auto record = record_of<Real>(impact, simulation);
    Event event{.ball = record.ball, .with_wall = record.with_wall, .partner = record.partner};
    for (std::size_t k = 0; k < model::logged_count; ++k) event[k] = number_of(record[k]);
    event.by_rule = record.by_rule;
    event.put_in_order();
    waiting_.push_back(event);
  }

  ChosenDigits<Real> digits_;
  casefile::CaseSpec spec_;
  casefile::InitialCase<Real> built_;
  std::optional<engine::Simulation<Real>> simulation_;
  Instant<Real> reached_, end_ = Instant<Real>::never();
  std::deque<Event> waiting_;
  bool over_ = false;
};

template <class Real>
std::unique_ptr<EventSource> make_source(const casefile::CaseSpec& spec, bool to_end) {
  return std::make_unique<RunningCase<Real>>(spec, to_end);
}

}  // namespace edmill::run
