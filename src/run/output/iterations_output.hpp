// All variables of each impact. (thesis D.4.9)
#pragma once

#include "output/table_output.hpp"
#include "output/tallies.hpp"

namespace edmill::output {

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
  void archive_record(Archive&) override {}
  void record(const ImpactFacts<Real>& f) override {
    for (int k = 0; k < static_cast<int>(model::impact_variables.size()); ++k)
      this->put_variable(k, variable_formula<Real>(k)(f));
  }
};

}  // namespace edmill::output
