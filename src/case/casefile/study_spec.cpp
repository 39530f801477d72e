#include "casefile/study_spec.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <tuple>

#include "base/errors.hpp"
#include "casefile/key_reader.hpp"
#include "casefile/precisions.hpp"
#include "casefile/section.hpp"
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

void read_study(Section& s, StudySpec& spec) {
  if (const auto name = s.text("case")) {
    const std::filesystem::path given(*name);
    spec.case_file = given.is_relative() ? (io::folder_of(spec.file) / given).string() : *name;
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(spec.case_file, ignored))
      s.problem("case", "no file '" + spec.case_file + "'", "a case file");
    else if (asks_for_digits(spec.case_file))
      s.problem("case", "run.digits in '" + spec.case_file + "'",
                "a case with run.precision: a study makes all its runs in one");
  } else if (!s.has("case")) {
    s.problem("case", "nothing", "a case file");
  }
  const auto precision = read_precision(s);
  if (s.has("precision")) spec.precision = precision;
  if (const auto limit = s.quantity("max_cpu_time", Dimension::time)) {
    s.require(limit->positive(), "max_cpu_time", "a time above 0");
    spec.max_cpu_time = limit->to<double>();
  }
}

/// Lists of a case that a point may replace as a whole.
constexpr std::string_view charge_lists[] = {"balls", "ball"};

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

void read_entry(Section entry, SweepSpec& spec) {
  SweepSpec::Entry point;
  point.name = entry.text("name").value_or("");
  bool lists = false;
  for (const auto name : charge_lists) {
    const std::string list(name);
    if (!entry.has(list)) continue;
    lists = true;
    if (const auto value = entry.setting(list)) point.set.emplace_back(list, *value);
  }
  if (!entry.has("set") && !lists)
    entry.problem("set", "nothing", "a table of keys and values, or [[sweep.point.balls]]");
  Section set = entry.section("set");
  for (const auto& key : set.keys()) {
    if (const auto value = set.setting(key)) point.set.emplace_back(key, *value);
    check_key(set, key);
    for (const auto& axis : spec.grid)
      if (axis.key == key) set.problem(key, "a key of [sweep.grid]", "a key in one of the two");
  }
  entry.reject_unknown_keys();
  spec.entries.push_back(std::move(point));
}

void read_grid(Section grid, SweepSpec& spec) {
  for (const auto& key : grid.keys()) {
    spec.grid.push_back({key, grid.settings(key)});
    check_key(grid, key);
  }
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

void read_range(Section& s, OptimizeVariable& variable) {
  std::string high_unit;
  const std::tuple<const char*, double*, std::string*> ends[] = {{"low", &variable.low, &variable.unit},
                                                                 {"high", &variable.high, &high_unit}};
  bool good = true;
  for (const auto& [key, number, unit] : ends) {
    const auto text = s.setting(key);
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

void read_variable(Section s, OptimizeSpec& spec) {
  OptimizeVariable variable;
  variable.key = s.text("key").value_or("");
  if (!s.has("key")) s.problem("key", "nothing", "a key of the case");
  if (const auto expected = problem_of_key(variable.key); s.has("key") && !expected.empty())
    s.require(false, "key", expected);
  for (const auto& other : spec.variables)
    s.require(other.key != variable.key, "key", "a key that no other variable has");
  variable.integer = s.flag("integer");
  variable.values = s.settings("values");
  if (s.has("values")) {
    for (const auto* key : {"low", "high", "integer"})
      if (s.has(key)) s.problem(key, "both 'values' and '" + std::string(key) + "'", "one of them");
    s.setting("low"), s.setting("high");
  } else {
    read_range(s, variable);
  }
  s.reject_unknown_keys();
  spec.variables.push_back(std::move(variable));
}

/// Reads the one section of a file by `read`, and reports everything that is wrong.
template <class Spec, class Read>
Spec read_study_file(const std::string& path, const std::string& section, const Read& read) {
  const std::string kind = section == "sweep" ? "a sweep file" : "an optimisation file";
  Document document;
  document.name = path;
  const toml::table root = parse_toml(read_file(path, kind), kind, document);
  Spec spec;
  spec.file = path;
  Section top(document, &root, "");
  if (!top.has(section)) top.problem(section, "nothing", "a section [" + section + "]");
  Section s = top.section(section);
  read_study(s, spec);
  read_keys(s, spec);
  read(s, spec);
  s.reject_unknown_keys();
  top.reject_unknown_keys();
  if (!document.problems.empty()) throw InputError(document.problems);
  return spec;
}

}  // namespace

SweepSpec read_sweep(const std::string& path) {
  return read_study_file<SweepSpec>(path, "sweep", [](Section& s, SweepSpec& spec) {
    read_grid(s.section("grid"), spec);
    for (const auto& entry : s.sections("point")) read_entry(entry, spec);
    check_size(s, spec);
  });
}

OptimizeSpec read_optimize(const std::string& path) {
  return read_study_file<OptimizeSpec>(path, "optimize", [](Section& s, OptimizeSpec& spec) {
    spec.objective = s.choice("objective", {"specific_milling_dose_rate", "milling_dose_rate"});
    s.require(spec.replicas_max >= spec.replicas_first, "replicas_max", "at least 'replicas_first'");
    const auto variables = s.sections("variable");
    if (!s.has("variable")) s.problem("variable", "nothing", "1 to 3 entries [[optimize.variable]]");
    for (const auto& variable : variables) read_variable(variable, spec);
    s.require(variables.size() <= 3, "variable", "1 to 3 entries [[optimize.variable]]");
  });
}

}  // namespace edmill::casefile
