// The command that makes a page of a run.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "cli/exit_codes.hpp"
#include "io/terminal.hpp"
#include "report/report_page.hpp"

namespace edmill::cli {

struct Report {
  static constexpr const char* name = "report";
  static constexpr const char* what = "make the HTML page of a run from its files";

  void add_options(CLI::App& command) {
    command.add_option("folder", folder_, "folder of the run")->required();
    command.add_flag("--quiet", quiet_, "do not print the path of the page");
  }
  int run() {
    const auto page = report::write_report(folder_);
    if (!quiet_) io::print("The report is {}\n", page.string());
    return ok;
  }

 private:
  std::string folder_;
  bool quiet_ = false;
};

}  // namespace edmill::cli
