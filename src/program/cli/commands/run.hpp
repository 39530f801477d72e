// The commands that run one case, and the one that makes a page of runs.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "app/certify.hpp"
#include "app/run.hpp"
#include "app/study.hpp"
#include "base/clean_text.hpp"
#include "base/errors.hpp"
#include "casefile/case_spec.hpp"
#include "casefile/quantity.hpp"
#include "cli/commands/case_argument.hpp"
#include "cli/exit_codes.hpp"
#include "io/progress_line.hpp"
#include "io/terminal.hpp"
#include "report/embedded.hpp"
#include "report/report_page.hpp"
#include "run/run_folder.hpp"

namespace edmill::cli {

/// Reserves the folder of a run before its number of digits is searched, so that errors of the
/// folder come first. Removes folders that it has made and that are still empty.
class ReservedFolder {
 public:
  ReservedFolder(const std::string& folder, bool saves, const casefile::CaseSpec& spec) {
    std::error_code error;
    for (auto place = std::filesystem::absolute(folder); !std::filesystem::exists(place, error);
         place = place.parent_path())
      made_.push_back(place);
    folder_.emplace(folder, spec, saves ? std::optional(io::Checkpoint()) : std::nullopt);
  }
  ~ReservedFolder() {
    folder_.reset();
    std::error_code error;
    for (const auto& place : made_) std::filesystem::remove(place, error);
  }
  ReservedFolder(const ReservedFolder&) = delete;
  ReservedFolder& operator=(const ReservedFolder&) = delete;
 private:
  std::vector<std::filesystem::path> made_;  ///< the innermost first
  std::optional<run::RunFolder> folder_;
};

/// A run with the options of the command line. Its functions return exit codes.
class RunCommand {
 protected:
  int run_case(casefile::CaseSpec spec) {
    if (folder_.empty()) folder_ = "out/" + name_of(spec.file);
    const bool by_digits = spec.digits && precision_.empty();
    auto scalar = precision_.empty() ? spec.precision : precision_;
    if (estimate_) return print_estimate(spec, by_digits ? "" : scalar);
    if (by_digits && !shadow_.empty())
      throw InputError(
          "--shadow cannot be combined with --digits or run.digits: such a run is already checked "
          "against a wider one");
    if (!shadow_.empty()) app::require_wider(scalar, shadow_, "option '--shadow'");
    auto options = options_of_run();
    if (by_digits) {
      const ReservedFolder reserved(folder_, !checkpoint_.empty(), spec);
      if (const int code = choose_digits(spec, scalar); code != ok) return code;
    }
    if (!checkpoint_.empty())
      options.checkpoint = app::first_checkpoint(spec, scalar, report_, checkpoint_);
    const int code = with_progress(options, [&] { return app::run(scalar, spec, options); });
    if (code != ok || shadow_.empty()) return code;
    const auto result = app::shadow(spec, scalar, shadow_, options.interrupt);
    io::print("{}", result.text());
    return plus_signal(result.interrupted ? interrupted : ok);
  }

  std::string folder_;      ///< of the results; out/<name of the case> when empty
  std::string precision_;   ///< scalar of the run; that of the case when empty
  std::string shadow_;      ///< a wider scalar to compare with; none when empty
  std::string checkpoint_;  ///< how often to save the state; when empty, never, or as before
  bool report_ = false, quiet_ = false, check_ = false;
  double uncertainty_ = 0.1;  ///< of restitution and friction
  bool estimate_ = false;     ///< estimate the cost of the run, and do not run

  app::RunOptions options_of_run() const {
    if (!checkpoint_.empty()) run::parse_checkpoint_interval(checkpoint_);
    app::RunOptions options;
    options.folder = folder_;
    options.report = report_;
    options.check = check_;
    options.what_decides = [this](const casefile::CaseSpec& spec, const io::Facts& run) {
      return app::what_decides(spec, run.text("precision"), run, uncertainty_, &interrupt_flag());
    };
    options.interrupt = &interrupt_flag();
    options.begun = listen_for_signals;
    options.without_locks = [](const std::filesystem::path& place) {
      io::tell(
          "edmill: {}: this file system has no locks: make sure that no other process writes to "
          "the folder\n",
          place.string());
    };
    return options;
  }

