// The command line.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <functional>
#include <sstream>
#include <utility>
#include <vector>

#include "app/check_case.hpp"
#include "base/version.hpp"
#include "casefile/memory_for.hpp"
#include "cli/audit_command.hpp"
#include "cli/command_texts.hpp"
#include "cli/exit_codes.hpp"
#include "cli/failures.hpp"
#include "cli/list_variables.hpp"
#include "cli/precision_commands.hpp"
#include "cli/reference.hpp"
#include "cli/run_command.hpp"
#include "cli/signals.hpp"
#include "cli/standard_streams.hpp"
#include "cli/study_command.hpp"
#include "cli/suggestions.hpp"
#include "io/input_file.hpp"
#include "io/terminal.hpp"
#include "report/embedded.hpp"
#include "report/report_page.hpp"

namespace {

using namespace edmill;

/// For work that does not report interruptions itself.
template <class Options, class Work>
int interruptible(Options& options, const Work& work) {
  options.interrupt = &cli::interrupt_flag();
  cli::listen_for_signals();
  return cli::after_signals(work());
}
template <class Options, class Command>
int interruptible(const casefile::CaseSpec& spec, Options& options, const Command& command) {
  return interruptible(
      options, [&] { return casefile::with_memory_for(spec, [&] { return command(spec, options); }); });
}

std::string version_text() {
  std::string scalars;
  for (const auto& name : casefile::precisions()) scalars += (scalars.empty() ? "" : ", ") + name;
  return fmt::format("edmill {} ({})\ncompiler {}\nscalars {}", version(), commit(), compiler(), scalars);
}

/// The subcommands, each with its options and what it does.
class CommandLine {
 public:
  CommandLine() {
    app_.set_version_flag("--version", version_text());
    app_.require_subcommand(1);
    std::string codes = "Exit codes:";
    for (const auto& row : cli::exit_codes) codes += fmt::format("\n  {:<9} {}", row.code, row.meaning);
    app_.footer(codes);
    add_run();
    add_demo();
    add_resume();
    add_report();
    add_certify();
    add_prove();
    add_check();
    add_variables();
    add_study("sweep", "run a case at many points and tabulate the results", cli::run_sweep);
    add_study("optimize", "search for the largest dose rate within bounds", cli::run_optimize);
    add_compare();
    add_audit();
    add_texts();
  }

  /// @return the exit code
  int run(int argc, char** argv) {
    try {
      app_.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      if (error.get_exit_code() == 0) {  // --help, --version
        std::ostringstream text;
        app_.exit(error, text, text);
        io::print("{}", text.str());
        return cli::ok;
      }
      cli::print_problem(cli::problem_of(app_, {argv + 1, argv + argc}, error));
      return cli::bad_input;
    }
    for (const auto& [command, action] : actions_)
      if (*command) return action();
    return cli::internal_error;
  }

 private:
  CLI::App* add(const std::string& name, const std::string& what, std::function<int()> action) {
    auto* command = app_.add_subcommand(name, what);
    actions_.emplace_back(command, std::move(action));
    return command;
  }
  casefile::CaseSpec read_case() const { return casefile::read_case(case_file_, overrides_); }
  void take_case(CLI::App* command) {
    command->add_option("case", case_file_, "case file (TOML)")->required();
    command->add_option("--set", overrides_, "section.key=value, overrides the case file; can be repeated")
        ->take_all()
        ->expected(1);
  }

  void add_run() {
    auto* command = add("run", "simulate a case and write its results", [this] {
      run_.overrides = overrides_;
      return cli::run_case(read_case(), run_);
    });
    take_case(command);
    const auto precisions = CLI::IsMember(casefile::precisions());
    command->add_option("--out", run_.folder, "folder for the results; out/<case name> unless given");
    command->add_option("--precision", run_.precision, "scalar of the run, overrides that of the case")
        ->check(precisions);
    auto* shadow = command
                       ->add_option("--shadow", run_.shadow,
                                    "also run in this wider scalar and report when the two diverge")
                       ->check(precisions);
    command->add_option("--checkpoint", run_.checkpoint, every_ + "; never unless given")->excludes(shadow);
    command->add_flag("--report", run_.report, "write report.html, and the tables that it shows");
    command->add_flag("--quiet", run_.quiet, "no progress line and no result table");
  }

