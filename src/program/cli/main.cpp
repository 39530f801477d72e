// The command line.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "base/standard_arithmetic.hpp"
#include "base/version.hpp"
#include "casefile/case_spec.hpp"
#include "casefile/nearest.hpp"
#include "casefile/quantity.hpp"
#include "cli/commands/cases.hpp"
#include "cli/commands/certainty.hpp"
#include "cli/commands/dem.hpp"
#include "cli/commands/logs.hpp"
#include "cli/commands/run.hpp"
#include "cli/commands/studies.hpp"
#include "cli/commands/texts.hpp"
#include "cli/exit_codes.hpp"
#include "io/input_file.hpp"
#ifdef EDMILL_NODE
#include "node/certificate.hpp"
#endif

namespace {

using namespace edmill;

/// In the order of the help. A command has a name, what it does in a line, `add_options`, and `run`, which
/// gives the exit code. A new one is a file in cli/commands/ and a name here.
using Commands = std::tuple<cli::New, cli::Machines, cli::Run, cli::Demo, cli::Resume, cli::Report,
                            cli::Certify, cli::Prove, cli::Sensitivity, cli::Bifurcation, cli::Check,
                            cli::Variables, cli::Sweep, cli::Optimize, cli::Compare, cli::Audit, cli::Export,
#ifdef EDMILL_NODE
                            cli::Certificate,
#endif
                            cli::Import, cli::Limit, cli::Manual, cli::Reference, cli::Completion>;

std::string version_text() {
  const auto parts = optional_parts();
#ifdef EDMILL_WITHOUT_MPFR
  const auto* wide = "";
#else
  const auto* wide = ", mpfr:DIGITS";
#endif
  return fmt::format("edmill {} ({})\ncompiler {}\nscalars {}{}\noptional parts {}", version(), commit(),
                     compiler(), fmt::join(casefile::precisions(), ", "), wide,
                     parts.empty() ? "none" : parts);
}

/// Synonyms of commands, which are not similar to their names.
constexpr std::pair<const char*, const char*> synonyms[] = {
    {"simulate", "run"},     {"start", "run"},      {"execute", "run"},     {"go", "run"},
    {"solve", "run"},        {"example", "demo"},   {"continue", "resume"}, {"restart", "resume"},
    {"html", "report"},      {"plot", "report"},    {"view", "report"},     {"validate", "check"},
    {"lint", "check"},       {"describe", "check"}, {"draw", "check"},      {"scan", "sweep"},
    {"study", "sweep"},      {"diff", "compare"},   {"identify", "audit"},  {"help", "--help"},
    {"version", "--version"}};

std::string unknown_command(const std::string& word, const std::vector<std::string>& commands) {
  const auto* synonym = std::find_if(std::begin(synonyms), std::end(synonyms),
                                     [&](const auto& known) { return known.first == word; });
  const auto expected = synonym == std::end(synonyms) ? casefile::nearest_of(word, commands)
                                                      : fmt::format("'{}'", synonym->second);
  return fmt::format("{}: unknown command, expected {} (see edmill --help)", word, expected);
}

std::vector<std::string> options_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const auto* option : command.get_options()) {
    for (const auto& name : option->get_lnames()) names.push_back("--" + name);
    for (const auto& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

/// The first word that begins with a hyphen but is none of the options; negative numbers may be values.
std::string unknown_option(const std::vector<std::string>& words, const std::vector<std::string>& options) {
  for (const auto& word : words) {
    if (word == "--") break;
    const auto name = word.substr(0, word.find('='));
    const bool option = name.size() > 1 && name[0] == '-' && name.find_first_of("0123456789") != 1;
    if (option && std::find(options.begin(), options.end(), name) == options.end()) return name;
  }
  return "";
}

/// The problem of a command line that could not be parsed: an unknown command or option with the most similar
/// known one, or else the message of the parser.
std::string problem_of(const CLI::App& app, const std::vector<std::string>& words,
                       const CLI::ParseError& error) {
  std::vector<std::string> commands;
  for (const auto* command : app.get_subcommands({})) commands.push_back(command->get_name());
  const CLI::App* command = &app;
  std::string help = "edmill --help";
  if (!words.empty() && words[0][0] != '-') {
    if (std::find(commands.begin(), commands.end(), words[0]) == commands.end())
      return unknown_command(words[0], commands);
    command = app.get_subcommand(words[0]);
    help = "edmill " + words[0] + " --help";
  }
  const auto options = options_of(*command);
  if (const auto word = unknown_option(words, options); !word.empty())
    return fmt::format("{}: unknown option, expected {} (see {})", word, casefile::nearest_of(word, options),
                       help);
  std::string text = error.what();
  for (const auto& word : words)
    if (casefile::has_comma(word) && text.find(word) != std::string::npos)
      text += ": a decimal point is expected";
  return fmt::format("{} (see {})", text, help);
}

/// Runs the command that the command line names. @return the exit code
int run_command_line(int argc, char** argv) {
  CLI::App app{"edmill: event-driven simulation of ball mills, a validated reference solver"};
  app.set_version_flag("--version", version_text());
  app.require_subcommand(1);
  app.footer("Exit codes: edmill --help");  // of commands
  Commands commands;
  std::vector<std::pair<CLI::App*, std::function<int()>>> added;
  const auto add = [&](auto& command) {
    added.emplace_back(app.add_subcommand(command.name, command.what), [&command] { return command.run(); });
    command.add_options(*added.back().first);
  };
  std::apply([&](auto&... command) { (add(command), ...); }, commands);
  std::string codes = "Exit codes:";
  for (const auto& row : cli::exit_codes) codes += fmt::format("\n  {:<9} {}", row.code, row.meaning);
  app.footer(codes);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help, --version
      std::ostringstream text;
      app.exit(error, text, text);
      io::print("{}", text.str());
      return cli::ok;
    }
    cli::print_problem(problem_of(app, {argv + 1, argv + argc}, error));
    return cli::bad_input;
  }
  for (const auto& [parsed, command] : added)
    if (*parsed) return command();
  return cli::internal_error;
}

}  // namespace

int main(int argc, char** argv) {
  const StandardArithmetic scope;
  const io::Spool pipes;
  return cli::as_program([&] { return run_command_line(argc, argv); });
}
