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

std::string names_of(const std::vector<Statistic>& list) {
  std::vector<std::string> names;
  for (const auto s : list) names.push_back(statistic_name(s));
  return listed(names);
}

void read_timer(Section& s, TimerSpec& timer) {
  read_keys(s, timer);
  if (timer.start_time && timer.end_time)
    s.require(*timer.end_time > *timer.start_time, "end_time", "a time after start_time");
}

void read_restrictions(Section& s, std::vector<Restriction>& only) {
  Section table = s.section("only");
  for (const auto& key : table.keys()) {
    const auto found = model::find_variable(key);
    if (!found || impact_variables[*found].kind == VariableKind::number) {
      std::string names;
      for (const auto& v : impact_variables)
        if (v.kind != VariableKind::number) names += (names.empty() ? "" : ", ") + std::string(v.name);
      table.problem(key, "a restriction on '" + key + "'", "one of " + names);
    } else if (impact_variables[*found].kind == VariableKind::flag) {
      only.push_back({*found, table.flag(key) ? 1u : 0u});
    } else {
      only.push_back({*found, table.count(key).value_or(0)});
    }
  }
}

void read_place(Section& s, const CaseSpec& spec, const OutputType& type, OutputSpec& output) {
  output.file = s.text("file").value_or(output.type + std::string(type.extension));
  const bool plain = output.file.find('/') == std::string::npos && output.file != "." && output.file != "..";
  s.require(plain, "file", "a plain file name");
  if (const auto folder = s.text("folder")) {
    output.folder = *folder;
    const auto& f = output.folder;
    const bool inside = f.front() != '/' && ("/" + f + "/").find("/../") == std::string::npos;
    s.require(inside, "folder", "a folder inside the run's folder");
  }
  const auto place = [](const OutputSpec& o) {
    return (std::filesystem::path("run") / o.folder / o.file).lexically_normal();
  };
  for (const auto* taken : {"summary.json", "final_state.csv", "case.toml", "report.html", "checkpoint"})
    s.require(
        place(output) != std::filesystem::path("run") / taken, "file",
        "a plain file name other than the run's own summary.json, final_state.csv, case.toml, report.html "
        "and checkpoint");
  const bool table = type.extension == ".csv";
  if (table) {
    output.append = s.flag("append");
    s.require(!output.append || !output.hdf5(), "append", "false for HDF5");
  }
  for (const auto& other : spec.outputs)
    s.require(place(other) != place(output) || (other.append && output.append), "file",
              "a file name that no other output has, unless both append");
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
  return fmt::format("{}", fmt::join(names, ", "));
}

void read_output(Section s, CaseSpec& spec) {
  OutputSpec output;
  const auto types = output_types();
  std::vector<std::string> names;
  for (const auto& type : types) names.emplace_back(type.name);
  if (!s.has("type")) s.problem("type", "nothing", "a type of output, e.g. \"collisions\"");
  output.type = s.kind("type", names);
  if (!s.has("type") || s.of_unknown_kind()) return;
  const auto& type = *std::find_if(types.begin(), types.end(),
                                   [&](const OutputType& known) { return known.name == output.type; });
  read_place(s, spec, type, output);
  read_timer(s, output.timer);
  read_restrictions(s, output.only);
  type.read(s, spec, output);
  s.reject_unknown_keys();
  spec.outputs.push_back(std::move(output));
}

}  // namespace edmill::casefile
