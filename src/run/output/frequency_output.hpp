// How often a variable falls into each of equal intervals [lower, upper). (thesis D.4.4)
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "casefile/output_entry.hpp"
#include "output/table_output.hpp"
#include "output/tallies.hpp"

namespace edmill::output {

struct FrequencyKeys {
  static void keys(auto& output, auto&& row) {
    using casefile::Parameter;
    auto& f = output.frequency;
    row(Parameter{"variable", "a number"}.as("name").usually("required"), f.name);
    const auto variable = model::find_variable(f.name);
    const bool known = variable && model::impact_variables[*variable].kind == model::VariableKind::number;
    const auto dimension =
        known ? casefile::dimension_of(model::impact_variables[*variable].unit) : Dimension::none;
    const auto bound = [&](const char* key, const char* meaning, casefile::Quantity& value) {
      const auto p = Parameter{key, dimension, meaning}.as("as the variable");
      if (known)
        row(p, value);
      else
        row(p.usually("required"), casefile::AnyValue{});  // nothing to check it against
    };
    bound("low", "start of the first interval", f.low);
    bound("high", "end of the last interval", f.high);
    row({"intervals", "number of intervals, of equal length", casefile::Range(1, 1000000), "10"},
        f.intervals);
    row(Parameter{"label", "name of the variable in the header"}.usually("the variable's name"),
        f.variable.label);
    row(Parameter{"title", "title of the table"}.usually("none"), f.title);
    const auto flag = [&](const char* key, const char* meaning, bool& value) {
      row(Parameter{key, Dimension::none, meaning, casefile::Range::any, "false"}, value);
    };
    flag("wall_details", "add columns for each wall", f.wall_details);
    flag("percentages", "add the shares in per cent", f.percentages);
    flag("out_of_range", "add rows for values below and above the range", f.out_of_range);
  }
  static void check(casefile::Section& s, const casefile::CaseSpec&, casefile::OutputSpec& output) {
    auto& f = output.frequency;
    const auto variable = casefile::variable_of(s, f.name, {.numbers = true});
    f.variable.variable = variable.value_or(0);
    if (variable && s.has("low") && s.has("high"))
      s.require(f.high.to<double>() > f.low.to<double>(), "high", "a value above low");
  }
};

template <class Real>
class FrequencyOutput : public TableOutput<Real> {
 public:
  FrequencyOutput(const casefile::OutputSpec& spec, const RunContext<Real>& run)
      : TableOutput<Real>(spec, run),
        parts_(groups_of(run.partners, asked().wall_details)),
        formula_(variable_formula<Real>(asked().variable.variable)),
        high_(asked().high.template to<Real>()),
        counts_(asked().intervals + 2, std::vector<std::uint64_t>(run.partners.count())) {
    const Real low = asked().low.template to<Real>();
    for (std::size_t k = 0; k <= asked().intervals; ++k)
      bounds_.push_back(low + (high_ - low) * Real(k) / Real(asked().intervals));
  }

 protected:
  void archive_record(Archive& a) override { a(counts_); }
  void record(const ImpactFacts<Real>& f) override { ++of_partner(f, counts_[row_of(formula_(f))]); }

  void end_of_record(const engine::Simulation<Real>&, const Real&) override {
    const auto& variable = model::impact_variables[asked().variable.variable];
    std::vector<Column> columns{
        {"interval", text, "", "number of the interval from 1, or below or above all"},
        {"lower", number, "", "lower end, in the interval"},
        {"upper", number, "", "upper end, not in the interval"},
        {"mean", number, "", "middle of the interval"}};
    for (const auto& part : parts_) columns.push_back({part.column.key, integer, "", part.column.meaning});
    if (asked().percentages)
      for (const auto& part : parts_) columns.push_back({part.column.key + "_percentage", number});
    std::vector<std::string> comments;
    if (!asked().title.empty()) comments.push_back(asked().title);
    comments.push_back(name_of(asked().variable, variable.name) + " [" + std::string(variable.unit) +
                       "]: impacts with lower <= value < upper");
    this->begin(std::move(columns), std::move(comments));
    const std::size_t first = asked().out_of_range ? 0 : 1, end = counts_.size() - first;
    std::vector<std::uint64_t> wholes(parts_.size());  // of the impacts in this table
    for (std::size_t k = 0; k < parts_.size(); ++k)
      for (std::size_t row = first; row < end; ++row) wholes[k] += sum(row, parts_[k]);
    for (std::size_t row = first; row < end; ++row) {
      this->put_bin(bounds_, row);
      this->put(io::value_if(row > 0 && row < bounds_.size(),
                             [&] { return Real((bounds_[row - 1] + bounds_[row]) / 2); }));
      for (const auto& part : parts_) this->put(sum(row, part));
      for (std::size_t k = 0; asked().percentages && k < parts_.size(); ++k)
        this->put(io::value_if(
            wholes[k] > 0, [&] { return Real(Real(100) * Real(sum(row, parts_[k])) / Real(wholes[k])); }));
    }
  }

 private:
  const casefile::FrequencySpec& asked() const { return this->spec.frequency; }

  /// 0 below the range, then the intervals, then one above the range, which begins at exactly its end.
  std::size_t row_of(const Real& value) const {
    const std::size_t last = asked().intervals;
    return value < high_ ? std::min(bin_of<Real>(bounds_, value), last) : last + 1;
  }
  std::uint64_t sum(std::size_t row, const PartnerGroup& part) const {
    const auto counts = counts_[row].begin();
    return std::accumulate(counts + part.first, counts + part.last + 1, std::uint64_t{0});
  }

  std::vector<PartnerGroup> parts_;  ///< in the order of the columns
  VariableFormula<Real> formula_;
  Real high_;
  std::vector<Real> bounds_;                        ///< of the intervals
  std::vector<std::vector<std::uint64_t>> counts_;  ///< of each row, by partner
};

}  // namespace edmill::output
