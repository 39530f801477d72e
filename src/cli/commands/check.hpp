// The commands that tell what a case says and what outputs can show.
#pragma once

#include "app/check_case.hpp"
#include "cli/commands/case_argument.hpp"
#include "cli/exit_codes.hpp"
#include "cli/list_variables.hpp"
#include "io/terminal.hpp"

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
