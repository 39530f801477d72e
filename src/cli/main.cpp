// The command line.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cctype>
#include <filesystem>

#include "base/errors.hpp"
#include "base/version.hpp"
#include "cli/audit_command.hpp"
#include "cli/certify_command.hpp"
#include "cli/compare_command.hpp"
#include "cli/list_variables.hpp"
#include "cli/report_command.hpp"
#include "cli/resume_command.hpp"
#include "cli/run_command.hpp"
#include "cli/run_folder.hpp"
#include "cli/signals.hpp"
#include "cli/study_command.hpp"

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

int resume(const std::string& folder, const std::string& checkpoint, bool quiet) {
  using namespace edmill;
  if (!checkpoint.empty()) cli::parse_checkpoint_interval(checkpoint);
  return cli::with_signal(cli::run_resume(checkpoint, run_options(folder, quiet)));
}

int run(const std::string& case_file, const std::string& folder, const std::string& precision,
        const std::string& shadow, const std::string& checkpoint, const std::vector<std::string>& overrides,
        bool report, bool quiet) {
  using namespace edmill;
  const auto spec = casefile::read_case(case_file, overrides);
  const auto& scalar = precision.empty() ? spec.precision : precision;
  if (!shadow.empty()) cli::check_shadow(scalar, shadow);
  auto options =
      run_options(folder.empty() ? "out/" + std::filesystem::path(case_file).stem().string() : folder, quiet);
  options.report = report;
  if (!checkpoint.empty()) {
    cli::parse_checkpoint_interval(checkpoint);
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
  if (options.file.empty())
    options.file = "out/" + std::filesystem::path(case_file).stem().string() + ".reference.csv";
  return interruptible([&] { return cli::run_certify(spec, options); }, options);
}

int audit(const std::string& case_file, const std::vector<std::string>& overrides,
          edmill::cli::AuditOptions& options) {
  using namespace edmill;
  const auto spec = casefile::read_case(case_file, overrides);
  return interruptible([&] { return cli::run_audit(spec, options); }, options);
}

/// One line per problem; control characters are escaped.
void print_problem(const std::string& problem) {
  std::string line;
  for (const char c : problem)
    line += std::iscntrl(static_cast<unsigned char>(c))
                ? fmt::format("\\x{:02x}", static_cast<unsigned char>(c))
                : std::string(1, c);
  fmt::print(stderr, "edmill: {}\n", line);
}

std::string version_text() {
  std::string scalars;
  for (const auto& name : edmill::casefile::precisions()) scalars += (scalars.empty() ? "" : ", ") + name;
  return fmt::format("edmill {} ({})\ncompiler {}\nscalars {}", edmill::version(), edmill::commit(),
                     edmill::compiler(), scalars);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"edmill: event-driven simulation of ball mills, a validated reference solver"};
  app.set_version_flag("--version", version_text());
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done, 2 bad input, 3 ended in inelastic collapse, 4 a decision that no scalar could "
      "make,\n"
      "5 some runs of a sweep failed, 6 the compared outputs differ or the audited log has violations, 7 too "
      "few data to decide,\n"
      "130 and 143 interrupted by SIGINT and SIGTERM with the results so far on disk, 1 any other error.");
  std::string case_file, folder, precision, shadow, checkpoint;
  std::vector<std::string> overrides;
  bool quiet = false, report = false;

  auto* run_command = app.add_subcommand("run", "simulate a case and write its results");
  run_command->add_option("case", case_file, "case file (TOML)")->required();
  run_command->add_option("--out", folder, "folder for the results; out/<case name> unless given");
  run_command->add_option("--precision", precision, "scalar of the run, overrides that of the case")
      ->check(CLI::IsMember(edmill::casefile::precisions()));
  run_command->add_option("--set", overrides, "section.key=value, overrides the case file; can be repeated")
      ->take_all()
      ->expected(1);
  run_command->add_flag("--quiet", quiet, "no progress line and no result table");

  auto* shadow_option =
      run_command
          ->add_option("--shadow", shadow, "also run in this wider scalar and report when the two diverge")
          ->check(CLI::IsMember(edmill::casefile::precisions()));
  const std::string every = "how often to save the run's state, \"10 min\" or \"2 s simulated\"";
  run_command->add_option("--checkpoint", checkpoint, every + "; never unless given")
      ->excludes(shadow_option);

  auto* resume_command = app.add_subcommand("resume", "continue an unfinished run from its checkpoint");
  resume_command->add_option("folder", folder, "folder of the run")->required();
  resume_command->add_option("--checkpoint", checkpoint, every + "; as before unless given");
  resume_command->add_flag("--quiet", quiet, "no progress line and no result table");

  run_command->add_flag("--report", report, "write report.html, and the tables that it shows");

  auto* report_command = app.add_subcommand("report", "make the HTML page of a run from its files");
  report_command->add_option("folder", folder, "folder of the run")->required();
  report_command->add_flag("--quiet", quiet, "do not print the path of the page");

  edmill::cli::CertifyOptions certification;
  auto* certify_command =
      app.add_subcommand("certify", "raise the precision until the first events are certain, and write them");
  certify_command->add_option("case", case_file, "case file (TOML)")->required();
  certify_command->add_option("--collisions", certification.collisions, "how many events")
      ->required()
      ->check(CLI::Range(1, 10000000));
  certify_command->add_option("--digits", certification.digits, "to how many digits; 25 unless given")
      ->check(CLI::Range(1, 90));
  certify_command->add_option("--out", certification.file,
                              "file; out/<case name>.reference.csv unless given");
  certify_command
      ->add_option("--set", overrides, "section.key=value, overrides the case file; can be repeated")
      ->take_all()
      ->expected(1);
  certify_command->add_flag("--quiet", certification.quiet, "no progress and no report");

  auto* check_command =
      app.add_subcommand("check", "read and check a case; print it in SI with derived numbers");
  check_command->add_option("case", case_file, "case file (TOML)")->required();
  check_command->add_option("--set", overrides, "section.key=value, overrides the case file; can be repeated")
      ->take_all()
      ->expected(1);

  auto* variables_command =
      app.add_subcommand("variables", "list the variables that outputs can show, as Markdown tables");

  edmill::cli::StudyOptions study;
  const auto add_study = [&](const std::string& name, const std::string& what) {
    auto* command = app.add_subcommand(name, what);
    command->add_option("file", study.file, "sweep or optimisation file (TOML)")->required();
    command->add_option("--out", study.folder, "folder for the tables; out/<name of the file> unless given");
    command->add_option("--jobs", study.jobs, "runs at a time in each process; all cores unless given")
        ->check(CLI::Range(1, 4096));
    command->add_flag("--quiet", study.quiet, "no progress line and no report");
    return command;
  };
  auto* sweep_command = add_study("sweep", "run a case at many points and tabulate the results");
  auto* optimize_command = add_study("optimize", "search for the largest dose rate within bounds");

  edmill::cli::CompareOptions compare;
  auto* compare_command =
      app.add_subcommand("compare", "compare two collision logs event by event and by statistics");
  compare_command->add_option("A", compare.a, "reference: folder of a run, or a collision log (CSV)")
      ->required();
  compare_command->add_option("B", compare.b, "the other")->required();
  compare_command
      ->add_option("--tolerance", compare.tolerance, "relative, for single events; 1e-9 unless given")
      ->check(CLI::Range(0.0, 1.0));
  compare_command->add_option("--events", compare.events, "number of events that must agree one by one");
  compare_command->add_option("--from", compare.limits.from, "time in s to begin at");
  compare_command->add_option("--until", compare.limits.until, "time in s to end at");
  compare_command->add_option("--batch", compare.batch, "length of a batch in s; a twentieth unless given")
      ->check(CLI::PositiveNumber);
  compare_command->add_option("--json", compare.json, "file for the result in JSON");
  compare_command->add_flag("--quiet", compare.quiet, "no table");

  edmill::cli::AuditOptions audited;
  auto* audit_command =
      app.add_subcommand("audit", "check another code's collision log against the physics of a case");
  audit_command->add_option("case", case_file, "case file (TOML)")->required();
  audit_command->add_option("log", audited.log, "collision log (CSV), or folder of a run")->required();
  audit_command
      ->add_option("--column", audited.columns, "ours=theirs [unit]: name of a column; can be repeated")
      ->take_all()
      ->expected(1);
  audit_command
      ->add_option("--first-ball", audited.first_ball, "number of the log's first ball; 0 unless given")
      ->check(CLI::Range(0, 1000000000));
  audit_command->add_option("--walls", audited.walls,
                            "numbers of the caps at -y and +y and the cylinder, e.g. \"1, 2, 3\"");
  audit_command->add_option("--tolerance", audited.tolerance, "relative; 1e-9 unless given")
      ->check(CLI::Range(1e-15, 0.5));
  audit_command
      ->add_option("--gap-tolerance", audited.gap_tolerance,
                   "largest gap or overlap of bodies in contact, in m")
      ->check(CLI::PositiveNumber);
  audit_command->add_flag("--from-start", audited.from_start, "the log begins at the case's initial state");
  audit_command->add_option("--examples", audited.examples, "of each kind of violation; 3 unless given")
      ->check(CLI::Range(0, 1000));
  audit_command->add_option("--json", audited.json, "file for the result in JSON");
  audit_command->add_option("--set", overrides, "section.key=value, overrides the case file; can be repeated")
      ->take_all()
      ->expected(1);
  audit_command->add_flag("--quiet", audited.quiet, "no progress line and no table");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    print_problem(std::string(error.what()) + " (see edmill --help)");
    return edmill::cli::bad_input;
  }
  try {
    if (*run_command) return run(case_file, folder, precision, shadow, checkpoint, overrides, report, quiet);
    if (*resume_command) return resume(folder, checkpoint, quiet);
    if (*report_command) return edmill::cli::run_report(folder, quiet);
    if (*certify_command) return certify(case_file, overrides, certification);
    if (*sweep_command) return interruptible([&] { return edmill::cli::run_sweep(study); }, study);
    if (*optimize_command) return interruptible([&] { return edmill::cli::run_optimize(study); }, study);
    if (*audit_command) return audit(case_file, overrides, audited);
    if (*compare_command) return edmill::cli::run_compare(compare);
    if (*variables_command) {
      fmt::print("{}", edmill::cli::list_variables());
      return edmill::cli::ok;
    }
    fmt::print("{}", edmill::cli::describe_case(edmill::casefile::read_case(case_file, overrides)));
    return edmill::cli::ok;
  } catch (const edmill::InputError& error) {
    for (const auto& problem : error.problems()) print_problem(problem);
    return edmill::cli::bad_input;
  } catch (const edmill::InterruptedError& error) {
    print_problem(error.what());
    return edmill::cli::after_signals(edmill::cli::interrupted);
  } catch (const edmill::UndecidedError& error) {
    print_problem(error.what());
    return edmill::cli::undecided;
  } catch (const std::exception& error) {
    print_problem(error.what());
    return edmill::cli::internal_error;
  }
}
