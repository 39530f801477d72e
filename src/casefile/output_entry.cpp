#include "casefile/output_entry.hpp"

#include <algorithm>
#include <filesystem>

#include "model/impact_variables.hpp"

namespace edmill::casefile {

namespace {

using model::impact_variables;
using model::VariableKind;

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
