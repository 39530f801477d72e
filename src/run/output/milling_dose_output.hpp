// Milling dose of the record and what follows from it. (thesis 4.3.3)
#pragma once

#include <algorithm>

#include "base/sums.hpp"
#include "casefile/output_entry.hpp"
#include "output/table_output.hpp"

namespace edmill::output {

/// The columns that the table can have; a field is empty if it is undefined, such as a specific dose without
/// powder.
inline const std::vector<Column> dose_fields{
    {"milling_dose", number, "J", meaning_of("milling_dose")},
    {"milling_dose_rate", number, "W", "milling dose per second of the record"},
    {"inverse_milling_dose_rate", number, "s/J", "time of the record over its milling dose"},
    {"specific_milling_dose", number, "J/kg", "milling dose over the mass of the powder"},
    {"specific_milling_dose_rate", number, "W/kg", "milling dose per second over the mass of the powder"},
    {"powder_mass", number, "kg", "mass of the powder"},
    {"charge_ratio", number, "1", "mass of the balls over the mass of the powder"}};

struct MillingDoseKeys {
  std::optional<std::vector<std::string>> names;
  std::vector<int> fields;  ///< their places in dose_fields

  static void keys(auto& output, auto&& row) {
    row(
        casefile::Parameter{
            "fields",
            "`milling_dose`, `milling_dose_rate`, `inverse_milling_dose_rate`, `specific_milling_dose`, "
            "`specific_milling_dose_rate`, `powder_mass`, `charge_ratio`"}
            .as("list of names")
            .usually("all"),
        output.template make_own<MillingDoseKeys>().names);
  }
  static void check(casefile::Section& s, const casefile::CaseSpec&, casefile::OutputSpec& output) {
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

template <class Real>
class MillingDoseOutput : public TableOutput<Real> {
 public:
  using TableOutput<Real>::TableOutput;

 protected:
  void archive_record(Archive& a) override { a(dose_); }
  void record(const ImpactFacts<Real>& f) override { dose_ += f.outcome.milling_dose; }

  void end_of_record(const engine::Simulation<Real>& simulation, const Real& until) override {
    const Real time = until - this->timer().from(), dose = dose_.value();
    Real ball_mass{0};
    for (int i = 0; i < simulation.ball_count(); ++i) ball_mass += simulation.properties(i).mass;
    const auto& powder_mass = this->run.powder_mass;
    const bool timed = time > 0, powder = powder_mass.has_value();
    const std::optional<Real> values[] = {
        dose,
        io::value_if(timed, [&] { return Real(dose / time); }),
        io::value_if(dose > 0, [&] { return Real(time / dose); }),
        io::value_if(powder, [&] { return Real(dose / *powder_mass); }),
        io::value_if(powder && timed, [&] { return Real(dose / time / *powder_mass); }),
        powder_mass,
        io::value_if(powder, [&] { return Real(ball_mass / *powder_mass); })};
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
