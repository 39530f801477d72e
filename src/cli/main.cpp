// The command line.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cctype>
#include <filesystem>
#include <functional>
#include <sstream>
#include <utility>
#include <vector>

#include "base/errors.hpp"
#include "base/version.hpp"
#include "casefile/memory_for.hpp"
#include "cli/audit_command.hpp"
#include "cli/certify_command.hpp"
#include "cli/command_texts.hpp"
#include "cli/compare_command.hpp"
#include "cli/list_variables.hpp"
#include "cli/prove_command.hpp"
#include "cli/reference.hpp"
#include "cli/report_command.hpp"
#include "cli/resume_command.hpp"
#include "cli/run_command.hpp"
#include "cli/signals.hpp"
#include "cli/standard_streams.hpp"
#include "cli/study_command.hpp"
#include "cli/suggestions.hpp"
#include "io/file_buffer.hpp"
#include "io/input_file.hpp"
#include "io/terminal.hpp"
#include "report/embedded.hpp"
#include "run/run_folder.hpp"

namespace {

edmill::cli::RunOptions run_options(const std::string& folder, bool quiet) {
  edmill::cli::RunOptions options;
  options.folder = folder;
  options.quiet = quiet;
  options.interrupt = &edmill::cli::interrupt_flag();
  options.listen = edmill::cli::listen_for_signals;
  return options;
}

/// For work that does not report interruptions itself.
template <class Work, class Options>
int interruptible(const Work& work, Options& options) {
  using namespace edmill::cli;
  options.interrupt = &interrupt_flag();
  listen_for_signals();
  return after_signals(work());
}

/// The name of a case, which its outputs take.
std::string name_of(const std::string& case_file) {
  return edmill::io::is_stream(case_file) ? "stdin" : std::filesystem::path(case_file).stem().string();
}

int resume(const std::string& folder, const std::string& checkpoint, bool quiet) {
  using namespace edmill;
  if (!checkpoint.empty()) run::parse_checkpoint_interval(checkpoint);
  return cli::with_signal(cli::run_resume(checkpoint, run_options(folder, quiet)));
}

int run(const std::string& case_file, const std::string& folder, const std::string& precision,
        const std::string& shadow, const std::string& checkpoint, const std::vector<std::string>& overrides,
        bool report, bool quiet) {
  using namespace edmill;
  const auto spec = casefile::read_case(case_file, overrides);
  const auto& scalar = precision.empty() ? spec.precision : precision;
  if (!shadow.empty()) cli::check_shadow(scalar, shadow);
  auto options = run_options(folder.empty() ? "out/" + name_of(case_file) : folder, quiet);
  options.report = report;
  if (!checkpoint.empty()) {
    run::parse_checkpoint_interval(checkpoint);
    options.checkpoint = cli::first_checkpoint(spec, overrides, scalar, report, checkpoint);
  }
  int code = cli::run_and_report(scalar, spec, options);
  if (code == cli::ok && !shadow.empty()) {
    code = cli::run_shadow(spec, scalar, shadow, options.interrupt);
    if (*options.interrupt) code = cli::interrupted;
  }
  return cli::with_signal(code);
}

int certify(const std::string& case_file, const std::vector<std::string>& overrides,
            edmill::cli::CertifyOptions& options) {
  using namespace edmill;
  const auto spec = casefile::read_case(case_file, overrides);
  if (options.file.empty()) options.file = "out/" + name_of(case_file) + ".reference.csv";
  return interruptible(
      [&] { return casefile::with_memory_for(spec, [&] { return cli::run_certify(spec, options); }); },
      options);
}

int prove(const std::string& case_file, const std::vector<std::string>& overrides,
          edmill::cli::ProveOptions& options) {
  using namespace edmill;
  const auto spec = casefile::read_case(case_file, overrides);
  return interruptible(
      [&] { return casefile::with_memory_for(spec, [&] { return cli::run_prove(spec, options); }); },
      options);
}

int audit(const std::string& case_file, const std::vector<std::string>& overrides,
          edmill::cli::AuditOptions& options) {
  using namespace edmill;
  const auto spec = casefile::read_case(case_file, overrides);
  return interruptible(
      [&] { return casefile::with_memory_for(spec, [&] { return cli::run_audit(spec, options); }); },
      options);
}

/// One line per problem; control characters are escaped.
void print_problem(const std::string& problem) {
  std::string line;
  for (const char c : problem)
    line += std::iscntrl(static_cast<unsigned char>(c))
                ? fmt::format("\\x{:02x}", static_cast<unsigned char>(c))
                : std::string(1, c);
  edmill::io::tell("edmill: {}\n", line);
}

std::string version_text() {
  std::string scalars;
  for (const auto& name : edmill::casefile::precisions()) scalars += (scalars.empty() ? "" : ", ") + name;
  return fmt::format("edmill {} ({})\ncompiler {}\nscalars {}", edmill::version(), edmill::commit(),
                     edmill::compiler(), scalars);
}

/// The subcommands, each with its options and what it does.
class CommandLine {
 public:
  CommandLine() {
    app_.set_version_flag("--version", version_text());
    app_.require_subcommand(1);
    std::string codes = "Exit codes:";
    for (const auto& row : edmill::cli::exit_codes)
      codes += fmt::format("\n  {:<9} {}", row.code, row.meaning);
    app_.footer(codes);
    add_run();
    add_demo();
    add_resume();
    add_report();
    add_certify();
    add_prove();
    add_check();
    add_variables();
    add_study("sweep", "run a case at many points and tabulate the results", edmill::cli::run_sweep);
    add_study("optimize", "search for the largest dose rate within bounds", edmill::cli::run_optimize);
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
        edmill::io::print("{}", text.str());
        return edmill::cli::ok;
      }
      print_problem(edmill::cli::problem_of(app_, {argv + 1, argv + argc}, error));
      return edmill::cli::bad_input;
    }
    for (const auto& [command, action] : actions_)
      if (*command) return action();
    return edmill::cli::internal_error;
  }

 private:
  CLI::App* add(const std::string& name, const std::string& what, std::function<int()> action) {
    auto* command = app_.add_subcommand(name, what);
    actions_.emplace_back(command, std::move(action));
    return command;
  }
  void take_case(CLI::App* command) {
    command->add_option("case", case_file_, "case file (TOML)")->required();
    command->add_option("--set", overrides_, "section.key=value, overrides the case file; can be repeated")
        ->take_all()
        ->expected(1);
  }

  void add_run() {
    auto* command = add("run", "simulate a case and write its results", [this] {
      return ::run(case_file_, folder_, precision_, shadow_, checkpoint_, overrides_, report_, quiet_);
    });
    take_case(command);
    const auto precisions = CLI::IsMember(edmill::casefile::precisions());
    command->add_option("--out", folder_, "folder for the results; out/<case name> unless given");
    command->add_option("--precision", precision_, "scalar of the run, overrides that of the case")
        ->check(precisions);
    auto* shadow =
        command
            ->add_option("--shadow", shadow_, "also run in this wider scalar and report when the two diverge")
            ->check(precisions);
    command->add_option("--checkpoint", checkpoint_, every_ + "; never unless given")->excludes(shadow);
    command->add_flag("--report", report_, "write report.html, and the tables that it shows");
    command->add_flag("--quiet", quiet_, "no progress line and no result table");
  }

  void add_demo() {
    auto* command = add("demo", "simulate the demo, 28 balls in a SPEX 8000, with its report", [this] {
      const auto spec = edmill::casefile::parse_case(std::string(edmill::report::demo_toml), "demo.toml");
      auto options = run_options(folder_.empty() ? "out/demo" : folder_, quiet_);
      options.report = true;
      return edmill::cli::with_signal(edmill::cli::run_and_report(spec.precision, spec, options));
    });
    command->add_option("--out", folder_, "folder for the results; out/demo unless given");
    command->add_flag("--quiet", quiet_, "no progress line and no result table");
  }

  void add_resume() {
    auto* command = add("resume", "continue an unfinished run from its checkpoint",
                        [this] { return resume(folder_, checkpoint_, quiet_); });
    command->add_option("folder", folder_, "folder of the run")->required();
    command->add_option("--checkpoint", checkpoint_, every_ + "; as before unless given");
    command->add_flag("--quiet", quiet_, "no progress line and no result table");
  }

  void add_report() {
    auto* command = add("report", "make the HTML page of a run from its files",
                        [this] { return edmill::cli::run_report(folder_, quiet_); });
    command->add_option("folder", folder_, "folder of the run")->required();
    command->add_flag("--quiet", quiet_, "do not print the path of the page");
  }

  void add_certify() {
    auto* command = add("certify", "raise the precision until the first events are certain, and write them",
                        [this] { return certify(case_file_, overrides_, certification_); });
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
                        [this] { return prove(case_file_, overrides_, proof_); });
    take_case(command);
    auto* collisions = command->add_option("--collisions", proof_.collisions, "how many events")
                           ->check(CLI::Range(1, 10000000));
    command
        ->add_option("--check", proof_.checked,
                     "prove nothing, but tell whether the header of this certificate is that of the case")
        ->excludes(collisions);
    command->add_option("--out", proof_.file, "file for the events, each number with its radius (CSV)");
    command->add_option("--certificate", proof_.certificate,
                        "file for a certificate that can be checked without edmill");
    command->add_option("--most-bits", proof_.most_bits, "give up beyond so many; 16384 unless given")
        ->check(CLI::Range(128, 1048576));
    command->add_flag("--compare", proof_.compare, "also tell how many events each precision gets right");
    command->add_flag("--quiet", proof_.quiet, "no progress and no report");
  }

  void add_check() {
    auto* command = add("check", "read and check a case; print it in SI with derived numbers", [this] {
      const auto spec = edmill::casefile::read_case(case_file_, overrides_);
      return edmill::casefile::with_memory_for(spec, [&] {
        edmill::io::print("{}", edmill::cli::describe_case(spec));
        if (!drawing_.empty()) edmill::cli::draw_mill(spec, drawing_);
        return edmill::cli::ok;
      });
    });
    take_case(command);
    command->add_option("--draw", drawing_, "also draw how the vessel moves into this SVG file");
  }

  void add_variables() {
    add("variables", "list the variables that outputs can show, as Markdown tables", [] {
      edmill::io::print("{}", edmill::cli::list_variables());
      return edmill::cli::ok;
    });
  }

  void add_study(const std::string& name, const std::string& what,
                 int (*work)(const edmill::cli::StudyOptions&)) {
    auto* command =
        add(name, what, [this, work] { return interruptible([&] { return work(study_); }, study_); });
    command->add_option("file", study_.file, "sweep or optimisation file (TOML)")->required();
    command->add_option("--out", study_.folder, "folder for the tables; out/<name of the file> unless given");
    command->add_option("--jobs", study_.jobs, "runs at a time in each process; all cores unless given")
        ->check(CLI::Range(1, 4096));
    command->add_flag("--quiet", study_.quiet, "no progress line and no report");
  }

  void add_texts() {
    add("manual", "print the manual page, edmill(1), for man", [this] {
      edmill::io::print("{}", edmill::cli::man_page(app_, edmill::version()));
      return edmill::cli::ok;
    });
    add("reference", "print the reference of commands, exit codes, keys of files and outputs, as Markdown",
        [this] {
          edmill::io::print("{}", edmill::cli::reference(app_));
          return edmill::cli::ok;
        });
    add("completion", "print the completion of these commands for bash", [this] {
      edmill::io::print("{}", edmill::cli::bash_completion(app_));
      return edmill::cli::ok;
    });
  }

  void add_compare() {
    auto* command = add("compare", "compare two collision logs event by event and by statistics",
                        [this] { return edmill::cli::run_compare(compare_); });
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
                        [this] { return audit(case_file_, overrides_, audited_); });
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
  std::string case_file_, folder_, precision_, shadow_, checkpoint_, drawing_;
  std::vector<std::string> overrides_;
  bool quiet_ = false, report_ = false;
  edmill::cli::CertifyOptions certification_;
  edmill::cli::ProveOptions proof_;
  edmill::cli::StudyOptions study_;
  edmill::cli::CompareOptions compare_;
  edmill::cli::AuditOptions audited_;
};

}  // namespace

namespace {

/// @return the exit code
int run_command_line(int argc, char** argv) {
  using namespace edmill;
  try {
    return CommandLine().run(argc, argv);
  } catch (const InputError& error) {
    for (const auto& problem : error.problems()) print_problem(problem);
    return cli::bad_input;
  } catch (const InterruptedError& error) {
    print_problem(error.what());
    return cli::after_signals(cli::interrupted);
  } catch (const UndecidedError& error) {
    print_problem(error.what());
    return cli::undecided;
  } catch (const io::PipeClosed& error) {
    return cli::after_closed_pipe(error.what());
  } catch (const casefile::OutOfMemory& error) {
    print_problem(error.what());
  } catch (const std::bad_alloc&) {
    print_problem("found too little memory, expected more");
  } catch (const std::length_error&) {
    print_problem("found too little memory, expected more");
  } catch (const std::exception& error) {
    print_problem(error.what());
  }
  return cli::internal_error;
}

}  // namespace

int main(int argc, char** argv) {
  edmill::cli::open_standard_descriptors();
  edmill::cli::ignore_write_signals();
  const edmill::io::Spool pipes;
  return edmill::cli::after_output(run_command_line(argc, argv));
}
