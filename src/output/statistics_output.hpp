// Sums, averages, extremes, rates and shares of variables, for each wall, all walls, other balls and all.
// (thesis D.4.3)
#pragma once

#include <array>

#include "casefile/output_columns.hpp"
#include "output/accumulator.hpp"
#include "output/by_partner.hpp"
#include "output/table_output.hpp"

namespace edmill::output {

inline void read_statistics_output(casefile::Section& s, const casefile::CaseSpec&,
                                   casefile::OutputSpec& output) {
  using enum casefile::Statistic;
  casefile::read_columns(
      s, {true, false, true, {sum, rate, percentage}, {sum, average, minimum, maximum, rate, percentage}},
      output);
}

template <class Real>
class StatisticsOutput : public TableOutput<Real> {
 public:
  StatisticsOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
                   const RunContext<Real>& run)
      : TableOutput<Real>(spec, folder, run) {
    for (const auto& c : spec.columns) gathered_.push_back({c, variable_formula<Real>(c.variable), {}});
  }

 protected:
  void archive_record(Archive& a) override {
    for (auto& g : gathered_) a(g.by_partner);
  }
  void record(const Seen<Real>& seen) override {
    const auto& f = seen.facts;
    for (auto& g : gathered_) g.by_partner[partner_of(f)].add(g.formula(f));
  }

  void end_of_record(const engine::Simulation<Real>& simulation, const Real& until) override {
    const Real duration = until - this->timer().from();
    std::vector<Column> columns{{"variable", Column::Type::text, "", "what the row shows"},
                                {"statistic", Column::Type::text, "", "which statistic of it"},
                                {"unit", Column::Type::text, "", "of the numbers in the row"}};
    for (const auto& [name, meaning] :
         {column_of(0), column_of(1), column_of(2), walls_column, column_of(model::ball_ball), total_column})
      columns.push_back({name, Column::Type::number, "", meaning});
    this->begin(std::move(columns), {this->window(until) + "; " + std::to_string(simulation.ball_count()) +
                                     " balls, " + std::to_string(model::wall_count) + " walls"});
    for (const auto& g : gathered_) {
      const auto& variable = model::impact_variables[g.column.variable];
      const auto& p = g.by_partner;
      Accumulator<Real> walls;
      for (int wall = 0; wall < model::wall_count; ++wall) walls.add(p[wall]);
      Accumulator<Real> total = walls;
      total.add(p[model::ball_ball]);
      for (const Statistic s : g.column.statistics) {
        this->put(name_of(g.column, variable.name), statistic_name(s), statistic_unit(s, variable.unit));
        const Accumulator<Real>* const shown[] = {&p[0], &p[1], &p[2], &walls, &p[model::ball_ball], &total};
        for (const auto* part : shown) this->put(part->value(s, duration, total.sum()));
      }
    }
  }

 private:
  struct Gathered {
    casefile::ColumnSpec column;
    VariableFormula<Real> formula;
    std::array<Accumulator<Real>, model::partner_kinds> by_partner;
  };
  std::vector<Gathered> gathered_;
};

}  // namespace edmill::output
