// Where one ball is: at each of its impacts, or at the end of each interval. (thesis D.4.8)
#pragma once

#include "casefile/output_entry.hpp"
#include "output/balls_before.hpp"
#include "output/table_output.hpp"

namespace edmill::output {

struct TraceKeys {
  std::uint64_t ball = 0;

  static void keys(auto& k, auto&& row) {
    row(casefile::Parameter{"ball", Dimension::none, "its id", casefile::Range::any, "0"}, k.ball);
  }
};

inline constexpr casefile::KeyText trace_keys[] = {casefile::interval_if_given, casefile::max_rows_key};

inline void read_trace(casefile::Section& s, const casefile::CaseSpec& spec, casefile::OutputSpec& output) {
  casefile::read_interval(s, output.timer);
  casefile::read_own<TraceKeys>(s, spec, output);
  if (spec.ball_count() > 0)
    s.require(output.own_keys<TraceKeys>().ball < spec.ball_count(), "ball",
              "a ball of the case; they count from 0");
}

template <class Real>
class TraceOutput : public TableOutput<Real> {
 public:
  TraceOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
              const RunContext<Real>& run)
      : TableOutput<Real>(spec, folder, run),
        ball_(static_cast<int>(spec.own_keys<TraceKeys>().ball)),
        clock_(spec.timer),
        at_impacts_(!spec.timer.interval) {
    std::vector<Column> columns{{"time", Column::Type::number, "s", meaning_of("time")}};
    for (const auto* axis : {"x", "y", "z"})
      columns.push_back(
          {axis, Column::Type::number, "m", "place of ball " + std::to_string(ball_) + ", inertial frame"});
    this->begin(std::move(columns));
  }

 protected:
  void archive_record(Archive& a) override { a(clock_); }
  void before(const ImpactFacts<Real>& f) override {
    if (at_impacts_) return;
    const BallsBefore<Real> balls(f);
    clock_.pass(this->timer(), f.time,
                [&](const Real&, const Real& end) { write_row(end, balls.state(ball_, end).position); });
  }
  void record(const ImpactFacts<Real>& f) override {
    if (at_impacts_ && (f.impact.ball == ball_ || (!f.impact.with_wall && f.impact.partner == ball_)))
      write_row(f.time, f.simulation.flight(ball_).position);
  }
  void end_of_record(const engine::Simulation<Real>& simulation, const Real& until) override {
    if (at_impacts_) return;
    clock_.finish(this->timer().from(), until, [&](const Real&, const Real& end) {
      write_row(end, simulation.state_at(ball_, simulation.instant_of(end)).position);
    });
  }

 private:
  void write_row(const Real& time, const Vec3<Real>& position) {
    this->put(time);
    this->put(position);
  }

  int ball_;
  IntervalClock<Real> clock_;
  bool at_impacts_;
};

}  // namespace edmill::output
