// The command that makes a page of a run.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "base/errors.hpp"
#include "cli/exit_codes.hpp"
#include "io/terminal.hpp"
#include "report/report_page.hpp"

namespace edmill::cli {

struct Report {
  static constexpr const char* name = "report";
  static constexpr const char* what = "make the HTML page of a run from its files, or one that compares runs";

  void add_options(CLI::App& command) {
    command.add_option("folder", folders_, "folder of the run; of several runs to compare them")->required();
    command.add_option("--out", file_, "page that compares several runs; comparison.html unless given");
    command.add_flag("--quiet", quiet_, "do not print the path of the page");
  }
  int run() {
    std::filesystem::path page = file_.empty() ? "comparison.html" : file_;
    if (folders_.size() > 1)
      report::write_comparison(folders_, page);
    else if (!file_.empty())
      throw InputError(
          "--out: found one run, whose page is report.html in its folder, expected several runs");
    else
      page = report::write_report(folders_.front());
    if (!quiet_) io::print("The report is {}\n", page.string());
    return ok;
  }

 private:
  std::vector<std::string> folders_;
  std::string file_;
  bool quiet_ = false;
};

}  // namespace edmill::cli
