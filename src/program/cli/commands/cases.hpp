// The commands that make and check cases, and list mills and outputs.
#pragma once

#include "app/check_case.hpp"
#include "app/check_log.hpp"
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
    command.add_flag("--markdown", markdown_, "as a page of the manual");
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
  static constexpr const char* what = "write a case with comments: a mill, balls, powder";

  void add_options(CLI::App& command) {
    command.add_option("--mill", wanted_.machine,
                       "one of edmill machines, \"pm100\" or \"Retsch PM 100\" (default: spex8000)");
    command.add_option(
        "--jar", wanted_.jar,
        "volume of the jar, \"250ml\", or its inner diameter and height, \"75x57mm\" (default: "
        "the mill's usual one)");
    command
        .add_option("--balls", wanted_.balls,
                    "number and diameter, \"10x12.7mm\", and a material, \"10x12.7mm:zirconia\"; a diameter "
                    "alone with --fill or --bpr; can be repeated (default: 10 of 10 mm of steel)")
        ->take_all()
        ->expected(1);
    command.add_option("--fill", wanted_.fill,
                       "as many balls as fill this share of the jar with the gaps between them, \"30%\"");
    command.add_option("--powder", wanted_.powder, "mass of the powder, \"5g\" (default: none)");
    command.add_option(
        "--bpr", wanted_.ratio,
        "mass of the balls over that of the powder, 10: finds the number of balls, or the powder");
    command.add_option("--target-dose", wanted_.target_dose, "target dose of the powder, \"10 kJ/g\"");
    command.add_option("--speed", wanted_.speed, "speed of the drive (default: the mill's usual one)");
    command.add_option("--restitution", wanted_.restitution,
                       "restitution of all contacts (default: by powder and balls)");
    command.add_option("--friction", wanted_.friction, "friction of all contacts (default: 0.4)");
    command.add_option("--time", wanted_.time, "simulated time (default: \"10 s\")");
    command.add_option("--out", file_,
                       "file of the case, written whole or not at all; standard output by default");
    command.add_flag("--force", force_, "replace a file that has been edited");
  }
  int run() {
    const auto text = machines::new_case(wanted_);
    app::check(casefile::parse_case(text, "the new case"));  // the balls have room
    if (file_.empty() || file_ == "-")
      io::print("{}", text);
    else if (!force_ && std::filesystem::is_regular_file(file_) && io::content_of(file_) != text)
      throw InputError(fmt::format(
          "--out: found \"{}\", which has other contents, expected a new name, or --force", file_));
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
      "read and check a case; print it in SI with derived numbers. Or check the format of a log";

  void add_options(CLI::App& command) {
    given_.add_to(command);
    command.get_option("case")->description("case file (TOML), or a log (CSV)");
    command.add_option("--json", json_, "of a log: file for its description in JSON");
    command.add_option("--draw", drawing_, "also draw how the vessel moves into this SVG file");
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
  const auto is = [](VariableKind kind) { return [kind](const auto& v) { return v.kind == kind; }; };
  add("Flags of an impact (table D.3)", model::impact_variables, is(VariableKind::flag));
  add("Counts of an impact (table D.4)", model::impact_variables, is(VariableKind::count));
  add("Numbers of an impact (table D.5)", model::impact_variables, is(VariableKind::number));
  add("Quantities of a ball (D.4.7)", model::ball_variables, [](const auto&) { return true; });
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
