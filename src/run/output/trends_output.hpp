// Time series of a run: variables of impacts in each interval, of single impacts and of balls, and the
// positions of one ball.
#pragma once

#include "base/trigonometry.hpp"
#include "casefile/output_entry.hpp"
#include "model/variables.hpp"
#include "output/table_output.hpp"
#include "output/tallies.hpp"

namespace edmill::output {

struct TrendsKeys {
  static void keys(auto& output, auto&& row) {
    using enum casefile::Statistic;
    row(casefile::interval_key("30 s"), output.timer.interval);
    row(casefile::max_rows_key("32000"), output.timer.max_rows);
    row({"accumulated", "statistics since the start of the record, not since the start of the interval",
         casefile::Range::any, "false"},
        output.accumulated);
    row(casefile::columns_key, casefile::ColumnReader{{.flags = true,
                                                       .counts = true,
                                                       .numbers = true,
                                                       .of_flags = {sum, rate},
                                                       .of_numbers = {sum, average, minimum, maximum, rate}},
                                                      output.columns});
  }
};

/// Statistics of each interval, or from the start up to its end. (thesis D.4.5)
template <class Real>
class TrendsOutput : public IntervalOutput<Real> {
 public:
  TrendsOutput(const casefile::OutputSpec& spec, const RunContext<Real>& run)
      : IntervalOutput<Real>(spec, run), sums_(spec.columns.size()) {
    std::vector<Column> columns{
        {"time", number, "s", spec.accumulated ? "up to which the statistics count" : "end of the interval"}};
    for (const auto& c : spec.columns) {
      const auto& v = model::impact_variables[c.variable];
      for (const Statistic s : c.statistics)
        columns.push_back({name_of(c, v.name, s), number, statistic_unit(s, v.unit),
                           statistic_name(s) + ": " + std::string(v.meaning)});
    }
    this->begin(std::move(columns));
  }

 protected:
  void archive_record(Archive& a) override { a(sums_); }
  void record(const ImpactFacts<Real>& f) override {
    for (std::size_t k = 0; k < sums_.size(); ++k)
      sums_[k].add(variable_formula<Real>(this->spec.columns[k].variable)(f));
  }
  void write_row(const Real& begin, const Moment<Real>& end) override {
    const Real duration = end.time - (this->spec.accumulated ? this->timer().from() : begin);
    this->put(end.time);
    for (std::size_t k = 0; k < sums_.size(); ++k) {
      for (const Statistic s : this->spec.columns[k].statistics)
        this->put(sums_[k].value(s, duration, sums_[k].sum()));
      if (!this->spec.accumulated) sums_[k] = {};
    }
  }

 private:
  std::vector<Accumulator<Real>> sums_;  ///< of the variable of each column
};

struct TrendsInstantKeys {
  static void keys(auto& output, auto&& row) {
    row(casefile::interval_key(nullptr).usually("each impact"), output.timer.interval);
    row(casefile::max_rows_key(), output.timer.max_rows);
    row(casefile::columns_key,
        casefile::ColumnReader{{.flags = true, .counts = true, .numbers = true}, output.columns});
  }
};

/// Values of single impacts: of each, or of the first after each interval. (thesis D.4.6)
template <class Real>
class TrendsInstantOutput : public TableOutput<Real> {
 public:
  TrendsInstantOutput(const casefile::OutputSpec& spec, const RunContext<Real>& run)
      : TableOutput<Real>(spec, run), clock_(spec.timer), rows_left_(spec.timer.max_rows) {
    std::vector<Column> columns;
    for (const auto& c : spec.columns) {
      const auto& v = model::impact_variables[c.variable];
      const auto type = v.kind == model::VariableKind::flag ? text : type_of(v);
      columns.push_back({name_of(c, v.name), type, std::string(v.unit), std::string(v.meaning)});
    }
    this->begin(std::move(columns));
  }

 protected:
  void archive_record(Archive& a) override { a(clock_, due_, rows_left_); }
  void record(const ImpactFacts<Real>& f) override {
    if (this->spec.timer.interval) {
      clock_.pass(this->timer(), f.time, [&](const Real&, const Real&) { due_ = true; });
      if (!due_) return;
      due_ = false;
    }
    if (rows_left_) {
      if (*rows_left_ == 0) return;
      --*rows_left_;
    }
    for (const auto& c : this->spec.columns) {
      const Real value = variable_formula<Real>(c.variable)(f);
      if (model::impact_variables[c.variable].kind == model::VariableKind::flag)
        this->put(value != 0 ? c.true_text : c.false_text);
      else
        this->put_variable(c.variable, value);
    }
  }

