// Sums, averages, extremes, rates and shares of variables, for walls, other balls and all. (thesis D.4.3)
#pragma once

#include <vector>

#include "casefile/output_entry.hpp"
#include "output/table_output.hpp"
#include "output/tallies.hpp"

namespace edmill::output {

struct StatisticsKeys {
  static void keys(auto& output, auto&& row) {
    using enum casefile::Statistic;
    row(casefile::columns_key,
        casefile::ColumnReader{{.flags = true,
                                .numbers = true,
                                .of_flags = {sum, rate, percentage},
                                .of_numbers = {sum, average, minimum, maximum, rate, percentage}},
                               output.columns});
  }
};

template <class Real>
class StatisticsOutput : public TableOutput<Real> {
 public:
  StatisticsOutput(const casefile::OutputSpec& spec, const RunContext<Real>& run)
      : TableOutput<Real>(spec, run) {
    for (const auto& c : spec.columns)
      gathered_.push_back({c, variable_formula<Real>(c.variable), Accumulators(run.partners.count())});
  }

 protected:
  void archive_record(Archive& a) override {
    for (auto& g : gathered_) a(g.by_partner);
  }
  void record(const ImpactFacts<Real>& f) override {
    for (auto& g : gathered_) of_partner(f, g.by_partner).add(g.formula(f));
  }

  void end_of_record(const engine::Simulation<Real>& simulation, const Real& until) override {
    const auto& partners = this->run.partners;
    const Real duration = until - this->timer().from();
    std::vector<Column> columns{{"variable", text, "", "what the row shows"},
                                {"statistic", text, "", "which statistic of it"},
                                {"unit", text, "", "of the numbers in the row"}};
    const auto groups = groups_of(partners, true);
    for (const auto& group : groups) columns.push_back({group.column.name, number, "", group.column.meaning});
    this->begin(std::move(columns), {this->window(until) + "; " + std::to_string(simulation.ball_count()) +
                                     " balls, " + std::to_string(partners.walls()) + " walls"});
    for (const auto& g : gathered_) {
      const auto& variable = model::impact_variables[g.column.variable];
      std::vector<Accumulator<Real>> shown(groups.size());
      for (std::size_t k = 0; k < groups.size(); ++k)
        for (int partner = groups[k].first; partner <= groups[k].last; ++partner)
          shown[k].add(g.by_partner[partner]);
      for (const Statistic s : g.column.statistics) {
        this->put(name_of(g.column, variable.name), statistic_name(s), statistic_unit(s, variable.unit));
        for (const auto& group : shown) this->put(group.value(s, duration, shown.back().sum()));
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
  std::vector<Gathered> gathered_;
};

}  // namespace edmill::output
