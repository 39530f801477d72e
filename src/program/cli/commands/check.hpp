// The commands that tell what a case says and what outputs can show.
#pragma once

#include "app/check_case.hpp"
#include "cli/commands/case_argument.hpp"
#include "cli/exit_codes.hpp"
#include "io/terminal.hpp"
#include "model/variables.hpp"

namespace edmill::cli {

struct Check {
  static constexpr const char* name = "check";
  static constexpr const char* what = "read and check a case; print it in SI with derived numbers";

  void add_options(CLI::App& command) {
    given_.add_to(command);
    command.add_option("--draw", drawing_, "also draw how the vessel moves into this SVG file");
  }
  int run() {
    const auto spec = given_.read();
    io::print("{}", app::check(spec).text());
    if (!drawing_.empty()) app::draw_mill(spec, drawing_);
    return ok;
  }

 private:
  CaseArgument given_;
  std::string drawing_;
};

/// All variables that outputs can contain, as Markdown tables; docs/variables.md contains them.
inline std::string list_variables() {
  using model::VariableKind;
  const auto thesis = [](std::string_view name) { return name.empty() ? "" : fmt::format("`{}`", name); };
  std::string text;
  const auto add_impact = [&](VariableKind kind, const char* title) {
    text += fmt::format("## {}\n\n| name | thesis | unit | meaning |\n|---|---|---|---|\n", title);
    for (const auto& v : model::impact_variables)
      if (v.kind == kind)
        text += fmt::format("| `{}` | {} | {} | {} |\n", v.name, thesis(v.thesis), v.unit, v.meaning);
    text += '\n';
  };
  add_impact(VariableKind::flag, "Flags of an impact (table D.3)");
  add_impact(VariableKind::count, "Counts of an impact (table D.4)");
  add_impact(VariableKind::number, "Numbers of an impact (table D.5)");
  text += "## Quantities of a ball (D.4.7)\n\n| name | thesis | unit | meaning |\n|---|---|---|---|\n";
  for (const auto& v : model::ball_variables)
    text += fmt::format("| `{}` | {} | {} | {} |\n", v.name, thesis(v.thesis), v.unit, v.meaning);
  return text;
}

struct Variables {
  static constexpr const char* name = "variables";
  static constexpr const char* what = "list the variables that outputs can show, as Markdown tables";

  void add_options(CLI::App&) {}
  int run() {
    io::print("{}", list_variables());
    return ok;
  }
};

}  // namespace edmill::cli
