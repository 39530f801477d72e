// Time series of a run: variables of impacts in each interval, of single impacts and of balls, the
// positions of one ball, and the forces on the vessel.
#pragma once

#include "base/trigonometry.hpp"
#include "model/variables.hpp"
#include "output/table_output.hpp"

namespace edmill::output {

struct TrendsKeys {
  static void keys(auto& output, auto&& row) {
    using enum Statistic;
    row(interval_key("30 s"), output.timer.interval);
    row(max_rows_key("32000"), output.timer.max_rows);
    row({"accumulated",
            "statistics since the start of the record, not since the start of the interval",
            Range::any, "false"},
        output.accumulated);
    row(columns_key,
        ColumnReader{{.flags = true,
                         .counts = true,
                         .numbers = true,
                         .of_flags = {sum, rate},
                         .of_numbers = {sum, average, minimum, maximum, rate}},
            output.columns});
  }
};

/// Statistics of each interval, or from the start up to its end. (thesis D.4.5)
template <class Real> class TrendsOutput : public IntervalOutput<Real> {
 public:
  TrendsOutput(const OutputSpec& spec, const RunContext<Real>& run)
      : IntervalOutput<Real>(spec, run), sums_(spec.columns.size()) {
    std::vector<Column> columns{{"time", number, "s",
        spec.accumulated ? "up to which the statistics count" : "end of the interval"}};
    for (const auto& c : spec.columns) {
      const auto& v = model::impact_variables[c.variable];
      for (const auto s : c.statistics)
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
    row(interval_key(nullptr).usually("each impact"), output.timer.interval);
    row(max_rows_key(), output.timer.max_rows);
    row(columns_key,
        ColumnReader{{.flags = true, .counts = true, .numbers = true}, output.columns});
  }
};

/// Values of single impacts: of each, or of the first after each interval. (thesis D.4.6)
template <class Real> class TrendsInstantOutput : public TableOutput<Real> {
 public:
  TrendsInstantOutput(const OutputSpec& spec, const RunContext<Real>& run)
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
      if (!std::exchange(due_, false)) return;
    }
    if (rows_left_ && *rows_left_ == 0) return;
    if (rows_left_) --*rows_left_;
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
    using enum Statistic;
    row(interval_key("30 s"), output.timer.interval);
    row(max_rows_key(), output.timer.max_rows);
    row(columns_key,
        ColumnReader{
            {.of_balls = true, .of_numbers = {sum, average, minimum, maximum}}, output.columns});
  }
};