 private:
  IntervalClock<Real> clock_;
  bool due_ = true;
  std::optional<std::uint64_t> rows_left_;
};

struct TrendsBallsKeys {
  static void keys(auto& output, auto&& row) {
    using enum casefile::Statistic;
    row(casefile::interval_key("30 s"), output.timer.interval);
    row(casefile::max_rows_key(), output.timer.max_rows);
    row(casefile::columns_key,
        casefile::ColumnReader{{.of_balls = true, .of_numbers = {sum, average, minimum, maximum}},
                               output.columns});
  }
};

/// Statistics over the balls at the end of each interval. (thesis D.4.7)
template <class Real>
class TrendsBallsOutput : public IntervalOutput<Real> {
 public:
  TrendsBallsOutput(const casefile::OutputSpec& spec, const RunContext<Real>& run)
      : IntervalOutput<Real>(spec, run) {
    std::vector<Column> columns{{"time", number, "s", meaning_of("time")},
                                {"impacts", integer, "1", "since the start of the run"}};
    for (const auto& c : spec.columns) {
      const auto& v = model::ball_variables[c.variable];
      for (const Statistic s : c.statistics) {
        const std::string name = name_of(c, v.name, s);
        columns.push_back({name, number, std::string(v.unit),
                           statistic_name(s) + " over the balls: " + std::string(v.meaning)});
        if (shows_ball(c, s)) columns.push_back({name + " ball", integer, "1", "which ball has it"});
      }
    }
    this->begin(std::move(columns));
  }

 protected:
  void write_row(const Real&, const Moment<Real>& end) override {
    const auto& simulation = end.simulation;
    std::vector<model::BallState<Real>> states;
    for (int i = 0; i < simulation.ball_count(); ++i) states.push_back(end.state_of(i));
    this->put(end.time, end.impacts);
    for (const auto& c : this->spec.columns) {
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
        this->put(sums.value(s, Real(0), sums.sum()));
        if (shows_ball(c, s)) this->put(s == Statistic::minimum ? least : largest);
      }
    }
  }

 private:
  static bool shows_ball(const casefile::ColumnSpec& c, Statistic s) {
    return c.with_ball && (s == Statistic::minimum || s == Statistic::maximum);
  }
};

struct TraceKeys {
  std::uint64_t ball = 0;

  static void keys(auto& output, auto&& row) {
    row(casefile::interval_key(nullptr).usually("each impact"), output.timer.interval);
    row(casefile::max_rows_key(), output.timer.max_rows);
    row({"ball", "id of the ball", casefile::Range::any, "0"}, output.template make_own<TraceKeys>().ball);
  }
  static void check(casefile::Section& s, const casefile::CaseSpec& spec, casefile::OutputSpec& output) {
    if (spec.ball_count() > 0)
      s.require(output.own_keys<TraceKeys>().ball < spec.ball_count(), "ball",
                "a ball of the case; they count from 0");
  }
};

/// Position of one ball at each of its impacts, or at the end of each interval. (thesis D.4.8)
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

/// All variables of each impact. (thesis D.4.9)
template <class Real>
class IterationsOutput : public TableOutput<Real> {
 public:
  IterationsOutput(const casefile::OutputSpec& spec, const RunContext<Real>& run)
      : TableOutput<Real>(spec, run) {
    const auto& partners = run.partners;
    std::vector<Column> columns;
    for (const auto& v : model::impact_variables) {
      std::string meaning(v.meaning);
      // Files of all versions describe these two like the columns of that name in other tables.
      for (const auto& column : {walls_column, partners[partners.ball_ball()]})
        if (v.name == column.key) meaning = column.meaning;
      columns.push_back({std::string(v.name), type_of(v), std::string(v.unit), meaning});
    }
    this->begin(std::move(columns));
  }

 protected:
  void record(const ImpactFacts<Real>& f) override {
    for (int k = 0; k < static_cast<int>(model::impact_variables.size()); ++k)
      this->put_variable(k, variable_formula<Real>(k)(f));
  }
};

}  // namespace edmill::output
