// How often a variable falls into each of equal intervals [lower, upper). (thesis D.4.4)
#pragma once

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
    bound("low", "begin of the first interval", f.low);
    bound("high", "end of the last interval", f.high);
    row({"intervals", "of equal length", casefile::Range(1, 1000000), "10"}, f.intervals);
    row(Parameter{"label", "in the header"}.usually("the variable's name"), f.variable.label);
    row(Parameter{"title", "of the table"}.usually("none"), f.title);
    const auto flag = [&](const char* key, const char* meaning, bool& value) {
      row(Parameter{key, Dimension::none, meaning, casefile::Range::any, "false"}, value);
    };
    flag("wall_details", "columns for each wall", f.wall_details);
    flag("percentages", "shares", f.percentages);
    flag("out_of_range", "rows below and above the range", f.out_of_range);
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
        partners_(run.partners.count()),
        parts_(groups_of(run.partners, spec.frequency.wall_details)),
        formula_(variable_formula<Real>(spec.frequency.variable.variable)),
        low_(spec.frequency.low.to<Real>()),
        high_(spec.frequency.high.to<Real>()),
        rows_(spec.frequency.intervals + 2),
        counts_(rows_ * partners_) {}

 protected:
  void archive_record(Archive& a) override { a(counts_); }
  void record(const ImpactFacts<Real>& f) override {
    ++count(row_of(formula_(f)), f.impact.with_wall ? f.impact.partner : partners_ - 1);
  }

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
    if (asked().out_of_range) write_row("below", 0);
    for (std::size_t k = 1; k + 1 < rows_; ++k) write_row(std::to_string(k), k);
    if (asked().out_of_range) write_row("above", rows_ - 1);
  }

 private:
  const casefile::FrequencySpec& asked() const { return this->spec.frequency; }
  std::uint64_t& count(std::size_t row, int partner) { return counts_[row * partners_ + partner]; }

  Real bound(std::size_t k) const { return low_ + (high_ - low_) * Real(k) / Real(asked().intervals); }

  /// 0 below the range, then the intervals, then one above the range. The bounds decide, not a quotient.
  std::size_t row_of(const Real& value) const {
    if (value < low_) return 0;
    if (!(value < high_)) return rows_ - 1;
    auto k = static_cast<std::size_t>((value - low_) / (high_ - low_) * Real(asked().intervals));
    while (k > 0 && value < bound(k)) --k;
    while (k + 1 < asked().intervals && value >= bound(k + 1)) ++k;
    return k + 1;
  }

  void write_row(const std::string& name, std::size_t k) {
    const bool has_lower = k > 0, has_upper = k + 1 < rows_, inside = has_lower && has_upper;
    this->put(name, io::value_if(has_lower, [&] { return bound(k - 1); }),
              io::value_if(has_upper, [&] { return bound(k); }),
              io::value_if(inside, [&] { return Real((bound(k - 1) + bound(k)) / 2); }));
    const auto sum = [&](std::size_t row, const PartnerGroup& part) {
      std::uint64_t all = 0;
      for (int p = part.first; p <= part.last; ++p) all += count(row, p);
      return all;
    };
    for (const auto& part : parts_) this->put(sum(k, part));
    if (asked().percentages)
      for (const auto& part : parts_) {
        std::uint64_t whole = 0;  // of the impacts in this table
        for (std::size_t row = 0; row < rows_; ++row)
          if (asked().out_of_range || (row > 0 && row + 1 < rows_)) whole += sum(row, part);
        this->put(
            io::value_if(whole > 0, [&] { return Real(Real(100) * Real(sum(k, part)) / Real(whole)); }));
      }
  }

  int partners_;                     ///< how many there are
  std::vector<PartnerGroup> parts_;  ///< in the order of the columns
  VariableFormula<Real> formula_;
  Real low_, high_;
  std::size_t rows_;
  std::vector<std::uint64_t> counts_;  ///< row by row, of each partner
};

}  // namespace edmill::output
