// The commands that make and check cases, and list mills and outputs.
#pragma once

#include "app/judge.hpp"
#include "cli/commands/case_argument.hpp"
#include "cli/exit_codes.hpp"
#include "io/input_file.hpp"
#include "io/output_folder.hpp"
#include "io/terminal.hpp"
#include "machines/machines.hpp"
#include "model/variables.hpp"

namespace edmill::cli {

struct Machines {
  static constexpr const char* name = "machines";
  static constexpr const char* what =
      "list the mills that edmill new knows, with the sources of their numbers";

  void add_options(CLI::App& command) {
    command.add_flag("--markdown", markdown_, "print Markdown, for the manual");
  }
  int run() {
    io::print("{}", markdown_ ? machines::markdown() : machines::table());
    return ok;
  }
 private:
  bool markdown_ = false;
};

struct New {
  static constexpr const char* name = "new";
  static constexpr const char* what =
      "write a commented case file for a mill, its balls and its powder";

  void add_options(CLI::App& command) {
    command.add_option("--mill", wanted_.machine,
        "mill, one of those that edmill machines lists: \"pm100\" or \"Retsch PM 100\" (default: "
        "spex8000)");
    command.add_option("--jar", wanted_.jar,
        "volume of the jar, \"250ml\", or its inner diameter and height, \"75x57mm\" (default: the "
        "usual jar of the mill)");
    add_list(command, "--balls", wanted_.balls,
        "number, diameter and optional material of balls, \"10x12.7mm\" or \"10x12.7mm:zirconia\"; "
        "with --fill or --bpr the diameter alone; can be repeated (default: \"10x10mm:steel\")");
    command.add_option("--fill", wanted_.fill,
        "share of the jar that the balls fill, including the gaps between them, \"30%\": "
        "determines the number of balls");
    command.add_option("--powder", wanted_.powder, "mass of the powder, \"5g\" (default: none)");
    command.add_option("--bpr", wanted_.ratio,
        "ratio of the mass of the balls to that of the powder, 10: determines the number of balls, "
        "or the mass of the powder");
    command.add_option("--target-dose", wanted_.target_dose,
        "target dose of the powder, \"10 kJ/g\" (default: none)");
    command.add_option(
        "--speed", wanted_.speed, "speed of the drive (default: the usual speed of the mill)");
    command.add_option("--restitution", wanted_.restitution,
        "coefficient of restitution of all contacts (default: chosen by powder and balls)");
    command.add_option(
        "--friction", wanted_.friction, "coefficient of friction of all contacts (default: 0.4)");
    command.add_option("--time", wanted_.time, "simulated time (default: \"10 s\")");
    command.add_option("--out", file_,
        "file for the case, written completely or not at all (default: standard output)");
    command.add_flag("--force", force_, "replace an existing file that has other contents");
  }
  int run() {
    const auto text = machines::new_case(wanted_);
    app::check(casefile::parse_case(text, "the new case"));  // the balls have room
    if (file_.empty() || file_ == "-")
      io::print("{}", text);
    else if (!force_ && std::filesystem::is_regular_file(file_) && io::content_of(file_) != text)
      throw InputError(fmt::format(
          "--out: \"{}\" exists with other contents: give another name, or --force", file_));
    else
      io::NamedFile(file_).write(text);
    return ok;
  }
 private:
  machines::Wanted wanted_;
  std::string file_;
  bool force_ = false;
};

struct Check {
  static constexpr const char* name = "check";
  static constexpr const char* what =
      "check a case and print it in SI with derived numbers, or check the format of a log";

  void add_options(CLI::App& command) {
    given_.add_to(command);
    command.get_option("case")->description("case file (TOML), or a log (CSV)");
    command.add_option("--json", json_, "file for the description of a log in JSON");
    command.add_option("--draw", drawing_, "file for a drawing of how the vessel moves (SVG)");
  }
  int run() {
    if (app::is_log(given_.file)) return check_log();
    const auto spec = given_.read();
    io::print("{}", app::check(spec).text());
    if (!drawing_.empty()) app::draw_mill(spec, drawing_);
    return ok;
  }
 private:
  int check_log() const {
    io::NamedFile file(json_);
    const auto log = app::describe_log(given_.file);
    file.write(log.json());
    io::print("{}", log.text());
    return ok;
  }

  CaseArgument given_;
  std::string drawing_, json_;
};

/// All variables that outputs can contain, as Markdown tables; docs/variables.md contains them.
inline std::string list_variables() {
  using model::VariableKind;
  std::string text;
  const auto add = [&](const char* title, const auto& variables, const auto& belongs) {
    text += fmt::format("{}## {}\n\n| name | thesis | unit | meaning |\n|---|---|---|---|\n",
        text.empty() ? "" : "\n", title);
    for (const auto& v : variables)
      if (belongs(v))
        text += fmt::format("| `{}` | {} | {} | {} |\n", v.name,
            v.thesis.empty() ? "" : fmt::format("`{}`", v.thesis), v.unit, v.meaning);
  };
  const auto is = [](VariableKind kind) {
    return [kind](const auto& v) { return v.kind == kind; };
  };
  add("Flags of an impact (table D.3)", model::impact_variables, is(VariableKind::flag));
  add("Counts of an impact (table D.4)", model::impact_variables, is(VariableKind::count));
  add("Numbers of an impact (table D.5)", model::impact_variables, is(VariableKind::number));
  add("Quantities of a ball (D.4.7)", model::ball_variables, [](const auto&) { return true; });
  return text;
}

struct Variables {
  static constexpr const char* name = "variables";
  static constexpr const char* what =
      "list the variables that outputs can contain, as Markdown tables";

  void add_options(CLI::App&) {}
  int run() {
    io::print("{}", list_variables());
    return ok;
  }
};

}  // namespace edmill::cli
