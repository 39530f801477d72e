// The command line.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <functional>
#include <sstream>
#include <tuple>
#include <utility>
#include <vector>

#include "base/standard_arithmetic.hpp"
#include "base/version.hpp"
#include "casefile/precisions.hpp"
#include "cli/commands/bifurcation.hpp"
#include "cli/commands/certainty.hpp"
#include "cli/commands/check.hpp"
#include "cli/commands/dem.hpp"
#include "cli/commands/logs.hpp"
#include "cli/commands/machines.hpp"
#include "cli/commands/run.hpp"
#include "cli/commands/studies.hpp"
#include "cli/commands/texts.hpp"
#include "cli/failures.hpp"
#include "cli/suggestions.hpp"
#include "io/input_file.hpp"

namespace {

using namespace edmill;

/// In the order of the help. A command has a name, what it does in a line, `add_options`, and `run`, which
/// gives the exit code. A new one is a file in cli/commands/ and a line here.
using Commands = std::tuple<cli::New,          //
                            cli::Machines,     //
                            cli::Run,          //
                            cli::Demo,         //
                            cli::Resume,       //
                            cli::Report,       //
                            cli::Certify,      //
                            cli::Prove,        //
                            cli::Sensitivity,  //
                            cli::Bifurcation,  //
                            cli::Check,        //
                            cli::Variables,    //
                            cli::Sweep,        //
                            cli::Optimize,     //
                            cli::Compare,      //
                            cli::Audit,        //
                            cli::Export,       //
                            cli::Import,       //
                            cli::Limit,        //
                            cli::Manual,       //
                            cli::Reference,    //
                            cli::Completion>;

std::string version_text() {
  std::string scalars;
  for (const auto& name : casefile::precisions()) scalars += (scalars.empty() ? "" : ", ") + name;
  scalars += ", mpfr:DIGITS";
  const auto parts = optional_parts();
  return fmt::format("edmill {} ({})\ncompiler {}\nscalars {}\noptional parts {}", version(), commit(),
                     compiler(), scalars, parts.empty() ? "none" : parts);
}

class CommandLine {
 public:
  CommandLine() {
    app_.set_version_flag("--version", version_text());
    app_.require_subcommand(1);
    std::string codes = "Exit codes:";
    for (const auto& row : cli::exit_codes) codes += fmt::format("\n  {:<9} {}", row.code, row.meaning);
    app_.footer(codes);
    std::apply([this](auto&... command) { (add(command), ...); }, commands_);
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
    for (const auto& [parsed, run] : added_)
      if (*parsed) return run();
    return cli::internal_error;
  }

 private:
  void add(auto& command) {
    auto* added = app_.add_subcommand(command.name, command.what);
    command.add_options(*added);
    added_.emplace_back(added, [&] { return command.run(); });
  }

  CLI::App app_{"edmill: event-driven simulation of ball mills, a validated reference solver"};
  Commands commands_;
  std::vector<std::pair<CLI::App*, std::function<int()>>> added_;
};

}  // namespace

int main(int argc, char** argv) {
  const StandardArithmetic scope;
  cli::throw_for_lack_of_memory();
  cli::open_standard_descriptors();
  cli::begin_with_signals();
  const io::Spool pipes;
  return cli::after_output(cli::exit_code_of([&] { return CommandLine().run(argc, argv); }));
}
