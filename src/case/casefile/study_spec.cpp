#include "casefile/study_spec.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <tuple>

#include "base/errors.hpp"
#include "casefile/precisions.hpp"
#include "casefile/study_tables.hpp"
#include "io/input_file.hpp"

namespace edmill::casefile {

namespace {

bool asks_for_digits(const std::string& case_file) {
  try {
    return read_case(case_file).digits.has_value();
  } catch (const InputError&) {  // told for each run
    return false;
  }
}

void check_study(Section& s, StudySpec& spec) {
  if (!s.has("case")) s.problem("case", "nothing", "a case file");
  if (!spec.case_file.empty()) {
    const std::filesystem::path given(spec.case_file);
    if (given.is_relative()) spec.case_file = (io::folder_of(spec.file) / given).string();
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(spec.case_file, ignored))
      s.problem("case", "no file '" + spec.case_file + "'", "a case file");
    else if (asks_for_digits(spec.case_file))
      s.problem("case", "run.digits in '" + spec.case_file + "'",
                "a case with run.precision: a study makes all its runs in one");
  }
  if (!spec.precision.empty()) check_precision(s, spec.precision);
}

/// Seeds and precision belong to the whole study; other keys of a case have a section.
std::string problem_of_key(const std::string& key) {
  if (key == "run.seed" || key == "run.precision" || key == "run.digits")
    return "a key other than run.seed, run.precision and run.digits";
  if (key != charge_ratio_key && key.find('.') == std::string::npos)
    return "section.key of the case, or charge_ratio";
  return "";
}

void check_key(Section& s, const std::string& key) {
  if (const auto expected = problem_of_key(key); !expected.empty())
    s.problem(key, "a key that cannot be varied", expected);
}

void read_point(Section& entry, SweepSpec& spec) {
  PointTable table;
  read_keys(entry, table);
  SweepSpec::Entry point{table.name, {}};
  if (table.balls.text) point.set.emplace_back("balls", *table.balls.text);
  if (table.ball.text) point.set.emplace_back("ball", *table.ball.text);
  if (!entry.has("set") && !entry.has("balls") && !entry.has("ball"))
    entry.problem("set", "nothing", "a table of keys and values, or [[sweep.point.balls]]");
  Named<Setting> settings;
  Section& set = *table.set.section;
  read_keys(set, settings);
  for (const auto& key : set.keys()) {
    check_key(set, key);
    for (const auto& axis : spec.grid)
      if (axis.key == key) set.problem(key, "a key of [sweep.grid]", "a key in one of the two");
  }
  point.set.insert(point.set.end(), settings.begin(), settings.end());
  entry.reject_unknown_keys();
  spec.entries.push_back(std::move(point));
}

void check_size(Section& s, const SweepSpec& spec) {
  std::uint64_t runs = std::max<std::uint64_t>(spec.entries.size(), 1) * spec.replicas;
  for (const auto& axis : spec.grid) {
    runs *= std::max<std::uint64_t>(axis.values.size(), 1);
    if (runs > most_runs)
      return s.problem("grid", "more than " + std::to_string(most_runs) + " runs",
                       "fewer points or replicas");
  }
}

void read_range(Section& s, const VariableTable& table, OptimizeVariable& variable) {
  std::string high_unit;
  const std::tuple<const char*, const std::optional<std::string>&, double*, std::string*> ends[] = {
      {"low", table.low.text, &variable.low, &variable.unit},
      {"high", table.high.text, &variable.high, &high_unit}};
  bool good = true;
  for (const auto& [key, text, number, unit] : ends) {
    const auto value = text && !has_comma(*text) ? split_number(*text) : std::nullopt;
    if (value)
      std::tie(*number, *unit) = *value;
    else
      s.problem(key, text ? "\"" + *text + "\"" : "nothing", "a number with a decimal point, and its unit");
    good = good && value;
  }
  if (!good) return;
  s.require(variable.unit == high_unit, "high", "the same unit as 'low'");
  s.require(variable.low < variable.high, "high", "a value above 'low'");
  const bool whole = variable.low == std::floor(variable.low) && variable.high == std::floor(variable.high);
  s.require(!variable.integer || whole, "integer", "whole numbers for 'low' and 'high'");
}

void read_variable(Section& s, OptimizeSpec& spec) {
  VariableTable table;
  read_keys(s, table);
  OptimizeVariable variable;
  variable.key = table.key;
  if (!s.has("key")) s.problem("key", "nothing", "a key of the case");
  if (const auto expected = problem_of_key(variable.key); s.has("key") && !expected.empty())
    s.require(false, "key", expected);
  for (const auto& other : spec.variables)
    s.require(other.key != variable.key, "key", "a key that no other variable has");
  variable.integer = table.integer;
  variable.values = table.values.value_or(std::vector<std::string>{});
  if (s.has("values")) {
    for (const auto* key : {"low", "high", "integer"})
      if (s.has(key)) s.problem(key, "both 'values' and '" + std::string(key) + "'", "one of them");
  } else {
    read_range(s, table, variable);
  }
  s.reject_unknown_keys();
  spec.variables.push_back(std::move(variable));
}

/// Reads the one section of a file, checks it by `check`, and reports everything that is wrong.
template <class Table, class Check>
Table read_study_file(const std::string& path, const std::string& section, const Check& check) {
  const std::string kind = section == "sweep" ? "a sweep file" : "an optimisation file";
  Document document;
  document.name = path;
  const toml::table root = parse_toml(read_file(path, kind), kind, document);
  Table table;
  table.file = path;
  Section top(document, &root, "");
  if (!top.has(section)) top.problem(section, "nothing", "a section [" + section + "]");
  Section s = top.section(section);
  read_keys(s, table);
  check_study(s, table);
  check(s, table);
  s.reject_unknown_keys();
  top.reject_unknown_keys();
  if (!document.problems.empty()) throw InputError(document.problems_by_line());
  return table;
}

}  // namespace

std::optional<Setting> Setting::read(Section& section, const std::string& key) {
  const auto value = section.setting(key);
  return value ? std::optional(Setting(key, *value)) : std::nullopt;
}

std::optional<GridAxis> GridAxis::read(Section& grid, const std::string& key) {
  return GridAxis{key, grid.settings(key)};
}

SweepSpec read_sweep(const std::string& path) {
  return read_study_file<SweepTable>(path, "sweep", [](Section& s, SweepTable& table) {
    Section& grid = *table.grid_table.section;
    Named<GridAxis> axes;
    read_keys(grid, axes);
    table.grid = axes;
    for (const auto& axis : table.grid) check_key(grid, axis.key);
    for (auto& entry : table.points) read_point(entry, table);
    check_size(s, table);
  });
}

OptimizeSpec read_optimize(const std::string& path) {
  return read_study_file<OptimizeTable>(path, "optimize", [](Section& s, OptimizeTable& table) {
    s.require(table.replicas_max >= table.replicas_first, "replicas_max", "at least 'replicas_first'");
    if (!s.has("variable")) s.problem("variable", "nothing", "1 to 3 entries [[optimize.variable]]");
    for (auto& variable : table.variable_tables) read_variable(variable, table);
    s.require(table.variable_tables.size() <= 3, "variable", "1 to 3 entries [[optimize.variable]]");
  });
}

}  // namespace edmill::casefile
