// What the balls do at the end of each interval. (thesis D.4.7)
#pragma once

#include "base/trigonometry.hpp"
#include "casefile/output_entry.hpp"
#include "model/variables.hpp"
#include "output/accumulator.hpp"
#include "output/balls_before.hpp"
#include "output/table_output.hpp"

namespace edmill::output {

inline constexpr casefile::KeyText trends_balls_keys[] = {casefile::interval_of_30_s, casefile::max_rows_key,
                                                          casefile::columns_key};

inline void read_trends_balls(casefile::Section& s, const casefile::CaseSpec&, casefile::OutputSpec& output) {
  casefile::read_interval(s, output.timer, casefile::Quantity{30});
  using enum casefile::Statistic;
  std::vector<std::string> names;
  for (const auto& v : model::ball_variables) names.emplace_back(v.name);
  for (casefile::Section& entry : s.sections("columns")) {
    casefile::ColumnSpec column;
    const auto name = entry.text("variable").value_or("");
    const auto found = model::find_ball_variable(name);
    entry.require(found.has_value(), "variable", "one of " + casefile::listed(names));
    column.variable = found.value_or(0);
    column.statistics = casefile::read_statistics(entry, {sum, average, minimum, maximum});
    column.label = entry.text("label").value_or("");
    column.with_ball = entry.flag("with_ball");
    entry.reject_unknown_keys();
    output.columns.push_back(std::move(column));
  }
  if (!s.has("columns")) s.problem("columns", "nothing", "an array of tables with `variable`");
}

template <class Real>
class TrendsBallsOutput : public TableOutput<Real> {
 public:
  TrendsBallsOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
                    const RunContext<Real>& run)
      : TableOutput<Real>(spec, folder, run), columns_(spec.columns), clock_(spec.timer) {
    std::vector<Column> columns{{"time", Column::Type::number, "s", meaning_of("time")},
                                {"impacts", Column::Type::integer, "1", "since the start of the run"}};
    for (const auto& c : columns_) {
      const auto& v = model::ball_variables[c.variable];
      for (const Statistic s : c.statistics) {
        const std::string name = name_of(c, v.name, s);
        columns.push_back({name, Column::Type::number, std::string(v.unit),
                           statistic_name(s) + " over the balls: " + std::string(v.meaning)});
        if (shows_ball(c, s))
          columns.push_back({name + " ball", Column::Type::integer, "1", "which ball has it"});
      }
    }
    this->begin(std::move(columns));
  }

 protected:
  void archive_record(Archive& a) override { a(clock_); }
  void before(const ImpactFacts<Real>& f) override {
    const BallsBefore<Real> balls(f);
    clock_.pass(this->timer(), f.time, [&](const Real&, const Real& end) {
      write_row(f.simulation, f.impact.index, end, [&](int i) { return balls.state(i, end); });
    });
  }
  void record(const ImpactFacts<Real>&) override {}
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

  void write_row(const engine::Simulation<Real>& simulation, std::uint64_t impacts, const Real& time,
                 auto&& state_of) {
    std::vector<model::BallState<Real>> states;
    for (int i = 0; i < simulation.ball_count(); ++i) states.push_back(state_of(i));
    this->put(time, impacts);
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
        this->put(sums.value(s, Real(0), sums.sum()));
        if (shows_ball(c, s)) this->put(s == Statistic::minimum ? least : largest);
      }
    }
  }

  std::vector<casefile::ColumnSpec> columns_;
  IntervalClock<Real> clock_;
};

}  // namespace edmill::output