  void add_demo() {
    auto* command = add("demo", "simulate the demo, 28 balls in a SPEX 8000, with its report", [this] {
      const auto spec = casefile::parse_case(std::string(report::demo_toml), "demo.toml");
      run_.report = true;
      return cli::run_case(spec, run_);
    });
    command->add_option("--out", run_.folder, "folder for the results; out/demo unless given");
    command->add_flag("--quiet", run_.quiet, "no progress line and no result table");
  }

  void add_resume() {
    auto* command = add("resume", "continue an unfinished run from its checkpoint",
                        [this] { return cli::run_resume(run_); });
    command->add_option("folder", run_.folder, "folder of the run")->required();
    command->add_option("--checkpoint", run_.checkpoint, every_ + "; as before unless given");
    command->add_flag("--quiet", run_.quiet, "no progress line and no result table");
  }

  void add_report() {
    auto* command = add("report", "make the HTML page of a run from its files", [this] {
      const auto page = report::write_report(run_.folder);
      if (!run_.quiet) io::print("The report is {}\n", page.string());
      return cli::ok;
    });
    command->add_option("folder", run_.folder, "folder of the run")->required();
    command->add_flag("--quiet", run_.quiet, "do not print the path of the page");
  }

  void add_certify() {
    auto* command =
        add("certify", "raise the precision until the first events are certain, and write them", [this] {
          const auto spec = read_case();
          if (certification_.file.empty())
            certification_.file = "out/" + cli::name_of(case_file_) + ".reference.csv";
          return interruptible(spec, certification_, cli::run_certify);
        });
    take_case(command);
    command->add_option("--collisions", certification_.collisions, "how many events")
        ->required()
        ->check(CLI::Range(1, 10000000));
    command->add_option("--digits", certification_.digits, "to how many digits; 25 unless given")
        ->check(CLI::Range(1, 90));
    command->add_option("--out", certification_.file, "file; out/<case name>.reference.csv unless given");
    command->add_flag("--quiet", certification_.quiet, "no progress and no report");
  }

  void add_prove() {
    auto* command = add("prove", "prove the first events of a case in ball arithmetic",
                        [this] { return interruptible(read_case(), proof_, cli::run_prove); });
    take_case(command);
    auto* check = command->add_option(
        "--check", proof_.checked,
        "prove nothing, but tell whether the header of this certificate is that of the case");
    command->add_option("--collisions", proof_.collisions, "how many events")
        ->check(CLI::Range(1, 10000000))
        ->excludes(check);
    command->add_option("--out", proof_.file, "file for the events, each number with its radius (CSV)")
        ->excludes(check);
    command
        ->add_option("--certificate", proof_.certificate,
                     "file for a certificate that can be checked without edmill")
        ->excludes(check);
    command->add_option("--most-bits", proof_.most_bits, "give up beyond so many; 16384 unless given")
        ->check(CLI::Range(128, 1048576))
        ->excludes(check);
    command->add_flag("--compare", proof_.compare, "also tell how many events each precision gets right")
        ->excludes(check);
    command->add_flag("--quiet", proof_.quiet, "no progress and no report");
  }

  void add_check() {
    auto* command = add("check", "read and check a case; print it in SI with derived numbers", [this] {
      const auto spec = read_case();
      io::print("{}", app::check(spec).text());
      if (!drawing_.empty()) app::draw_mill(spec, drawing_);
      return cli::ok;
    });
    take_case(command);
    command->add_option("--draw", drawing_, "also draw how the vessel moves into this SVG file");
  }

  void add_variables() {
    add("variables", "list the variables that outputs can show, as Markdown tables", [] {
      io::print("{}", cli::list_variables());
      return cli::ok;
    });
  }

  void add_study(const std::string& name, const std::string& what, int (*work)(const app::StudyOptions&)) {
    auto* command =
        add(name, what, [this, work] { return interruptible(study_, [&] { return work(study_); }); });
    command->add_option("file", study_.file, "sweep or optimisation file (TOML)")->required();
    command->add_option("--out", study_.folder, "folder for the tables; out/<name of the file> unless given");
    command->add_option("--jobs", study_.jobs, "runs at a time in each process; all cores unless given")
        ->check(CLI::Range(1, 4096));
    command->add_flag("--quiet", study_.quiet, "no progress line and no report");
  }

