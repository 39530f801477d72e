// What columns of tables are called.
#pragma once

#include <string>
#include <string_view>

#include "casefile/output_spec.hpp"
#include "io/table.hpp"
#include "model/impact_variables.hpp"

namespace edmill::output {

using casefile::Statistic;
using casefile::statistic_name;
using io::Column;

/// Unit of a statistic of a variable with that unit.
inline std::string statistic_unit(Statistic s, std::string_view unit) {
  if (s == Statistic::rate) return unit == "J" ? "W" : std::string(unit) + "/s";
  return s == Statistic::percentage ? "%" : std::string(unit);
}

/// The label of a column, or else the name of its variable.
inline std::string name_of(const casefile::ColumnSpec& column, std::string_view variable) {
  return column.label.empty() ? std::string(variable) : column.label;
}

/// The column's name with one of its statistics, which a label stands for when it is the only one.
inline std::string name_of(const casefile::ColumnSpec& column, std::string_view variable, Statistic s) {
  const bool alone = !column.label.empty() && column.statistics.size() == 1;
  return alone ? column.label : name_of(column, variable) + " " + statistic_name(s);
}

/// Flags and counts are integers.
inline Column::Type type_of(const model::ImpactVariable& variable) {
  return variable.kind == model::VariableKind::number ? Column::Type::number : Column::Type::integer;
}

/// What a variable of an impact means, by its name.
inline std::string meaning_of(std::string_view variable) {
  return std::string(model::impact_variables[*model::find_variable(variable)].meaning);
}

}  // namespace edmill::output
