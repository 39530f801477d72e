// The commands that know mills that one can buy.
#pragma once

#include <CLI/CLI.hpp>

#include "app/check_case.hpp"
#include "cli/exit_codes.hpp"
#include "io/output_folder.hpp"
#include "io/terminal.hpp"
#include "machines/machines.hpp"

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
    command.add_option("--mill", wanted_.machine, "one of edmill machines; spex8000 unless given");
    command
        .add_option("--balls", wanted_.balls,
                    "number and diameter, \"10x12.7mm\", and a material, \"10x12.7mm:zirconia\"; can be "
                    "repeated; 10 of 10 mm of steel unless given")
        ->take_all()
        ->expected(1);
    command.add_option("--powder", wanted_.powder, "mass of the powder, \"5g\"; none unless given");
    command.add_option("--target-dose", wanted_.target_dose, "target dose of the powder, \"10 kJ/g\"");
    command.add_option("--speed", wanted_.speed, "of the drive; the mill's usual one unless given");
    command.add_option("--restitution", wanted_.restitution,
                       "of all contacts; by powder and balls unless given");
    command.add_option("--friction", wanted_.friction, "of all contacts; 0.4 unless given");
    command.add_option("--time", wanted_.time, "simulated; \"10 s\" unless given");
    command.add_option("--out", file_,
                       "file of the case, written whole or not at all; standard output by default");
  }
  int run() {
    const auto text = machines::new_case(wanted_);
    app::check(casefile::parse_case(text, "the new case"));  // the balls have room
    if (file_.empty())
      io::print("{}", text);
    else
      io::NamedFile(file_).write([&](std::ostream& out) { out << text; });
    return ok;
  }

 private:
  machines::Wanted wanted_;
  std::string file_;
};

}  // namespace edmill::cli
