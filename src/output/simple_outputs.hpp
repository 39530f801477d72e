// Outputs that write a line for an impact: collisions, iterations, trends_instant; and milling_dose.
#pragma once

#include "base/compensated_sum.hpp"
#include "output/output.hpp"
#include "output/titles.hpp"
#include "run/collision_log.hpp"

namespace edmill::output {

/// A variable's value as text: flags and counts as integers.
template <class Real>
std::string value_text(int variable, const Real& value) {
  return model::impact_variables[variable].kind == model::VariableKind::number
             ? to_text<Real>(value)
             : std::to_string(static_cast<std::uint64_t>(value));
}

/// The collision log. docs/files.md
template <class Real>
class CollisionsOutput : public TableOutput<Real> {
 public:
  CollisionsOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
                   const RunFacts<Real>& run)
      : TableOutput<Real>(spec, folder, run), states_(spec.states) {
    this->out() << run::collision_log_header << (states_ ? run::collision_log_states : "") << '\n';
  }

 protected:
  void archive_record(Archive&) override {}
  void record(const Seen<Real>& seen) override {
    this->out() << run::collision_line<Real>(seen.impact, seen.simulation, states_) << '\n';
  }

 private:
  bool states_;
};

/// All variables of each impact. (thesis D.4.9)
template <class Real>
class IterationsOutput : public TableOutput<Real> {
 public:
  IterationsOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
                   const RunFacts<Real>& run)
      : TableOutput<Real>(spec, folder, run) {
    std::string line;
    for (const auto& v : model::impact_variables)
      line += (line.empty() ? "" : ",") + title_of(std::string(v.name), v.unit);
    this->out() << line << '\n';
  }

 protected:
  void archive_record(Archive&) override {}
  void record(const Seen<Real>& seen) override {
    std::string line;
    for (int k = 0; k < static_cast<int>(model::impact_variables.size()); ++k)
      line += (k == 0 ? "" : ",") + value_text<Real>(k, variable_formula<Real>(k)(seen.facts));
    this->out() << line << '\n';
  }
};

/// Values of single impacts: of each, or of the first after each interval. (thesis D.4.6)
template <class Real>
class TrendsInstantOutput : public TableOutput<Real> {
 public:
  TrendsInstantOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
                      const RunFacts<Real>& run)
      : TableOutput<Real>(spec, folder, run),
        columns_(spec.columns),
        clock_(spec.timer),
        every_impact_(!spec.timer.interval),
        rows_left_(spec.timer.max_rows) {
    std::string line;
    for (const auto& c : columns_) {
      const auto& v = model::impact_variables[c.variable];
      this->describe(name_of(c, v.name), v.meaning);
      line += (line.empty() ? "" : ",") + csv_cell(title_of(name_of(c, v.name), v.unit));
    }
    this->out() << line << '\n';
  }

 protected:
  void archive_record(Archive& a) override { a(clock_, due_, rows_left_); }
  void record(const Seen<Real>& seen) override {
    if (!every_impact_) {
      clock_.pass(this->timer(), seen.facts.time, [&](const Real&, const Real&) { due_ = true; });
      if (!due_) return;
      due_ = false;
    }
    if (rows_left_) {
      if (*rows_left_ == 0) return;
      --*rows_left_;
    }
    std::string line;
    for (const auto& c : columns_) {
      const Real value = variable_formula<Real>(c.variable)(seen.facts);
      const bool flag = model::impact_variables[c.variable].kind == model::VariableKind::flag;
      line += (&c == columns_.data() ? "" : ",") + (flag ? csv_cell(value != 0 ? c.true_text : c.false_text)
                                                         : value_text<Real>(c.variable, value));
    }
    this->out() << line << '\n';
  }

 private:
  std::vector<casefile::ColumnSpec> columns_;
  IntervalClock<Real> clock_;
  bool every_impact_, due_ = true;
  std::optional<std::uint64_t> rows_left_;
};

/// Milling dose of the record and what follows from it. (thesis 4.3.3)
template <class Real>
class MillingDoseOutput : public TableOutput<Real> {
 public:
  MillingDoseOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
                    const RunFacts<Real>& run)
      : TableOutput<Real>(spec, folder, run), fields_(spec.fields), powder_mass_(run.powder_mass) {}

 protected:
  void archive_record(Archive& a) override { a(dose_); }
  void record(const Seen<Real>& seen) override { dose_ += seen.facts.milling_dose; }

  void end_of_record(const engine::Simulation<Real>& simulation, const Real& until) override {
    const Real time = until - this->timer().from(), dose = dose_.value();
    Real ball_mass{0};
    for (int i = 0; i < simulation.ball_count(); ++i) ball_mass += simulation.properties(i).mass;
    std::string header, line;
    for (const auto& field : fields_) {
      const bool first = &field == fields_.data();
      const auto [unit, value] = value_of(field, dose, time, ball_mass);
      header += (first ? "" : ",") + title_of(field, unit);
      line += (first ? "" : ",") + value;
    }
    this->out() << header << '\n' << line << '\n';
  }

 private:
  /// Unit and text; no text where nothing defines the field, such as specific doses without powder.
  std::pair<const char*, std::string> value_of(const std::string& field, const Real& dose, const Real& time,
                                               const Real& ball_mass) const {
    const auto text = [](bool defined, const auto& value) {
      return defined ? to_text<Real>(value()) : std::string();
    };
    const bool timed = time > 0, powder = powder_mass_.has_value();
    if (field == "milling_dose") return {"J", to_text<Real>(dose)};
    if (field == "milling_dose_rate") return {"W", text(timed, [&] { return Real(dose / time); })};
    if (field == "inverse_milling_dose_rate")
      return {"s/J", text(dose > 0, [&] { return Real(time / dose); })};
    if (field == "specific_milling_dose")
      return {"J/kg", text(powder, [&] { return Real(dose / *powder_mass_); })};
    if (field == "specific_milling_dose_rate")
      return {"W/kg", text(powder && timed, [&] { return Real(dose / time / *powder_mass_); })};
    if (field == "powder_mass") return {"kg", text(powder, [&] { return *powder_mass_; })};
    return {"1", text(powder, [&] { return Real(ball_mass / *powder_mass_); })};  // charge_ratio
  }

  std::vector<std::string> fields_;
  std::optional<Real> powder_mass_;
  numerics::CompensatedSum<Real> dose_;
};

}  // namespace edmill::output
