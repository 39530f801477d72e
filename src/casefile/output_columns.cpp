#include "casefile/output_columns.hpp"

#include <algorithm>

#include "casefile/key_reader.hpp"
#include "casefile/nearest.hpp"
#include "model/impact_variables.hpp"

namespace edmill::casefile {

namespace {

using model::impact_variables;
using model::VariableKind;

std::string names_of(const std::vector<Statistic>& list) {
  std::vector<std::string> names;
  for (const auto s : list) names.push_back(statistic_name(s));
  return listed(names);
}

}  // namespace

Dimension dimension_of(std::string_view unit) {
  if (unit == "s") return Dimension::time;
  if (unit == "m") return Dimension::length;
  if (unit == "m/s") return Dimension::speed;
  if (unit == "rad") return Dimension::angle;
  if (unit == "rad/s") return Dimension::angular_speed;
  if (unit == "J") return Dimension::energy;
  return Dimension::none;
}

std::optional<int> read_variable(Section& s, bool flags, bool counts, bool numbers) {
  const auto name = s.text("variable");
  if (!name) {
    if (!s.has("variable")) s.problem("variable", "nothing", "the name of a variable (docs/variables.md)");
    return std::nullopt;
  }
  const auto found = model::find_variable(*name);
  const auto kind = found ? impact_variables[*found].kind : VariableKind::number;
  const bool allowed =
      found && ((kind == VariableKind::flag && flags) || (kind == VariableKind::count && counts) ||
                (kind == VariableKind::number && numbers));
  std::vector<std::string> names;
  for (const auto& variable : impact_variables) names.emplace_back(variable.name);
  const auto near = found ? "" : nearest(*name, names);
  std::string expected = near.empty() ? "" : "'" + near + "', or another of: ";
  if (flags) expected += "a flag, ";
  if (counts) expected += "a count, ";
  if (numbers) expected += "a number, ";
  s.require(allowed, "variable", expected + "as listed by `edmill variables`");
  return allowed ? found : std::nullopt;
}

std::vector<Statistic> read_statistics(Section& s, const std::vector<Statistic>& allowed) {
  std::vector<Statistic> list;
  if (!s.has("statistics")) {
    s.problem("statistics", "nothing", "an array of " + names_of(allowed));
    return list;
  }
  for (const auto& name : s.settings("statistics")) {
    const auto found = std::find_if(allowed.begin(), allowed.end(),
                                    [&](Statistic known) { return statistic_name(known) == name; });
    if (found != allowed.end())
      list.push_back(*found);
    else
      s.problem("statistics", "\"" + name + "\"", "an array of " + names_of(allowed));
  }
  return list;
}

void read_columns(Section& s, const ColumnRules& rules, OutputSpec& output) {
  for (Section& entry : s.sections("columns")) {
    ColumnSpec column;
    column.variable = read_variable(entry, rules.flags, rules.counts, rules.numbers).value_or(0);
    const bool flag = impact_variables[column.variable].kind == VariableKind::flag;
    const auto& allowed = flag ? rules.of_flags : rules.of_numbers;
    if (!allowed.empty()) column.statistics = read_statistics(entry, allowed);
    column.label = entry.text("label").value_or("");
    if (flag && allowed.empty()) {
      column.true_text = entry.text("true_text").value_or("1");
      column.false_text = entry.text("false_text").value_or("0");
    }
    entry.reject_unknown_keys();
    output.columns.push_back(std::move(column));
  }
  if (output.columns.empty() && !s.has("columns"))
    s.problem("columns", "nothing", "an array of tables with `variable`");
}

void read_interval(Section& s, TimerSpec& timer, const std::optional<Quantity>& fallback) {
  timer.interval = s.quantity("interval", Dimension::time);
  s.require(!timer.interval || timer.interval->positive(), "interval", "a positive time");
  if (!timer.interval) timer.interval = fallback;
  timer.max_rows = s.count("max_rows");
  s.require(!timer.max_rows || *timer.max_rows > 0, "max_rows", "at least 1");
}

void read_contact_point(Section& s, OutputSpec& output) {
  if (!s.has("contact_point")) return;
  Section point = s.section("contact_point");
  ContactPointSpec spec;
  read_keys(point, spec);
  point.reject_unknown_keys();
  output.contact_point = spec;
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const auto& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace edmill::casefile
