// Tables of a whole record: dose, statistics and frequencies.
#pragma once

#include <algorithm>
#include <numeric>

#include "output/table_output.hpp"

namespace edmill::output {

struct StatisticsKeys {
  static void keys(auto& output, auto&& row) {
    using enum Statistic;
    row(columns_key,
        ColumnReader{{.flags = true,
                         .numbers = true,
                         .of_flags = {sum, rate, percentage},
                         .of_numbers = {sum, average, minimum, maximum, rate, percentage}},
            output.columns});
  }
};

/// Sums, averages, extremes, rates and shares, for walls, other balls and all. (thesis D.4.3)
template <class Real> class StatisticsOutput : public TableOutput<Real> {
 public:
  StatisticsOutput(const OutputSpec& spec, const RunContext<Real>& run)
      : TableOutput<Real>(spec, run),
        gathered_(spec.columns.size(), Accumulators(run.partners.count())) {}
 protected:
  void archive_record(Archive& a) override { a(gathered_); }
  void record(const ImpactFacts<Real>& f) override {
    for (std::size_t k = 0; k < gathered_.size(); ++k)
      of_partner(f, gathered_[k]).add(variable_formula<Real>(this->spec.columns[k].variable)(f));
  }

  void end_of_record(const Simulation<Real>& simulation, const Real& until) override {
    const auto& partners = this->run.partners;
    const Real duration = until - this->timer().from();
    std::vector<Column> columns{{"variable", text, "", "what the row shows"},
        {"statistic", text, "", "which statistic of it"},
        {"unit", text, "", "of the numbers in the row"}};
    const auto groups = groups_of(partners, true);
    for (const auto& group : groups)
      columns.push_back({group.column.key, number, "", group.column.meaning});
    this->begin(std::move(columns),
        {this->window(until) + "; " + std::to_string(simulation.ball_count()) + " balls, " +
            std::to_string(partners.walls()) + " walls"});
    for (std::size_t c = 0; c < gathered_.size(); ++c) {
      const auto& column = this->spec.columns[c];
      const auto& variable = model::impact_variables[column.variable];
      Accumulators shown(groups.size());
      for (std::size_t k = 0; k < groups.size(); ++k)
        for (int partner = groups[k].first; partner <= groups[k].last; ++partner)
          shown[k].add(gathered_[c][partner]);
      for (const Statistic s : column.statistics) {
        this->put(
            name_of(column, variable.name), statistic_name(s), statistic_unit(s, variable.unit));
        for (const auto& group : shown) this->put(group.value(s, duration, shown.back().sum()));
      }
    }
  }
 private:
  using Accumulators = std::vector<Accumulator<Real>>;
  std::vector<Accumulators> gathered_;  ///< for each column, by partner
};

struct FrequencyKeys {
  static void keys(auto& output, auto&& row) {
    auto& f = output.frequency;
    row(Parameter{"variable", "a number"}.as("name").usually("required"), f.name);
    const auto place = model::find_variable(f.name);
    const auto* variable = place ? &model::impact_variables[*place] : nullptr;
    const bool known = variable && variable->kind == model::VariableKind::number;
    const auto dimension = known ? casefile::dimension_of(variable->unit) : Dimension::none;
    const auto bound = [&](const char* key, const char* meaning, Quantity& value) {
      const auto p = Parameter{key, dimension, meaning}.as("as the variable");
      if (known)
        row(p, value);
      else
        row(p.usually("required"), casefile::AnyValue{});  // nothing to check it against
    };
    bound("low", "start of the first interval", f.low);
    bound("high", "end of the last interval", f.high);
    row({"intervals", "number of intervals, of equal length", Range(1, 1000000), "10"},
        f.intervals);
    row(Parameter{"label", "name of the variable in the header"}.usually("the variable's name"),
        f.variable.label);
    row(Parameter{"title", "title of the table"}.usually("none"), f.title);
    const auto flag = [&](const char* key, const char* meaning, bool& value) {
      row(Parameter{key, Dimension::none, meaning, Range::any, "false"}, value);
    };
    flag("wall_details", "add columns for each wall", f.wall_details);
    flag("percentages", "add the shares in per cent", f.percentages);
    flag("out_of_range", "add rows for values below and above the range", f.out_of_range);
  }
  static void check(Section& s, const CaseSpec&, OutputSpec& output) {
    auto& f = output.frequency;
    const auto variable = casefile::variable_of(s, f.name, {.numbers = true});
    f.variable.variable = variable.value_or(0);
    if (variable && s.has("low") && s.has("high"))
      s.require(f.high.to<double>() > f.low.to<double>(), "high", "a value above low");
  }
};

/// How often a variable falls into each of equal intervals [lower, upper). (thesis D.4.4)
template <class Real> class FrequencyOutput : public TableOutput<Real> {
 public:
  FrequencyOutput(const OutputSpec& spec, const RunContext<Real>& run)
      : TableOutput<Real>(spec, run), parts_(groups_of(run.partners, asked().wall_details)),
        formula_(variable_formula<Real>(asked().variable.variable)),
        high_(asked().high.template to<Real>()),
        counts_(asked().intervals + 2, std::vector<std::uint64_t>(run.partners.count())) {
    const Real low = asked().low.template to<Real>();
    for (std::size_t k = 0; k <= asked().intervals; ++k)
      bounds_.push_back(low + (high_ - low) * Real(k) / Real(asked().intervals));
  }
 protected:
  void archive_record(Archive& a) override { a(counts_); }
  void record(const ImpactFacts<Real>& f) override {
    ++of_partner(f, counts_[row_of(formula_(f))]);
  }

  void end_of_record(const Simulation<Real>&, const Real&) override {
    const auto& variable = model::impact_variables[asked().variable.variable];
    std::vector<Column> columns{
        {"interval", text, "", "number of the interval from 1, or below or above all"},
        {"lower", number, "", "lower end, in the interval"},
        {"upper", number, "", "upper end, not in the interval"},
        {"mean", number, "", "middle of the interval"}};
    for (const auto& part : parts_)
      columns.push_back({part.column.key, integer, "", part.column.meaning});
    if (asked().percentages)
      for (const auto& part : parts_) columns.push_back({part.column.key + "_percentage", number});
    std::vector<std::string> comments;
    if (!asked().title.empty()) comments.push_back(asked().title);
    comments.push_back(name_of(asked().variable, variable.name) + " [" +
        std::string(variable.unit) + "]: impacts with lower <= value < upper");
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
        this->put(io::value_if(wholes[k] > 0,
            [&] { return Real(Real(100) * Real(sum(row, parts_[k])) / Real(wholes[k])); }));
    }
  }
 private:
  const casefile::FrequencySpec& asked() const { return this->spec.frequency; }

