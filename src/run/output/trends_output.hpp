// Statistics of each interval of time, or from the start up to its end. (thesis D.4.5)
#pragma once

#include "casefile/output_entry.hpp"
#include "output/accumulator.hpp"
#include "output/table_output.hpp"

namespace edmill::output {

inline constexpr casefile::KeyText trends_keys[] = {
    casefile::interval_of_30_s,
    casefile::max_rows_key,
    {"accumulated", "true or false", "false", "from the start of the record in place of the interval"},
    casefile::columns_key};

inline void read_trends(casefile::Section& s, const casefile::CaseSpec&, casefile::OutputSpec& output) {
  casefile::read_interval(s, output.timer, casefile::Quantity{30});
  if (!output.timer.max_rows) output.timer.max_rows = 32000;
  output.accumulated = s.flag("accumulated");
  using enum casefile::Statistic;
  casefile::read_columns(s, {true, true, true, {sum, rate}, {sum, average, minimum, maximum, rate}}, output);
}

template <class Real>
class TrendsOutput : public TableOutput<Real> {
 public:
  TrendsOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
               const RunContext<Real>& run)
      : TableOutput<Real>(spec, folder, run), accumulated_(spec.accumulated), clock_(spec.timer) {
    std::vector<Column> columns{{"time", Column::Type::number, "s",
                                 accumulated_ ? "up to which the statistics count" : "end of the interval"}};
    for (const auto& c : spec.columns) {
      gathered_.push_back({c, variable_formula<Real>(c.variable), {}});
      const auto& v = model::impact_variables[c.variable];
      for (const Statistic s : c.statistics)
        columns.push_back({name_of(c, v.name, s), Column::Type::number, statistic_unit(s, v.unit),
                           statistic_name(s) + ": " + std::string(v.meaning)});
    }
    this->begin(std::move(columns));
  }

 protected:
  void archive_record(Archive& a) override {
    a(clock_);
    for (auto& g : gathered_) a(g.sums);
  }
  void before(const ImpactFacts<Real>& f) override {
    clock_.pass(this->timer(), f.time, [&](const Real& begin, const Real& end) { write_row(begin, end); });
  }
  void record(const ImpactFacts<Real>& f) override {
    for (auto& g : gathered_) g.sums.add(g.formula(f));
  }
  void end_of_record(const engine::Simulation<Real>&, const Real& until) override {
    clock_.finish(this->timer().from(), until,
                  [&](const Real& begin, const Real& end) { write_row(begin, end); });
  }

 private:
  void write_row(const Real& begin, const Real& end) {
    const Real duration = end - (accumulated_ ? this->timer().from() : begin);
    this->put(end);
    for (auto& g : gathered_) {
      for (const Statistic s : g.column.statistics) this->put(g.sums.value(s, duration, g.sums.sum()));
      if (!accumulated_) g.sums = {};
    }
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

}  // namespace edmill::output