  /// Does `work` with a progress line on a terminal, and prints the results.
  int with_progress(app::RunOptions& options, const auto& work) const {
    io::ProgressLine line(quiet_);
    if (line)
      options.progress = [&](const run::Progress& p) {
        line.show(p.now, p.end, p.collisions, p.milling_dose);
      };
    const app::RunResult result = work();
    line.clear();
    if (!quiet_) {
      io::print("{}\nResults are in {}\n", result.table, folder_);
      if (result.goes_on) io::print("Continue with: edmill resume {}\n", folder_);
    }
    if (!result.error.empty()) io::tell("edmill: {}\n", result.error);
    if (!result.report.empty() && !quiet_) io::print("The report is {}\n", result.report);
    return plus_signal(code_of(result.end_reason));
  }
 private:
  /// Does trial runs, which write nothing, with a progress line. @return the result of `work`
  auto after_trials(const casefile::CaseSpec& spec, const auto& work) const {
    app::DigitsOptions options;
    options.interrupt = &interrupt_flag();
    listen_for_signals();
    io::ProgressLine line(quiet_);
    options.progress = [&](const std::string& scalar, std::size_t events, double expected) {
      line.show(fmt::format("{}: {} of about {:.0f} events ", scalar, events, expected));
    };
    return casefile::with_memory_for(spec, [&] { return work(options); });
  }

  /// Prints the cost of the run. @param scalar  empty where the case asks for digits
  int print_estimate(const casefile::CaseSpec& spec, const std::string& scalar) const {
    const auto found = after_trials(
        spec, [&](const auto& options) { return app::estimate_run(spec, scalar, options); });
    if (found.interrupted) return after_signals(interrupted);
    io::print("{}", found.text());
    return after_signals(scalar.empty() && !found.undecided.empty() ? undecided : ok);
  }

  /// Finds the scalar of a case that asks for digits, and prints the evidence.
  int choose_digits(casefile::CaseSpec& spec, std::string& scalar) const {
    const auto found =
        after_trials(spec, [&](const auto& options) { return app::find_digits(spec, options); });
    if (found.interrupted) {
      io::tell("edmill: interrupted before the digits were found; nothing is written\n");
      return after_signals(interrupted);
    }
    if (!found.undecided.empty()) return tell_undecided(found.undecided);
    if (!quiet_) io::print("{}", found.text());
    scalar = found.precision;
    spec.right_digits = found.right();
    return ok;
  }
};

/// Prints the outcome of a study. @return `ok` also after an interrupt: the caller adds the signal
inline int end_of_study(const std::optional<app::StudyResult>& result, bool quiet) {
  if (!result) return ok;
  if (!result->estimate.empty()) {
    io::print("{}\n", result->estimate);
    return ok;
  }
  const auto& c = result->counts;
  if (!quiet)
    io::print("{}{}: {} reused, {} run now, {} failed{}\nTables and their page are in {}\n",
        result->optimum, counted(c.total, "run"), c.kept, c.ran, c.failed,
        result->interrupted ? ", interrupted" : "", result->folder);
  return c.failed > 0 ? some_runs_failed : ok;
}

inline const std::string every =
    "how often to save the run's state, \"10 min\" or \"2 s simulated\"";
inline constexpr const char* quiet_run = "print no progress line and no result table";

struct Run : RunCommand {
  static constexpr const char* name = "run";
  static constexpr const char* what = "simulate a case and write its results";

