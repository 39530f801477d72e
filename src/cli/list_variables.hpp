// The command `edmill variables`.
#pragma once

#include <fmt/format.h>

#include <string>

#include "model/ball_variables.hpp"
#include "model/impact_variables.hpp"

namespace edmill::cli {

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

}  // namespace edmill::cli
