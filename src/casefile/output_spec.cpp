#include <algorithm>
#include <cmath>
#include <filesystem>

#include "casefile/output_keys.hpp"
#include "model/ball_variables.hpp"
#include "model/impact_variables.hpp"

namespace edmill::casefile {

namespace {

using model::impact_variables;
using model::VariableKind;

const std::vector<std::pair<std::string, Statistic>> statistic_names{
    {"sum", Statistic::sum},         {"average", Statistic::average}, {"minimum", Statistic::minimum},
    {"maximum", Statistic::maximum}, {"rate", Statistic::rate},       {"percentage", Statistic::percentage}};

/// What a type of output allows in its columns.
struct ColumnRules {
  bool flags, counts, numbers;
  std::vector<Statistic> of_flags, of_numbers;  ///< none: the type shows single values
};

bool is_one_of(const std::vector<Statistic>& list, Statistic s) {
  return std::find(list.begin(), list.end(), s) != list.end();
}

std::string names_of(const std::vector<Statistic>& list) {
  std::string text;
  for (const auto& [name, statistic] : statistic_names)
    if (is_one_of(list, statistic)) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// The dimension in which a unit of the variables is given in a case.
Dimension dimension_of(std::string_view unit) {
  if (unit == "s") return Dimension::time;
  if (unit == "m") return Dimension::length;
  if (unit == "m/s") return Dimension::speed;
  if (unit == "rad") return Dimension::angle;
  if (unit == "rad/s") return Dimension::angular_speed;
  if (unit == "J") return Dimension::energy;
  return Dimension::none;
}

void read_timer(Section& s, TimerSpec& timer) {
  timer.on = !s.has("on") || s.flag("on");
  timer.start_time = s.quantity("start_time", Dimension::time);
  timer.end_time = s.quantity("end_time", Dimension::time);
  timer.duration = s.quantity("duration", Dimension::time);
  timer.start_collision = s.count("start_collision");
  timer.collisions = s.count("collisions");
  for (const auto* key : {"start_time", "end_time"}) {
    const auto& time = key == std::string("end_time") ? timer.end_time : timer.start_time;
    s.require(!time || !time->negative(), key, "a time of 0 or more");
  }
  if (timer.start_time && timer.end_time)
    s.require(timer.end_time->value > timer.start_time->value, "end_time", "a time after start_time");
  s.require(!timer.duration || timer.duration->positive(), "duration", "a positive time");
  s.require(!timer.collisions || *timer.collisions > 0, "collisions", "at least 1");
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

/// Reads `variable`; place in impact_variables, or nothing when it is wrong, which is reported.
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
  std::string expected;
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
    const auto row = std::find_if(statistic_names.begin(), statistic_names.end(),
                                  [&](const auto& known) { return known.first == name; });
    const bool good = row != statistic_names.end() && is_one_of(allowed, row->second);
    if (good)
      list.push_back(row->second);
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

const std::vector<Statistic> all_statistics{Statistic::sum,     Statistic::average, Statistic::minimum,
                                            Statistic::maximum, Statistic::rate,    Statistic::percentage};
const std::vector<Statistic> without_percentage{all_statistics.begin(), all_statistics.end() - 1};
const std::vector<Statistic> counted{Statistic::sum, Statistic::rate};

void read_milling_dose(Section& s, OutputSpec& output) {
  const std::vector<std::string> known{
      "milling_dose",          "milling_dose_rate",          "inverse_milling_dose_rate",
      "specific_milling_dose", "specific_milling_dose_rate", "powder_mass",
      "charge_ratio"};
  output.fields = s.has("fields") ? s.settings("fields") : known;
  for (const auto& field : output.fields)
    if (std::find(known.begin(), known.end(), field) == known.end()) {
      std::string names;
      for (const auto& name : known) names += (names.empty() ? "" : ", ") + name;
      s.problem("fields", "\"" + field + "\"", "an array of " + names);
    }
}

void read_frequency(Section& s, OutputSpec& output) {
  auto& f = output.frequency;
  const auto variable = read_variable(s, false, false, true);
  f.variable.variable = variable.value_or(0);
  f.variable.label = s.text("label").value_or("");
  const auto dimension = dimension_of(impact_variables[f.variable.variable].unit);
  for (const auto& [key, bound] : {std::pair{"low", &f.low}, {"high", &f.high}}) {
    if (variable)
      *bound = s.required(key, dimension);
    else
      s.setting(key);  // of unknown dimension: nothing to check it against
  }
  if (variable && s.has("low") && s.has("high"))
    s.require(size_of(f.high) > size_of(f.low), "high", "a value above low");
  f.intervals = s.count("intervals").value_or(10);
  s.require(f.intervals > 0 && f.intervals <= 1000000, "intervals", "1 to 1000000");
  f.title = s.text("title").value_or("");
  f.wall_details = s.flag("wall_details");
  f.percentages = s.flag("percentages");
  f.out_of_range = s.flag("out_of_range");
}

void read_statistics_output(Section& s, OutputSpec& output) {
  read_columns(s,
               {true, false, true, {Statistic::sum, Statistic::percentage, Statistic::rate}, all_statistics},
               output);
}

void read_trends(Section& s, OutputSpec& output) {
  read_interval(s, output.timer, Quantity{30});
  if (!output.timer.max_rows) output.timer.max_rows = 32000;
  output.accumulated = s.flag("accumulated");
  read_columns(s, {true, true, true, counted, without_percentage}, output);
}

void read_trends_instant(Section& s, OutputSpec& output) {
  read_interval(s, output.timer);
  read_columns(s, {true, true, true, {}, {}}, output);
}

void read_trends_balls(Section& s, OutputSpec& output) {
  read_interval(s, output.timer, Quantity{30});
  const std::vector<Statistic> allowed{Statistic::sum, Statistic::average, Statistic::minimum,
                                       Statistic::maximum};
  for (Section& entry : s.sections("columns")) {
    ColumnSpec column;
    const auto name = entry.text("variable").value_or("");
    const auto found = model::find_ball_variable(name);
    std::string names;
    for (const auto& v : model::ball_variables) names += (names.empty() ? "" : ", ") + std::string(v.name);
    entry.require(found.has_value(), "variable", "one of " + names);
    column.variable = found.value_or(0);
    column.statistics = read_statistics(entry, allowed);
    column.label = entry.text("label").value_or("");
    column.with_ball = entry.flag("with_ball");
    entry.reject_unknown_keys();
    output.columns.push_back(std::move(column));
  }
  if (!s.has("columns")) s.problem("columns", "nothing", "an array of tables with `variable`");
}

void read_trace(Section& s, OutputSpec& output) {
  read_interval(s, output.timer);
  output.ball = s.count("ball").value_or(0);
}

void read_collisions(Section& s, OutputSpec& output) { output.states = s.flag("states"); }

void read_iterations(Section&, OutputSpec&) {}

/// A new output is a row here, with its keys, and a class in output/ with a row in make_outputs.
struct Kind {
  const char* type;
  const char* extension;
  void (*read)(Section&, OutputSpec&);
};
constexpr Kind kinds[] = {{"collisions", ".csv", read_collisions},
                          {"milling_dose", ".csv", read_milling_dose},
                          {"frequency", ".csv", read_frequency},
                          {"statistics", ".csv", read_statistics_output},
                          {"trends", ".csv", read_trends},
                          {"trends_instant", ".csv", read_trends_instant},
                          {"trends_balls", ".csv", read_trends_balls},
                          {"trace", ".csv", read_trace},
                          {"iterations", ".csv", read_iterations},
                          {"events", ".h5", read_collisions},
                          {"spectra", ".csv", read_spectra},
                          {"rates_above", ".csv", read_rates_above},
                          {"vessel_load", ".csv", read_vessel_load},
                          {"coverage", ".csv", read_coverage},
                          {"snapshot", ".x3d", read_snapshot},
                          {"animation", ".x3d", read_animation},
                          {"paraview", ".pvd", read_paraview}};

void read_place(Section& s, const CaseSpec& spec, const Kind& kind, OutputSpec& output) {
  output.file = s.text("file").value_or(output.type + kind.extension);
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
  const bool table = std::string_view(kind.extension) == ".csv";
  if (table) {
    output.append = s.flag("append");
    s.require(!output.append || !output.hdf5(), "append", "false for HDF5");
    s.require(output.type != "collisions" || !output.hdf5(), "file",
              "a name ending in .csv; `events` is the log as HDF5");
  }
  for (const auto& other : spec.outputs)
    s.require(place(other) != place(output) || (other.append && output.append), "file",
              "a file name that no other output has, unless both append");
}

}  // namespace

void read_interval(Section& s, TimerSpec& timer, const std::optional<Quantity>& fallback) {
  timer.interval = s.quantity("interval", Dimension::time);
  s.require(!timer.interval || timer.interval->positive(), "interval", "a positive time");
  if (!timer.interval) timer.interval = fallback;
  timer.max_rows = s.count("max_rows");
  s.require(!timer.max_rows || *timer.max_rows > 0, "max_rows", "at least 1");
}

double size_of(const Quantity& quantity) {
  return quantity.value.convert_to<double>() * std::pow(3.14159265358979, quantity.pi_power);
}

void read_output(Section s, CaseSpec& spec) {
  OutputSpec output;
  std::vector<std::string> types;
  for (const auto& kind : kinds) types.push_back(kind.type);
  if (!s.has("type")) s.problem("type", "nothing", "a type of output, e.g. \"collisions\"");
  output.type = s.choice("type", types);
  const auto& kind =
      *std::find_if(std::begin(kinds), std::end(kinds), [&](const Kind& k) { return output.type == k.type; });
  read_place(s, spec, kind, output);
  read_timer(s, output.timer);
  read_restrictions(s, output.only);
  kind.read(s, output);
  if (output.type == "trace" && spec.ball_count() > 0)
    s.require(output.ball < spec.ball_count(), "ball", "a ball of the case; they count from 0");
  s.reject_unknown_keys();
  spec.outputs.push_back(std::move(output));
}

}  // namespace edmill::casefile