/// Statistics over the balls at the end of each interval. (thesis D.4.7)
template <class Real> class TrendsBallsOutput : public IntervalOutput<Real> {
 public:
  TrendsBallsOutput(const OutputSpec& spec, const RunContext<Real>& run)
      : IntervalOutput<Real>(spec, run) {
    std::vector<Column> columns{{"time", number, "s", meaning_of("time")},
        {"impacts", integer, "1", "since the start of the run"}};
    for (const auto& c : spec.columns) {
      const auto& v = model::ball_variables[c.variable];
      for (const Statistic s : c.statistics) {
        const std::string name = name_of(c, v.name, s);
        columns.push_back({name, number, std::string(v.unit),
            statistic_name(s) + " over the balls: " + std::string(v.meaning)});
        if (shows_ball(c, s))
          columns.push_back({name + " ball", integer, "1", "which ball has it"});
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
        const auto& ball = simulation.properties(i);
        values.push_back(
            model::ball_variable<Real>(c.variable, ball, states[i], numerics::pi<Real>()));
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
  static bool shows_ball(const ColumnSpec& c, Statistic s) {
    return c.with_ball && (s == Statistic::minimum || s == Statistic::maximum);
  }
};

struct TraceKeys {
  std::uint64_t ball = 0;

  static void keys(auto& output, auto&& row) {
    row(interval_key(nullptr).usually("each impact"), output.timer.interval);
    row(max_rows_key(), output.timer.max_rows);
    row({"ball", "id of the ball", Range::any, "0"}, output.template make_own<TraceKeys>().ball);
  }
  static void check(Section& s, const CaseSpec& spec, OutputSpec& output) {
    if (spec.ball_count() > 0)
      s.require(output.own_keys<TraceKeys>().ball < spec.ball_count(), "ball",
          "a ball of the case; they count from 0");
  }
};

/// Position of one ball at each of its impacts, or at the end of each interval. (thesis D.4.8)
template <class Real> class TraceOutput : public IntervalOutput<Real> {
 public:
  TraceOutput(const OutputSpec& spec, const RunContext<Real>& run)
      : IntervalOutput<Real>(spec, run), ball_(static_cast<int>(spec.own_keys<TraceKeys>().ball)) {
    std::vector<Column> columns{{"time", number, "s", meaning_of("time")}};
    for (const auto* axis : {"x", "y", "z"})
      columns.push_back(
          {axis, number, "m", "place of ball " + std::to_string(ball_) + ", inertial frame"});
    this->begin(std::move(columns));
  }
 protected:
  void record(const ImpactFacts<Real>& f) override {
    const bool has_part =
        f.impact.ball == ball_ || (!f.impact.with_wall && f.impact.partner == ball_);
    if (has_part && !this->spec.timer.interval)
      this->put(f.time, f.simulation.flight(ball_).position);
  }
  void write_row(const Real&, const Moment<Real>& end) override {
    this->put(end.time, end.state_of(ball_).position);
  }
 private:
  int ball_;
};

/// All variables of each impact. (thesis D.4.9)
template <class Real> class IterationsOutput : public TableOutput<Real> {
 public:
  IterationsOutput(const OutputSpec& spec, const RunContext<Real>& run)
      : TableOutput<Real>(spec, run) {
    std::vector<Column> columns;
    for (const auto& v : model::impact_variables) {
      std::string meaning(v.meaning);
      // Files of all versions describe these two like the columns of that name in other tables.
      for (const auto& column : {walls_column, run.partners[run.partners.ball_ball()]})
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

struct VesselLoadKeys {
  static void keys(auto& output, auto&& row) {
    row(interval_key("10 ms"), output.timer.interval);
    row(max_rows_key("32000"), output.timer.max_rows);
  }
};

template <class Real> class VesselLoadOutput : public IntervalOutput<Real> {
 public:
  VesselLoadOutput(const OutputSpec& spec, const RunContext<Real>& run)
      : IntervalOutput<Real>(spec, run) {
    std::vector<Column> columns{{"time", number, "s", "end of the interval"},
        {"duration", number, "s", "length of the interval"}};
    const auto add = [&](const std::string& name, const char* unit, const char* meaning) {
      for (const auto* axis : {"_x", "_y", "_z"})
        columns.push_back({name + axis, number, unit, meaning});
    };
    add("impulse", "N s", "on the vessel, inertial frame");
    add("force", "N", "mean force on the vessel, inertial frame");
    add("torque", "N m", "mean torque on the vessel about the fulcrum, inertial frame");
    add("vessel_force", "N", "mean force on the vessel, vessel frame");
    add("vessel_torque", "N m", "mean torque on the vessel about its centre, vessel frame");
    columns.push_back({"work", number, "J", "of the walls on the balls"});
    columns.push_back({"power", number, "W", "of the walls on the balls"});
    this->begin(std::move(columns));
  }
 protected:
  void archive_record(Archive& a) override {
    a(impulse_, moment_, vessel_impulse_, vessel_moment_, work_);
  }

  void record(const ImpactFacts<Real>& f) override {
    if (!f.impact.with_wall) return;
    const auto* body = f.simulation.mill().body_of(f.impact.partner);
    if (body && !body->on_vessel) return;
    const Vec3<Real> impulse = (f.one.velocity_before - f.one.velocity_after) * f.one.ball->mass;
    impulse_ += impulse;
    moment_ += cross<Real>(f.contact_point, impulse);
    const auto& motion = f.simulation.mill().motion;
    const auto pose = motion.pose(f.impact.time);
    const Vec3<Real> own_impulse = motion.in_axes(pose, impulse);
    vessel_impulse_ += own_impulse;
    vessel_moment_ += cross<Real>(motion.position_in_vessel(pose, f.contact_point), own_impulse);
    work_ += f.outcome.wall_work;
  }

  void write_row(const Real& begin, const Moment<Real>& end) override {
    const Real duration = end.time - begin;
    this->put(end.time, duration, impulse_);
    for (auto* sum : {&impulse_, &moment_, &vessel_impulse_, &vessel_moment_}) {
      this->put(Vec3<Real>(*sum / duration));
      sum->setZero();
    }
    this->put(work_, Real(work_ / duration));
    work_ = Real(0);
  }
 private:
  // Sums of the present interval: impulses [N s] and their moments [N m s] about the fulcrum in the
  // inertial frame, and about the vessel's centre in its own.
  Vec3<Real> impulse_ = Vec3<Real>::Zero(), moment_ = Vec3<Real>::Zero(),
             vessel_impulse_ = Vec3<Real>::Zero(), vessel_moment_ = Vec3<Real>::Zero();
  Real work_{0};  ///< [J]
};

}  // namespace edmill::output
