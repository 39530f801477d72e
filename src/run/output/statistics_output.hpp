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
      : TableOutput<Real>(spec, run), gathered_(spec.columns.size(), Accumulators(run.partners.count())) {}

 protected:
  void archive_record(Archive& a) override { a(gathered_); }
  void record(const ImpactFacts<Real>& f) override {
    for (std::size_t k = 0; k < gathered_.size(); ++k)
      of_partner(f, gathered_[k]).add(variable_formula<Real>(this->spec.columns[k].variable)(f));
  }

  void end_of_record(const engine::Simulation<Real>& simulation, const Real& until) override {
    const auto& partners = this->run.partners;
    const Real duration = until - this->timer().from();
    std::vector<Column> columns{{"variable", text, "", "what the row shows"},
                                {"statistic", text, "", "which statistic of it"},
                                {"unit", text, "", "of the numbers in the row"}};
    const auto groups = groups_of(partners, true);
    for (const auto& group : groups) columns.push_back({group.column.key, number, "", group.column.meaning});
    this->begin(std::move(columns), {this->window(until) + "; " + std::to_string(simulation.ball_count()) +
                                     " balls, " + std::to_string(partners.walls()) + " walls"});
    for (std::size_t c = 0; c < gathered_.size(); ++c) {
      const auto& column = this->spec.columns[c];
      const auto& variable = model::impact_variables[column.variable];
      Accumulators shown(groups.size());
      for (std::size_t k = 0; k < groups.size(); ++k)
        for (int partner = groups[k].first; partner <= groups[k].last; ++partner)
          shown[k].add(gathered_[c][partner]);
      for (const Statistic s : column.statistics) {
        this->put(name_of(column, variable.name), statistic_name(s), statistic_unit(s, variable.unit));
        for (const auto& group : shown) this->put(group.value(s, duration, shown.back().sum()));
      }
    }
  }

 private:
  using Accumulators = std::vector<Accumulator<Real>>;
  std::vector<Accumulators> gathered_;  ///< for each column, by partner
};

}  // namespace edmill::output