  void add_texts() {
    add("manual", "print the manual page, edmill(1), for man", [this] {
      io::print("{}", cli::man_page(app_, version()));
      return cli::ok;
    });
    add("reference", "print the reference of commands, exit codes, keys of files and outputs, as Markdown",
        [this] {
          io::print("{}", cli::reference(app_));
          return cli::ok;
        });
    add("completion", "print the completion of these commands for bash", [this] {
      io::print("{}", cli::bash_completion(app_));
      return cli::ok;
    });
  }

  void add_compare() {
    auto* command = add("compare", "compare two collision logs event by event and by statistics",
                        [this] { return cli::run_compare(compare_); });
    command->add_option("A", compare_.a, "reference: folder of a run, or a collision log (CSV)")->required();
    command->add_option("B", compare_.b, "the other")->required();
    command->add_option("--tolerance", compare_.tolerance, "relative, for single events; 1e-9 unless given")
        ->check(CLI::Range(0.0, 1.0));
    command->add_option("--events", compare_.events, "number of events that must agree one by one");
    command->add_option("--from", compare_.limits.from, "time in s to begin at");
    command->add_option("--until", compare_.limits.until, "time in s to end at");
    command->add_option("--batch", compare_.batch, "length of a batch in s; a twentieth unless given")
        ->check(CLI::PositiveNumber);
    command->add_option("--json", compare_.json, "file for the result in JSON");
    command->add_flag("--quiet", compare_.quiet, "no table");
  }

  void add_audit() {
    auto* command = add("audit", "check another code's collision log against the physics of a case",
                        [this] { return interruptible(read_case(), audited_, cli::run_audit); });
    take_case(command);
    command->add_option("log", audited_.log, "collision log (CSV), or folder of a run")->required();
    command->add_option("--column", audited_.columns, "ours=theirs [unit]: name of a column; can be repeated")
        ->take_all()
        ->expected(1);
    command->add_option("--first-ball", audited_.first_ball, "number of the log's first ball; 0 unless given")
        ->check(CLI::Range(0, 1000000000));
    command->add_option(
        "--walls", audited_.walls,
        "numbers of the walls by id, e.g. \"1, 2, 3\" for the caps at -y and +y and the cylinder");
    command->add_option("--tolerance", audited_.tolerance, "relative; 1e-9 unless given")
        ->check(CLI::Range(1e-15, 0.5));
    command
        ->add_option("--gap-tolerance", audited_.gap_tolerance,
                     "largest gap or overlap of bodies in contact, in m")
        ->check(CLI::PositiveNumber);
    command->add_flag("--from-start", audited_.from_start, "the log begins at the case's initial state");
    command->add_flag("--identify", audited_.identify,
                      "search for the value or mistake that explains the violations");
    command->add_option("--examples", audited_.examples, "of each kind of violation; 3 unless given")
        ->check(CLI::Range(0, 1000));
    command->add_option("--json", audited_.json, "file for the result in JSON");
    command->add_flag("--quiet", audited_.quiet, "no progress line and no table");
  }

  const std::string every_ = "how often to save the run's state, \"10 min\" or \"2 s simulated\"";
  CLI::App app_{"edmill: event-driven simulation of ball mills, a validated reference solver"};
  std::vector<std::pair<CLI::App*, std::function<int()>>> actions_;
  std::string case_file_, drawing_;
  std::vector<std::string> overrides_;
  cli::RunCommand run_;
  cli::CertifyOptions certification_;
  cli::ProveOptions proof_;
  app::StudyOptions study_;
  cli::CompareOptions compare_;
  cli::AuditOptions audited_;
};

}  // namespace

int main(int argc, char** argv) {
  cli::open_standard_descriptors();
  cli::ignore_write_signals();
  const io::Spool pipes;
  return cli::after_output(cli::exit_code_of([&] { return CommandLine().run(argc, argv); }));
}
