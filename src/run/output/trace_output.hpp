// Where one ball is: at each of its impacts, or at the end of each interval. (thesis D.4.8)
#pragma once

#include "casefile/output_entry.hpp"
#include "output/table_output.hpp"

namespace edmill::output {

struct TraceKeys {
  std::uint64_t ball = 0;

  static void keys(auto& output, auto&& row) {
    row(casefile::interval_key(nullptr).usually("each impact"), output.timer.interval);
    row(casefile::max_rows_key(), output.timer.max_rows);
    row({"ball", "its id", casefile::Range::any, "0"}, output.template make_own<TraceKeys>().ball);
  }
  static void check(casefile::Section& s, const casefile::CaseSpec& spec, casefile::OutputSpec& output) {
    if (spec.ball_count() > 0)
      s.require(output.own_keys<TraceKeys>().ball < spec.ball_count(), "ball",
                "a ball of the case; they count from 0");
  }
};

template <class Real>
class TraceOutput : public IntervalOutput<Real> {
 public:
  TraceOutput(const casefile::OutputSpec& spec, const RunContext<Real>& run)
      : IntervalOutput<Real>(spec, run), ball_(static_cast<int>(spec.own_keys<TraceKeys>().ball)) {
    std::vector<Column> columns{{"time", number, "s", meaning_of("time")}};
    for (const auto* axis : {"x", "y", "z"})
      columns.push_back({axis, number, "m", "place of ball " + std::to_string(ball_) + ", inertial frame"});
    this->begin(std::move(columns));
  }

 protected:
  void record(const ImpactFacts<Real>& f) override {
    if (!this->spec.timer.interval &&
        (f.impact.ball == ball_ || (!f.impact.with_wall && f.impact.partner == ball_)))
      this->put(f.time, f.simulation.flight(ball_).position);
  }
  void write_row(const Real&, const Moment<Real>& end) override {
    this->put(end.time, end.state_of(ball_).position);
  }

 private:
  int ball_;
};

}  // namespace edmill::output
