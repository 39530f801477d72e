// Outputs that write a row for each interval of time: trends, trends_balls, trace.
#pragma once

#include "base/trigonometry.hpp"
#include "model/ball_variables.hpp"
#include "output/accumulator.hpp"
#include "output/balls_before.hpp"
#include "output/output.hpp"

namespace edmill::output {

/// Statistics of each interval, or from the start up to its end. (thesis D.4.5)
template <class Real>
class TrendsOutput : public TableOutput<Real> {
 public:
  TrendsOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
               const RunFacts<Real>& run)
      : TableOutput<Real>(spec, folder, run), accumulated_(spec.accumulated), clock_(spec.timer) {
    this->describe("time", accumulated_ ? "up to which the statistics count" : "end of the interval");
    std::string line = "time [s]";
    for (const auto& c : spec.columns) {
      gathered_.push_back({c, variable_formula<Real>(c.variable), {}});
      const auto& v = model::impact_variables[c.variable];
      for (const Statistic s : c.statistics) {
        this->describe(name_of(c, v.name, s), std::string(statistic_name(s)) + ": " + std::string(v.meaning));
        line += "," + csv_cell(title_of(name_of(c, v.name, s), statistic_unit(s, v.unit)));
      }
    }
    this->out() << line << '\n';
  }

 protected:
  void archive_record(Archive& a) override {
    a(clock_);
    for (auto& g : gathered_) a(g.sums);
  }
  void before(const Seen<Real>& seen) override {
    clock_.pass(this->timer(), seen.facts.time,
                [&](const Real& begin, const Real& end) { write_row(begin, end); });
  }
  void record(const Seen<Real>& seen) override {
    for (auto& g : gathered_) g.sums.add(g.formula(seen.facts));
  }
  void end_of_record(const engine::Simulation<Real>&, const Real& until) override {
    clock_.finish(this->timer().from(), until,
                  [&](const Real& begin, const Real& end) { write_row(begin, end); });
  }

 private:
  void write_row(const Real& begin, const Real& end) {
    const Real duration = end - (accumulated_ ? this->timer().from() : begin);
    this->out() << to_text<Real>(end);
    for (auto& g : gathered_) {
      for (const Statistic s : g.column.statistics)
        this->out() << ',' << g.sums.text(s, duration, g.sums.sum());
      if (!accumulated_) g.sums = {};
    }
    this->out() << '\n';
  }

  struct Gathered {
    casefile::ColumnSpec column;
    VariableFormula<Real> formula;
    Accumulator<Real> sums;
  };
  std::vector<Gathered> gathered_;
  bool accumulated_;
  IntervalClock<Real> clock_;
};

