// Sums, averages, extremes, rates and shares of variables, for walls, other balls and all. (thesis D.4.3)
#pragma once

#include <vector>

#include "casefile/output_entry.hpp"
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
      : TableOutput<Real>(spec, folder, run), partners_(run.partners) {
    for (const auto& c : spec.columns)
      gathered_.push_back({c, variable_formula<Real>(c.variable), Accumulators(partners_.count())});
  }

 protected:
  void archive_record(Archive& a) override {
    for (auto& g : gathered_) a(g.by_partner);
  }
  void record(const ImpactFacts<Real>& f) override {
    for (auto& g : gathered_) of_partner(f, g.by_partner).add(g.formula(f));
  }

  void end_of_record(const engine::Simulation<Real>& simulation, const Real& until) override {
    const Real duration = until - this->timer().from();
    std::vector<Column> columns{{"variable", Column::Type::text, "", "what the row shows"},
                                {"statistic", Column::Type::text, "", "which statistic of it"},
                                {"unit", Column::Type::text, "", "of the numbers in the row"}};
    const auto add = [&](const PartnerColumn& column) {
      columns.push_back({column.name, Column::Type::number, "", column.meaning});
    };
    for (int wall = 0; wall < partners_.walls(); ++wall) add(column_of(partners_[wall]));
    add(walls_column);
    add(column_of(partners_[partners_.ball_ball()]));
    add(total_column);
    this->begin(std::move(columns), {this->window(until) + "; " + std::to_string(simulation.ball_count()) +
                                     " balls, " + std::to_string(partners_.walls()) + " walls"});
    for (const auto& g : gathered_) {
      const auto& variable = model::impact_variables[g.column.variable];
      std::vector<const Accumulator<Real>*> shown;
      Accumulator<Real> walls;
      for (int wall = 0; wall < partners_.walls(); ++wall) {
        shown.push_back(&g.by_partner[wall]);
        walls.add(g.by_partner[wall]);
      }
      Accumulator<Real> total = walls;
      total.add(g.by_partner.back());
      shown.insert(shown.end(), {&walls, &g.by_partner.back(), &total});
      for (const Statistic s : g.column.statistics) {
        this->put(name_of(g.column, variable.name), statistic_name(s), statistic_unit(s, variable.unit));
        for (const auto* part : shown) this->put(part->value(s, duration, total.sum()));
      }
    }
  }

 private:
  using Accumulators = std::vector<Accumulator<Real>>;
  struct Gathered {
    casefile::ColumnSpec column;
    VariableFormula<Real> formula;
    Accumulators by_partner;
  };
  model::Partners partners_;
  std::vector<Gathered> gathered_;
};

}  // namespace edmill::output
