// Outputs that gather a variable over the whole record: statistics and frequency.
#pragma once

#include <array>

#include "model/vessel.hpp"
#include "output/accumulator.hpp"
#include "output/output.hpp"

namespace edmill::output {

/// Sums, averages, extremes, rates and shares of variables, for each wall, all walls, other balls and all.
/// (thesis D.4.3)
template <class Real>
class StatisticsOutput : public TableOutput<Real> {
 public:
  StatisticsOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
                   const RunFacts<Real>& run)
      : TableOutput<Real>(spec, folder, run) {
    for (const auto& c : spec.columns) gathered_.push_back({c, variable_formula<Real>(c.variable), {}});
  }

 protected:
  void archive_record(Archive& a) override {
    for (auto& g : gathered_) a(g.by_partner);
  }
  void record(const Seen<Real>& seen) override {
    const auto& f = seen.facts;
    for (auto& g : gathered_) g.by_partner[f.ball_ball ? model::ball_ball : f.partner].add(g.formula(f));
  }

  void end_of_record(const engine::Simulation<Real>& simulation, const Real& until) override {
    const Real &from = this->timer().from(), duration = until - from;
    auto& out = this->out();
    this->write_window(until);
    out << "; " << simulation.ball_count() << " balls, " << model::wall_count << " walls\n"
        << "variable,statistic,unit,wall_0,wall_1,wall_2,walls,ball_ball,total\n";
    for (const auto& g : gathered_) {
      const auto& variable = model::impact_variables[g.column.variable];
      const auto& p = g.by_partner;
      Accumulator<Real> walls;
      for (int wall = 0; wall < model::wall_count; ++wall) walls.add(p[wall]);
      Accumulator<Real> total = walls;
      total.add(p[model::ball_ball]);
      for (const Statistic s : g.column.statistics) {
        out << csv_cell(name_of(g.column, variable.name)) << ',' << statistic_name(s) << ','
            << statistic_unit(s, variable.unit);
        const Accumulator<Real>* const shown[] = {&p[0], &p[1], &p[2], &walls, &p[model::ball_ball], &total};
        for (const auto* part : shown) out << ',' << part->text(s, duration, total.sum());
        out << '\n';
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

/// How often a variable falls into each of equal intervals [lower, upper). (thesis D.4.4)
template <class Real>
class FrequencyOutput : public TableOutput<Real> {
 public:
  FrequencyOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
                  const RunFacts<Real>& run)
      : TableOutput<Real>(spec, folder, run),
        spec_(spec.frequency),
        formula_(variable_formula<Real>(spec.frequency.variable.variable)),
        low_(spec.frequency.low.to<Real>()),
        high_(spec.frequency.high.to<Real>()),
        counts_(spec.frequency.intervals + 2) {}

 protected:
  void archive_record(Archive& a) override { a(counts_); }
  void record(const Seen<Real>& seen) override {
    const auto& f = seen.facts;
    ++counts_[row_of(formula_(f))][f.ball_ball ? model::ball_ball : f.partner];
  }

  void end_of_record(const engine::Simulation<Real>&, const Real&) override {
    auto& out = this->out();
    const auto& variable = model::impact_variables[spec_.variable.variable];
    if (!spec_.title.empty()) out << "# " << spec_.title << '\n';
    out << "# " << title_of(name_of(spec_.variable, variable.name), variable.unit)
        << ": impacts with lower <= value < upper\n"
        << "interval,lower,upper,mean";
    for (const auto& part : parts()) out << ',' << part.name;
    if (spec_.percentages)
      for (const auto& part : parts()) out << ',' << part.name << "_percentage";
    out << '\n';
    if (spec_.out_of_range) write_row("below", 0);
    for (std::size_t k = 1; k + 1 < counts_.size(); ++k) write_row(std::to_string(k), k);
    if (spec_.out_of_range) write_row("above", counts_.size() - 1);
  }

 private:
  using Row = std::array<std::uint64_t, model::partner_kinds>;
  struct Part {
    std::string name;
    int first, last;  ///< of the partners that it counts
  };

  std::vector<Part> parts() const {
    std::vector<Part> list;
    if (spec_.wall_details)
      for (int wall = 0; wall < model::wall_count; ++wall)
        list.push_back({"wall_" + std::to_string(wall), wall, wall});
    list.push_back({"walls", 0, model::wall_count - 1});
    list.push_back({"ball_ball", model::ball_ball, model::ball_ball});
    list.push_back({"total", 0, model::ball_ball});
    return list;
  }

  Real bound(std::size_t k) const { return low_ + (high_ - low_) * Real(k) / Real(spec_.intervals); }

  /// 0 below the range, then the intervals, then one above the range. The bounds decide, not a quotient.
  std::size_t row_of(const Real& value) const {
    if (value < low_) return 0;
    if (!(value < high_)) return counts_.size() - 1;
    auto k = static_cast<std::size_t>((value - low_) / (high_ - low_) * Real(spec_.intervals));
    while (k > 0 && value < bound(k)) --k;
    while (k + 1 < spec_.intervals && value >= bound(k + 1)) ++k;
    return k + 1;
  }

  void write_row(const std::string& name, std::size_t k) {
    auto& out = this->out();
    const auto text = [](bool there, const Real& value) {
      return there ? to_text<Real>(value) : std::string();
    };
    const bool has_lower = k > 0, has_upper = k + 1 < counts_.size(), inside = has_lower && has_upper;
    out << name << ',' << text(has_lower, bound(k - 1)) << ',' << text(has_upper, bound(k)) << ','
        << text(inside, (bound(k - 1) + bound(k)) / 2);
    const auto sum = [&](std::size_t row, const Part& part) {
      std::uint64_t count = 0;
      for (int p = part.first; p <= part.last; ++p) count += counts_[row][p];
      return count;
    };
    for (const auto& part : parts()) out << ',' << sum(k, part);
    if (spec_.percentages)
      for (const auto& part : parts()) {
        std::uint64_t whole = 0;  // of the impacts in this table
        for (std::size_t row = 0; row < counts_.size(); ++row)
          if (spec_.out_of_range || (row > 0 && row + 1 < counts_.size())) whole += sum(row, part);
        out << ',' << text(whole > 0, Real(100) * Real(sum(k, part)) / Real(whole > 0 ? whole : 1));
      }
    out << '\n';
  }

  casefile::FrequencySpec spec_;
  VariableFormula<Real> formula_;
  Real low_, high_;
  std::vector<Row> counts_;
};

}  // namespace edmill::output