/// What the balls do at the end of each interval. (thesis D.4.7)
template <class Real>
class TrendsBallsOutput : public TableOutput<Real> {
 public:
  TrendsBallsOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
                    const RunFacts<Real>& run)
      : TableOutput<Real>(spec, folder, run), columns_(spec.columns), clock_(spec.timer) {
    this->describe("impacts", "since the start of the run");
    std::string line = "time [s],impacts [1]";
    for (const auto& c : columns_) {
      const auto& v = model::ball_variables[c.variable];
      for (const Statistic s : c.statistics) {
        const std::string title = name_of(c, v.name, s);
        this->describe(title, std::string(statistic_name(s)) + " over the balls: " + std::string(v.meaning));
        line += "," + csv_cell(title_of(title, v.unit));
        this->describe(title + " ball", "which ball has it");
        if (shows_ball(c, s)) line += "," + csv_cell(title_of(title + " ball", "1"));
      }
    }
    this->out() << line << '\n';
  }

 protected:
  void archive_record(Archive& a) override { a(clock_); }
  void before(const Seen<Real>& seen) override {
    const BallsBefore<Real> balls(seen);
    clock_.pass(this->timer(), seen.facts.time, [&](const Real&, const Real& end) {
      write_row(seen.simulation, seen.facts.index, end, [&](int i) { return balls.state(i, end); });
    });
  }
  void record(const Seen<Real>&) override {}
  void end_of_record(const engine::Simulation<Real>& simulation, const Real& until) override {
    clock_.finish(this->timer().from(), until, [&](const Real&, const Real& end) {
      const auto when = simulation.instant_of(end);
      write_row(simulation, simulation.counts().impacts, end,
                [&](int i) { return simulation.state_at(i, when); });
    });
  }

 private:
  static bool shows_ball(const casefile::ColumnSpec& c, Statistic s) {
    return c.with_ball && (s == Statistic::minimum || s == Statistic::maximum);
  }

  template <class StateOf>
  void write_row(const engine::Simulation<Real>& simulation, std::uint64_t impacts, const Real& time,
                 StateOf&& state_of) {
    auto& out = this->out();
    std::vector<model::BallState<Real>> states;
    for (int i = 0; i < simulation.ball_count(); ++i) states.push_back(state_of(i));
    out << to_text<Real>(time) << ',' << impacts;
    for (const auto& c : columns_) {
      Accumulator<Real> sums;
      int least = 0, largest = 0;
      std::vector<Real> values;
      for (int i = 0; i < simulation.ball_count(); ++i) {
        values.push_back(model::ball_variable<Real>(c.variable, simulation.properties(i), states[i],
                                                    numerics::pi<Real>()));
        sums.add(values[i]);
        if (values[i] < values[least]) least = i;
        if (values[i] > values[largest]) largest = i;
      }
      for (const Statistic s : c.statistics) {
        out << ',' << sums.text(s, Real(0), sums.sum());
        if (shows_ball(c, s)) out << ',' << (s == Statistic::minimum ? least : largest);
      }
    }
    out << '\n';
  }

  std::vector<casefile::ColumnSpec> columns_;
  IntervalClock<Real> clock_;
};

/// Where one ball is: at each of its impacts, or at the end of each interval. (thesis D.4.8)
template <class Real>
class TraceOutput : public TableOutput<Real> {
 public:
  TraceOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
              const RunFacts<Real>& run)
      : TableOutput<Real>(spec, folder, run),
        ball_(static_cast<int>(spec.ball)),
        clock_(spec.timer),
        at_impacts_(!spec.timer.interval) {
    for (const std::string axis : {"x", "y", "z"})
      this->describe(axis, "place of ball " + std::to_string(ball_) + ", inertial frame");
    this->out() << "time [s],x [m],y [m],z [m]\n";
  }

 protected:
  void archive_record(Archive& a) override { a(clock_); }
  void before(const Seen<Real>& seen) override {
    if (at_impacts_) return;
    const BallsBefore<Real> balls(seen);
    clock_.pass(this->timer(), seen.facts.time,
                [&](const Real&, const Real& end) { write_row(end, balls.state(ball_, end).position); });
  }
  void record(const Seen<Real>& seen) override {
    const auto& f = seen.facts;
    if (at_impacts_ && (f.ball == ball_ || (f.ball_ball && f.partner == ball_)))
      write_row(f.time, seen.simulation.flight(ball_).position);
  }
  void end_of_record(const engine::Simulation<Real>& simulation, const Real& until) override {
    if (at_impacts_) return;
    clock_.finish(this->timer().from(), until, [&](const Real&, const Real& end) {
      write_row(end, simulation.state_at(ball_, simulation.instant_of(end)).position);
    });
  }

 private:
  void write_row(const Real& time, const Vec3<Real>& position) {
    this->out() << to_text<Real>(time);
    for (int axis = 0; axis < 3; ++axis) this->out() << ',' << to_text<Real>(position[axis]);
    this->out() << '\n';
  }

  int ball_;
  IntervalClock<Real> clock_;
  bool at_impacts_;
};

}  // namespace edmill::output
