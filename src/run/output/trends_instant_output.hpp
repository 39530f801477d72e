// Values of single impacts: of each, or of the first after each interval. (thesis D.4.6)
#pragma once

#include "casefile/output_entry.hpp"
#include "output/table_output.hpp"

namespace edmill::output {

inline constexpr casefile::KeyText trends_instant_keys[] = {casefile::interval_if_given,
                                                            casefile::max_rows_key, casefile::columns_key};

inline void read_trends_instant(casefile::Section& s, const casefile::CaseSpec&,
                                casefile::OutputSpec& output) {
  casefile::read_interval(s, output.timer);
  casefile::read_columns(s, {true, true, true, {}, {}}, output);
}

template <class Real>
class TrendsInstantOutput : public TableOutput<Real> {
 public:
  TrendsInstantOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
                      const RunContext<Real>& run)
      : TableOutput<Real>(spec, folder, run),
        columns_(spec.columns),
        clock_(spec.timer),
        every_impact_(!spec.timer.interval),
        rows_left_(spec.timer.max_rows) {
    std::vector<Column> columns;
    for (const auto& c : columns_) {
      const auto& v = model::impact_variables[c.variable];
      const auto type = v.kind == model::VariableKind::flag ? Column::Type::text : type_of(v);
      columns.push_back({name_of(c, v.name), type, std::string(v.unit), std::string(v.meaning)});
    }
    this->begin(std::move(columns));
  }

 protected:
  void archive_record(Archive& a) override { a(clock_, due_, rows_left_); }
  void record(const ImpactFacts<Real>& f) override {
    if (!every_impact_) {
      clock_.pass(this->timer(), f.time, [&](const Real&, const Real&) { due_ = true; });
      if (!due_) return;
      due_ = false;
    }
    if (rows_left_) {
      if (*rows_left_ == 0) return;
      --*rows_left_;
    }
    for (const auto& c : columns_) {
      const Real value = variable_formula<Real>(c.variable)(f);
      if (model::impact_variables[c.variable].kind == model::VariableKind::flag)
        this->put(value != 0 ? c.true_text : c.false_text);
      else
        this->put_variable(c.variable, value);
    }
  }

 private:
  std::vector<casefile::ColumnSpec> columns_;
  IntervalClock<Real> clock_;
  bool every_impact_, due_ = true;
  std::optional<std::uint64_t> rows_left_;
};

}  // namespace edmill::output
