// The commands that run one case, and the one that makes a page of runs.
#pragma once

#include <filesystem>

#include "base/errors.hpp"
#include "casefile/precisions.hpp"
#include "cli/commands/case_argument.hpp"
#include "cli/exit_codes.hpp"
#include "io/terminal.hpp"
#include "report/embedded.hpp"
#include "report/report_page.hpp"

namespace edmill::cli {

struct RunCommand {
  std::string folder;      ///< of the results; out/<name of the case> when empty
  std::string precision;   ///< scalar of the run; that of the case when empty
  std::string shadow;      ///< a wider scalar to compare with; none when empty
  std::string checkpoint;  ///< how often to save the state; when empty, never, or as before
  std::vector<std::string> overrides;
  bool report = false, quiet = false;
  bool estimate = false;  ///< estimate the cost of the run, and do not run
};

/// @return an exit code
int run_case(casefile::CaseSpec spec, const RunCommand& command);
int run_resume(const RunCommand& command);

/// Adds the settings of --until-precision: the stop rule, and an end time far off unless one is set.
/// @throws InputError when it is no part of 1
void until_precision(const std::string& precision, const casefile::CaseSpec& spec,
                     std::vector<std::string>& settings);

inline const std::string every = "how often to save the run's state, \"10 min\" or \"2 s simulated\"";
inline constexpr const char* quiet_run = "no progress line and no result table";

struct Run {
  static constexpr const char* name = "run";
  static constexpr const char* what = "simulate a case and write its results";

  void add_options(CLI::App& command) {
    given_.add_to(command);
    const CLI::Validator precisions(
        [](std::string& name) {
          return casefile::is_precision(name) ? "" : "expected " + casefile::choices_of_precision();
        },
        "");
    command.add_option("--out", run_.folder, "folder for the results; out/<case name> unless given");
    command.add_option("--precision", run_.precision, "scalar of the run, overrides that of the case")
        ->check(precisions);
    auto* shadow = command
                       .add_option("--shadow", run_.shadow,
                                   "also run in this wider scalar and report when the two diverge")
                       ->check(precisions);
    command
        .add_option("--digits", digits_,
                    "every event and number correct to this many digits: the precision is chosen for it, and "
                    "verified")
        ->check(CLI::Range(1, 100000))
        ->excludes("--precision");
    command.add_flag("--estimate", run_.estimate,
                     "estimate events, digits, time and memory of the run, and do not run");
    command.add_option("--checkpoint", run_.checkpoint, every + "; never unless given")->excludes(shadow);
    command.add_flag("--report", run_.report, "write report.html, and the tables that it shows");
    command.add_flag("--quiet", run_.quiet, quiet_run);
    command.add_option("--until-precision", precision_,
                       "run until the 95 % interval of the dose rate is this part of it, \"1%\" or 0.01: up "
                       "to 100 times the case's end time, or to the run.end_time of --set");
    command.add_option("--target-dose", target_,
                       "target dose of the powder, \"10 kJ/g\": also report the milling time");
  }
  int run() {
    auto spec = given_.read();
    auto& settings = run_.overrides = given_.overrides;
    if (!precision_.empty()) until_precision(precision_, spec, settings);
    if (digits_ > 0) settings.push_back(fmt::format("run.digits={}", digits_));
    if (!target_.empty()) settings.push_back("powder.target_dose=\"" + target_ + "\"");
    if (settings != given_.overrides) spec = casefile::parse_case(spec.text, spec.file, settings);
    return run_case(spec, run_);
  }

 private:
  std::string precision_, target_;
  unsigned digits_ = 0;
  CaseArgument given_;
  RunCommand run_;
};

struct Demo {
  static constexpr const char* name = "demo";
  static constexpr const char* what = "simulate the demo, 28 balls in a SPEX 8000, with its report";

  void add_options(CLI::App& command) {
    command.add_option("--out", run_.folder, "folder for the results; out/demo unless given");
    command.add_flag("--quiet", run_.quiet, quiet_run);
  }
  int run() {
    run_.report = true;
    return run_case(casefile::parse_case(std::string(report::demo_toml), "demo.toml"), run_);
  }

 private:
  RunCommand run_;
};

struct Resume {
  static constexpr const char* name = "resume";
  static constexpr const char* what = "continue an unfinished run from its checkpoint";

  void add_options(CLI::App& command) {
    command.add_option("folder", run_.folder, "folder of the run")->required();
    command.add_option("--checkpoint", run_.checkpoint, every + "; as before unless given");
    command.add_flag("--quiet", run_.quiet, quiet_run);
  }
  int run() { return run_resume(run_); }

 private:
  RunCommand run_;
};

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