  void add_options(CLI::App& command) {
    given_.add_to(command);
    const CLI::Validator precisions(
        [](std::string& name) {
          return casefile::is_precision(name) ? "" : "expected " + casefile::choices_of_precision();
        },
        "");
    command.add_option("--out", folder_, "folder for the results (default: out/<case name>)");
    add_checked(command, "--precision", precision_, precisions,
        "scalar of the run, one that edmill --version lists (default: that of the case)");
    add_checked(command, "--shadow", shadow_, precisions,
        "also run in this wider scalar and report when the two runs diverge");
    add_checked(command, "--digits", digits_, CLI::Range(1, 100000),
        "number of correct digits in every event and number; edmill chooses the precision and "
        "verifies it")
        ->excludes("--precision");
    command.add_flag("--estimate", estimate_,
        "estimate events, digits, time and memory of the run without running it");
    auto* check = command.add_flag("--check", check_,
        "also find out what the dose rate depends on, by six more runs with another seed, half of "
        "the least separation speed, and other restitution and friction (default with --report if "
        "the run has fewer than a million impacts)");
    command.add_option("--checkpoint", checkpoint_, every + " (default: never)")
        ->excludes("--shadow");
    command.add_flag("--report", report_, "also write report.html and the tables that it shows");
    check->excludes("--checkpoint");
    add_checked(command, "--uncertainty", uncertainty_, CLI::Range(0.001, 1.0),
        "uncertainty of restitution and friction for --check (default: 0.1)");
    auto* seeds = add_checked(command, "--seeds", seeds_, CLI::Range(2, 100000),
        "number of runs on all cores, with the seed of the case and the following ones: reports "
        "their common result and the steady states in which they settle");
    seeds->excludes("--shadow", "--checkpoint", "--report", "--check", "--digits");
    command.add_flag("--quiet", quiet_, quiet_run);
    command.add_option("--until-precision", until_precision_,
        "run until the 95 % interval of the dose rate is this fraction of the rate, \"1%\" or "
        "0.01, for up to 100 times the end time of the case, or to a run.end_time given with "
        "--set");
    command.add_option("--target-dose", target_,
        "target dose of the powder, \"10 kJ/g\": also report the milling time");
  }
  int run() {
    auto spec = given_.read();
    auto settings = given_.overrides;
    if (!until_precision_.empty()) run_until_precision(spec, settings);
    if (digits_ > 0) settings.push_back(fmt::format("run.digits={}", digits_));
    if (!target_.empty()) settings.push_back("powder.target_dose=\"" + target_ + "\"");
    if (settings != given_.overrides) spec = casefile::parse_case(spec.text, spec.file, settings);
    return seeds_ > 0 ? run_seeds(settings) : run_case(spec);
  }
 private:
  /// Adds the settings of --until-precision: the stop rule, and a distant end time if none is set.
  void run_until_precision(
      const casefile::CaseSpec& spec, std::vector<std::string>& settings) const {
    const double part = part_of_one("--until-precision", until_precision_);
    settings.push_back(fmt::format("run.dose_rate_precision={}", part));
    const bool limited = std::any_of(settings.begin(), settings.end(),
        [](const auto& s) { return s.starts_with("run.end_time="); });
    if (!limited && spec.end_time)
      settings.push_back(fmt::format("run.end_time=\"{} s\"", 100 * spec.end_time->to<double>()));
  }

  int run_seeds(const std::vector<std::string>& settings) {
    const auto folder = folder_.empty() ? "out/" + name_of(given_.file) : folder_;
    app::SeedsOptions options{
        {.file = given_.file, .folder = folder, .quiet = quiet_, .estimate = estimate_}, settings,
        precision_, seeds_};
    return interruptible(options, [&] { return end_of_study(app::seeds(options), quiet_); });
  }

  std::string until_precision_, target_;
  unsigned digits_ = 0;
  std::uint64_t seeds_ = 0;
  CaseArgument given_;
};

struct Demo : RunCommand {
  static constexpr const char* name = "demo";
  static constexpr const char* what =
      "simulate an example, 28 balls in a SPEX 8000, and write its report";

  void add_options(CLI::App& command) {
    command.add_option("--out", folder_, "folder for the results (default: out/demo)");
    command.add_flag("--quiet", quiet_, quiet_run);
  }
  int run() {
    report_ = true;
    return run_case(casefile::parse_case(std::string(report::demo_toml), "demo.toml"));
  }
};

struct Resume : RunCommand {
  static constexpr const char* name = "resume";
  static constexpr const char* what = "continue an unfinished run from its checkpoint";

  void add_options(CLI::App& command) {
    add_required(command, "folder", folder_, "folder of the run");
    command.add_option("--checkpoint", checkpoint_, every + " (default: as before)");
    command.add_flag("--quiet", quiet_, quiet_run);
  }
  int run() {
    auto options = options_of_run();
    return with_progress(options, [&] { return app::resume(checkpoint_, options); });
  }
};

struct Report {
  static constexpr const char* name = "report";
  static constexpr const char* what =
      "make the HTML page of a run from its files, or a page that compares several runs";

  void add_options(CLI::App& command) {
    add_required(
        command, "folder", folders_, "folder of a run, or folders of several runs to compare");
    command.add_option(
        "--out", file_, "file for the page that compares several runs (default: comparison.html)");
    command.add_flag("--quiet", quiet_, "do not print the path of the page");
  }
  int run() {
    std::filesystem::path page = file_.empty() ? "comparison.html" : file_;
    if (folders_.size() > 1)
      report::write_comparison(folders_, page);
    else if (!file_.empty())
      throw InputError(
          "--out needs several runs to compare: the page of one run is report.html in its folder");
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
