#include "casefile/output_entry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "casefile/nearest.hpp"
#include "model/variables.hpp"

namespace edmill::casefile {

namespace {

using model::impact_variables;
using model::VariableKind;

/// Checks the keys that all entries have, and conditions between them.
void check_common(Section& s, const CaseSpec& spec, const OutputSpec& output) {
  const auto& timer = output.timer;
  if (timer.start_time && timer.end_time)
    s.require(*timer.end_time > *timer.start_time, "end_time", "a time after start_time");
  const bool plain =
      output.file.find('/') == std::string::npos && output.file != "." && output.file != "..";
  s.require(plain, "file", "a plain file name");
  const auto& f = output.folder;
  const bool inside =
      f.empty() || (f.front() != '/' && ("/" + f + "/").find("/../") == std::string::npos);
  s.require(inside, "folder", "a folder inside the run's folder");
  const auto place = [](const OutputSpec& o) {
    return (std::filesystem::path("run") / o.folder / o.file).lexically_normal();
  };
  for (const auto* taken : {"summary.json", "final_state.csv", "case.toml", "report.html",
           "checkpoint", "ro-crate-metadata.json"})
    s.require(place(output) != std::filesystem::path("run") / taken, "file",
        "a plain file name other than the run's own summary.json, final_state.csv, case.toml, "
        "report.html, checkpoint and ro-crate-metadata.json");
  s.require(!output.append || !output.hdf5(), "append", "false for HDF5");
  for (const auto& other : spec.outputs)
    s.require(place(other) != place(output) || (other.append && output.append), "file",
        "a file name that no other output has, or append = true for both");
}

/// Index in ball_variables of a name; nothing for an unknown one, which is reported.
std::optional<int> ball_variable_of(Section& s, const std::string& name) {
  std::vector<std::string> names;
  for (const auto& v : model::ball_variables) names.emplace_back(v.name);
  const auto found = model::find_ball_variable(name);
  s.require(found.has_value(), "variable", "one of " + listed(names));
  return found;
}

std::vector<Statistic> statistics_of(
    Section& s, const ColumnTable& given, const std::vector<Statistic>& allowed) {
  std::vector<std::string> names;
  for (const auto a : allowed) names.push_back(statistic_name(a));
  const auto expected = "an array of " + listed(names);
  if (!given.wanted) s.problem("statistics", "nothing", expected);
  std::vector<Statistic> list;
  for (const auto& name : given.wanted.value_or(std::vector<std::string>{})) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end())
      list.push_back(allowed[static_cast<std::size_t>(found - names.begin())]);
    else
      s.problem("statistics", "\"" + name + "\"", expected);
  }
  return list;
}

}  // namespace

Dimension dimension_of(std::string_view unit) {
  using enum Dimension;
  for (const auto dimension : {time, length, speed, angle, angular_speed, energy})
    if (si_unit(dimension) == " " + std::string(unit)) return dimension;
  return none;
}

std::optional<Restriction> Restriction::read(Section& only, const std::string& key) {
  const auto found = model::find_variable(key);
  if (found && impact_variables[*found].kind == VariableKind::flag)
    return Restriction{*found, only.flag(key) ? 1u : 0u};
  if (found && impact_variables[*found].kind == VariableKind::count)
    return Restriction{*found, only.count(key).value_or(0)};
  std::vector<std::string> names;
  for (const auto& v : impact_variables)
    if (v.kind != VariableKind::number) names.emplace_back(v.name);
  only.problem(key, "a restriction on '" + key + "'", "one of " + listed(names));
  return std::nullopt;
}

std::optional<int> variable_of(Section& s, const std::string& name, const ColumnRules& rules) {
  if (!s.has("variable"))
    s.problem("variable", "nothing", "the name of a variable (docs/variables.md)");
  if (name.empty()) return std::nullopt;
  const auto found = model::find_variable(name);
  const auto kind = found ? impact_variables[*found].kind : VariableKind::number;
  const bool allowed = found &&
      (kind == VariableKind::flag           ? rules.flags
              : kind == VariableKind::count ? rules.counts
                                            : rules.numbers);
  std::vector<std::string> names;
  for (const auto& variable : impact_variables) names.emplace_back(variable.name);
  const auto near = found ? "" : nearest(name, names);
  std::string expected = near.empty() ? "" : "'" + near + "', or another of: ";
  if (rules.flags) expected += "a flag, ";
  if (rules.counts) expected += "a count, ";
  if (rules.numbers) expected += "a number, ";
  s.require(allowed, "variable", expected + "as listed by `edmill variables`");
  return allowed ? found : std::nullopt;
}

bool ColumnTable::is_flag(const std::string& variable) {
  const auto found = model::find_variable(variable);
  return !found || impact_variables[*found].kind == VariableKind::flag;
}

void ColumnReader::read_from(Section& output, const char* key) {
  for (Section& entry : output.sections(key)) {
    ColumnTable given = like;
    read_keys(entry, given);
    const auto variable = rules.of_balls ? ball_variable_of(entry, given.name)
                                         : variable_of(entry, given.name, rules);
    given.variable = variable.value_or(0);
    const bool flag = !rules.of_balls && ColumnTable::is_flag(given.name);
    const auto& allowed = flag ? rules.of_flags : rules.of_numbers;
    if (!allowed.empty()) given.statistics = statistics_of(entry, given, allowed);
    columns.push_back(given);
    entry.reject_unknown_keys();
  }
  if (!output.has(key)) output.problem(key, "nothing", "an array of tables with `variable`");
}

std::string listed(const std::vector<std::string>& names) {
  return fmt::format("{}", fmt::join(names, ", "));
}

void read_output(Section& s, CaseSpec& spec) {
  OutputSpec output;
  const auto types = output_types();
  std::vector<std::string> names;
  for (const auto& type : types) names.emplace_back(type.name);
  if (!s.has("type")) s.problem("type", "nothing", "a type of output, e.g. \"collisions\"");
  output.type = s.kind("type", names);
  if (!s.has("type") || s.of_unknown_kind()) return;
  const auto& type = *std::find_if(types.begin(), types.end(),
      [&](const OutputType& known) { return known.name == output.type; });
  output.table = type.extension == ".csv";
  output.file = output.type + std::string(type.extension);
  read_keys(s, output);
  check_common(s, spec, output);
  type.keys.read(s, spec, output);
  s.reject_unknown_keys();
  spec.outputs.push_back(std::move(output));
}

}  // namespace edmill::casefile
