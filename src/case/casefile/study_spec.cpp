#include "casefile/study_spec.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <tuple>

#include "base/errors.hpp"
#include "casefile/case_spec.hpp"
#include "casefile/keys.hpp"
#include "io/input_file.hpp"

namespace edmill::casefile {

namespace {

bool asks_for_digits(const std::string& case_file) try {
  return read_case(case_file).digits.has_value();
} catch (const InputError&) {  // reported for each run
  return false;
}

void check_study(Section& s, StudySpec& spec) {
  if (!s.has("case")) s.problem("case", "nothing", "a case file");
  if (!spec.case_file.empty()) {
    spec.case_file = (io::folder_of(spec.file) / spec.case_file).string();
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(spec.case_file, ignored))
      s.problem("case", "\"" + spec.case_file + "\", which cannot be read", "a case file");
    else if (asks_for_digits(spec.case_file))
      s.problem("case", "run.digits in '" + spec.case_file + "'",
          "a case with run.precision: all runs of a study have one precision");
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

/// Reports keys that cannot be varied, and keys that are in the grid as well as in points.
void check_keys(Section& s, const SweepSpec& spec) {
  Section grid = s.section("grid");
  for (const auto& axis : spec.grid) check_key(grid, axis.key);
  for (Section& entry : s.sections("point")) {
    Section set = entry.section("set");
    for (const auto& key : set.keys()) {
      check_key(set, key);
      for (const auto& axis : spec.grid)
        if (axis.key == key)
          set.problem(key, "a key of [sweep.grid]", "the key in only one of the two");
    }
  }
}

void check_size(Section& s, const SweepSpec& spec) {
  std::uint64_t runs = std::max<std::uint64_t>(spec.entries.size(), 1) * spec.replicas;
  for (const auto& axis : spec.grid) {
    runs *= std::max<std::uint64_t>(axis.values.size(), 1);
    if (runs > most_runs)
      return s.problem(
          "grid", "more than " + std::to_string(most_runs) + " runs", "fewer points or replicas");
  }
}

void read_range(Section& s, OptimizeVariable& variable) {
  const auto bound = [&](const char* key, const std::optional<std::string>& text) {
    const auto value = text && !has_comma(*text) ? split_number(*text) : std::nullopt;
    if (!value)
      s.problem(key, text ? "\"" + *text + "\"" : "nothing",
          "a number with a decimal point, and its unit");
    return value;
  };
  const auto low = bound("low", variable.least.text), high = bound("high", variable.most.text);
  if (!low || !high) return;
  std::tie(variable.low, variable.unit) = *low;
  variable.high = high->first;
  s.require(variable.unit == high->second, "high", "the same unit as 'low'");
  s.require(variable.low < variable.high, "high", "a value above 'low'");
  const bool whole =
      variable.low == std::floor(variable.low) && variable.high == std::floor(variable.high);
  s.require(!variable.integer || whole, "integer", "whole numbers for 'low' and 'high'");
}

/// Reads the one section of a file, checks it by `check`, and reports everything that is wrong.
template <class Spec>
Spec read_study_file(const std::string& path, const std::string& section, const auto& check) {
  const std::string kind = section == "sweep" ? "a sweep file" : "an optimisation file";
  Document document(path);
  const toml::table root = parse_toml(io::read_whole(path, kind + " (TOML)"), kind, document);
  Spec spec;
  spec.file = path;
  Section top(document, &root, "");
  if (!top.has(section) &&
      (top.has("mill") || top.has("vessel") || top.has("ball") || top.has("balls")))
    throw InputError(path + ": found a case file, expected " + kind + ": use edmill run");
  if (!top.has(section)) top.problem(section, "nothing", "a section [" + section + "]");
  Section s = top.section(section);
  read_keys(s, spec);
  check_study(s, spec);
  check(s, spec);
  s.reject_unknown_keys();
  top.reject_unknown_keys();
  if (!document.problems.empty()) throw InputError(document.problems_by_line());
  return spec;
}

}  // namespace

std::optional<Setting> Setting::read(Section& section, const std::string& key) {
  const auto value = section.setting(key);
  return value ? std::optional(Setting(key, *value)) : std::nullopt;
}

std::optional<GridAxis> GridAxis::read(Section& grid, const std::string& key) {
  return GridAxis{key, grid.settings(key)};
}

void SweepPoint::check(Section& entry, std::vector<SweepPoint>& points) {
  auto& [name, set, balls, ball] = points.back();
  if (!entry.has("set") && !entry.has("balls") && !entry.has("ball"))
    entry.problem("set", "nothing", "a table of keys and values, or [[sweep.point.balls]]");
  if (ball.text) set.emplace(set.begin(), "ball", *ball.text);
  if (balls.text) set.emplace(set.begin(), "balls", *balls.text);
}

void OptimizeVariable::check(Section& s, std::vector<OptimizeVariable>& variables) {
  auto& own = variables.back();
  const auto expected = s.has("key") ? problem_of_key(own.key) : "a key of the case";
  s.require(expected.empty(), "key", expected);
  for (const auto& other : variables)
    s.require(other.key != own.key || &other == &own, "key", "a key that no other variable has");
  if (!s.has("values")) return read_range(s, own);
  for (const auto* key : {"low", "high", "integer"})
    if (s.has(key)) s.problem(key, "both 'values' and '" + std::string(key) + "'", "one of them");
}

SweepSpec read_sweep(const std::string& path) {
  return read_study_file<SweepSpec>(path, "sweep", [](Section& s, const SweepSpec& spec) {
    check_keys(s, spec);
    check_size(s, spec);
  });
}

OptimizeSpec read_optimize(const std::string& path) {
  return read_study_file<OptimizeSpec>(path, "optimize", [](Section& s, const OptimizeSpec& spec) {
    s.require(
        spec.replicas_max >= spec.replicas_first, "replicas_max", "at least 'replicas_first'");
    const std::string expected = "1 to 3 entries [[optimize.variable]]";
    if (!s.has("variable")) s.problem("variable", "nothing", expected);
    s.require(spec.variables.size() <= 3, "variable", expected);
  });
}

}  // namespace edmill::casefile