  /// 0 below the range, then the intervals, then one above, which begins at exactly its end.
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

/// The columns that the table can have; a field is empty if undefined, as without powder.
inline const std::vector<Column> dose_fields{
    {"milling_dose", number, "J", meaning_of("milling_dose")},
    {"milling_dose_rate", number, "W", "milling dose per second of the record"},
    {"inverse_milling_dose_rate", number, "s/J", "time of the record over its milling dose"},
    {"specific_milling_dose", number, "J/kg", "milling dose over the mass of the powder"},
    {"specific_milling_dose_rate", number, "W/kg",
        "milling dose per second over the mass of the powder"},
    {"powder_mass", number, "kg", "mass of the powder"},
    {"charge_ratio", number, "1", "mass of the balls over the mass of the powder"}};

struct MillingDoseKeys {
  std::optional<std::vector<std::string>> names;
  std::vector<int> fields;  ///< their places in dose_fields

  static void keys(auto& output, auto&& row) {
    row(Parameter{"fields",
            "`milling_dose`, `milling_dose_rate`, `inverse_milling_dose_rate`, "
            "`specific_milling_dose`, `specific_milling_dose_rate`, `powder_mass`, `charge_ratio`"}
            .as("list of names")
            .usually("all"),
        output.template make_own<MillingDoseKeys>().names);
  }
  static void check(Section& s, const CaseSpec&, OutputSpec& output) {
    auto& own = output.make_own<MillingDoseKeys>();
    std::vector<std::string> known;
    for (const auto& field : dose_fields) known.push_back(field.name);
    for (const auto& name : own.names.value_or(known)) {
      const auto row = std::find(known.begin(), known.end(), name);
      if (row != known.end())
        own.fields.push_back(static_cast<int>(row - known.begin()));
      else
        s.problem("fields", "\"" + name + "\"", "an array of " + casefile::listed(known));
    }
  }
};

/// Milling dose of the record and what follows from it. (thesis 4.3.3)
template <class Real> class MillingDoseOutput : public TableOutput<Real> {
 public:
  using TableOutput<Real>::TableOutput;
 protected:
  void archive_record(Archive& a) override { a(dose_); }
  void record(const ImpactFacts<Real>& f) override { dose_ += f.outcome.milling_dose; }

  void end_of_record(const Simulation<Real>& simulation, const Real& until) override {
    const Real time = until - this->timer().from(), dose = dose_.value();
    Real ball_mass{0};
    for (int i = 0; i < simulation.ball_count(); ++i) ball_mass += simulation.properties(i).mass;
    const auto& powder_mass = this->run.powder_mass;
    const bool timed = time > 0, powder = powder_mass.has_value();
    const std::optional<Real> values[] = {dose,
        io::value_if(timed, [&] { return Real(dose / time); }),
        io::value_if(dose > 0, [&] { return Real(time / dose); }),
        io::value_if(powder, [&] { return Real(dose / *powder_mass); }),
        io::value_if(powder && timed, [&] { return Real(dose / time / *powder_mass); }),
        powder_mass, io::value_if(powder, [&] { return Real(ball_mass / *powder_mass); })};
    const auto& fields = this->spec.template own_keys<MillingDoseKeys>().fields;
    std::vector<Column> columns;
    for (const int field : fields) columns.push_back(dose_fields[field]);
    this->begin(std::move(columns));
    for (const int field : fields) this->put(values[field]);
  }
 private:
  numerics::CompensatedSum<Real> dose_;
};

}  // namespace edmill::output
