// The command line, and the texts that are generated from it.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <sstream>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "app/judge.hpp"
#include "base/standard_arithmetic.hpp"
#include "base/version.hpp"
#include "casefile/case_spec.hpp"
#include "casefile/keys.hpp"
#include "casefile/nearest.hpp"
#include "casefile/output_entry.hpp"
#include "casefile/quantity.hpp"
#include "cli/commands/cases.hpp"
#include "cli/commands/logs.hpp"
#include "cli/commands/run.hpp"
#include "cli/commands/studies.hpp"
#include "io/input_file.hpp"
#include "io/summary.hpp"
#include "io/terminal.hpp"
#include "machines/machines.hpp"
#ifdef EDMILL_NODE
#include "check.hpp"  // of verification/checker
#endif

namespace edmill::cli {

namespace {

/// Escapes text for troff, where backslashes, hyphens and leading dots have a meaning.
std::string in_roff(const std::string& text) {
  std::string out;
  bool at_line_begin = true;
  for (const char c : text) {
    if (at_line_begin && (c == '.' || c == '\'')) out += "\\&";
    out += c == '\\' ? "\\e" : c == '-' ? "\\-" : std::string(1, c);
    at_line_begin = c == '\n';
  }
  return out;
}

/// edmill(1): the commands, each with its options.
std::string man_page(const CLI::App& app) {
  std::string page =
      fmt::format(".TH EDMILL 1 \"\" \"edmill {}\" \"User Commands\"\n.SH NAME\nedmill \\- {}\n",
          in_roff(version()),
          in_roff(app.get_description().substr(app.get_description().find(": ") + 2)));
  page += ".SH SYNOPSIS\n.B edmill\n.I command\n[\n.I options\n]\n.SH COMMANDS\n";
  for (const auto* command : app.get_subcommands({})) {
    std::string usage;
    for (const auto* option : command->get_options())
      if (option->get_positional()) usage += " \\fI" + in_roff(option->get_name()) + "\\fR";
    page += fmt::format(".SS \"edmill {}{}\"\n{}\n", in_roff(command->get_name()), usage,
        in_roff(command->get_description()));
    for (const auto* option : command->get_options())
      page += fmt::format(".TP\n\\fB{}\\fR\n{}\n", in_roff(option->get_name(true, true)),
          in_roff(option->get_description()));
  }
  page += ".SH EXIT STATUS\n";
  for (const auto& row : exit_codes)
    page += fmt::format(".TP\n\\fB{}\\fR\n{}\n", row.code, in_roff(std::string(row.meaning)));
  return page;
}

/// To source in bash, or for share/bash-completion/completions/edmill; in zsh after bashcompinit.
std::string bash_completion(const CLI::App& app) {
  std::string commands, cases;
  for (const auto* command : app.get_subcommands({})) {
    commands += command->get_name() + " ";
    std::string options;
    for (const auto* option : command->get_options())
      for (const auto& name : option->get_lnames()) options += "--" + name + " ";
    cases += fmt::format("    {}) words=\"{}\" ;;\n", command->get_name(), options);
  }
  const auto keys_of = [](const auto& list) {
    std::string keys;
    for (const auto& one : list) keys += one.key + " ";
    return keys;
  };
  return fmt::format(
      R"(# Completion of edmill for bash, and for zsh after "autoload -U +X bashcompinit && bashcompinit"; made by
# `edmill completion`.
_edmill() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} words
  if [ "$word" = : ]; then before=: word=; fi
  case ${{COMP_WORDS[1]}} in
{}    *) words="{}--help --version" ;;
  esac
  if [ "$COMP_CWORD" = 1 ]; then words="{}--help --version"; fi
  COMPREPLY=($(compgen -W "$words" -- "$word"))
  if [ "$COMP_CWORD" -gt 1 ] && [[ $word != -* ]]; then COMPREPLY=($(compgen -f -- "$word")); fi
  case $before in
    --mill) COMPREPLY=($(compgen -W "{}" -- "$word")) ;;
    :) COMPREPLY=($(compgen -W "{}" -- "$word")) ;;
    --precision | --shadow) COMPREPLY=($(compgen -W "{}" -- "$word")) ;;
  esac
}}
complete -o filenames -F _edmill edmill
)",
      cases, commands, commands, keys_of(machines::catalogue().machines),
      keys_of(machines::catalogue().materials), fmt::join(casefile::precisions(), " "));
}

/// Text in a cell of a table, where a bar would end it.
std::string in_cell(std::string_view text) {
  std::string out;
  for (const char c : text) out += c == '|' ? "\\|" : c == '\n' ? " " : std::string(1, c);
  return out;
}

std::string commands(const CLI::App& app) {
  std::string text;
  for (const auto* command : app.get_subcommands({})) {
    auto usage = command->get_name();
    for (const auto* option : command->get_options())
      if (option->get_positional()) usage += " " + option->get_name();
    text += fmt::format("### {}\n\n`edmill {}`: {}.\n\n| argument | meaning |\n|---|---|\n",
        command->get_name(), usage, command->get_description());
    for (const auto* option : command->get_options())
      if (option != command->get_help_ptr())
        text += fmt::format("| `{}` | {} |\n", in_cell(option->get_name(true, true)),
            in_cell(option->get_description()));
    text += '\n';
  }
  return text;
}

std::string codes() {
  std::string text = "| exit code | meaning |\n|---|---|\n";
  for (const auto& row : exit_codes) text += fmt::format("| {} | {} |\n", row.code, row.meaning);
  return text + '\n';
}

std::string keys_of(const casefile::KeySection& section) {
  const bool types = std::any_of(
      section.keys.begin(), section.keys.end(), [](const auto& key) { return !key.of.empty(); });
  std::string text = types ? "| key | of | value | default | meaning |\n|---|---|---|---|---|\n"
                           : "| key | value | default | meaning |\n|---|---|---|---|\n";
  for (const auto& key : section.keys) {
    text += fmt::format("| `{}` | ", key.name);
    if (types) text += fmt::format("{} | ", key.of.empty() ? "all" : key.of);
    text += fmt::format("{} | {} | {} |\n", key.kind, in_cell(key.fallback), in_cell(key.meaning));
  }
  return text + '\n';
}

std::string sections() {
  std::string text;
  for (const auto& section : casefile::key_sections())
    text += fmt::format("### `{}`\n\n{}\n\n{}", section.heading, section.meaning, keys_of(section));
  return text;
}

/// A row for each dimension; units apart by semicolons, further spellings of one in brackets.
std::string units() {
  std::string text = "| quantity | units |\n|---|---|", last;
  for (const auto& unit : casefile::unit_texts()) {
    text += unit.dimension == last
        ? "; "
        : fmt::format("{}\n| {} | ", last.empty() ? "" : " |", unit.dimension);
    last = unit.dimension;
    const auto& names = unit.spellings;
    text += fmt::format("`{}`", names[0]);
    if (names.size() > 1)
      text += fmt::format(" ({})", fmt::join(names.begin() + 1, names.end(), ", "));
  }
  return text + " |\n\n";
}

std::string outputs() {
  std::string text = "| type | file | content |\n|---|---|---|\n";
  for (const auto& type : casefile::output_types())
    text += fmt::format(
        "| `{}` | `{}{}` | {} |\n", type.name, type.name, type.extension, in_cell(type.what));
  return text + '\n';
}

/// docs/reference.md: commands, exit codes, outputs, keys of files, of summary.json and documents.
std::string reference(const CLI::App& app) {
  return "# Reference\n\nPrinted by `edmill reference` from the tables with which the program "
         "reads command lines and files. Variables have a page\nof their own: "
         "[variables.md](variables.md).\n\n## Commands\n\n" +
      commands(app) + "## Exit codes\n\n" + codes() + "## Types of outputs\n\n" + outputs() +
      "## Keys of files\n\nCase files, sweep files and optimisation files are TOML. A quantity is "
      "a text with a unit, `\"38 mm\"`; a number without\nunit may be plain. Components of vectors "
      "without a unit are SI. Decimals are exact in every scalar, and have a point. Powers can be "
      "written `m/s2`, `m/s^2` or `m/s\u00b2`.\n\n### Units\n\n" +
      units() + sections() +
      "## Keys of summary.json\n\nThe result of a run; docs/files.md says how to read it.\n\n" +
      io::summary_reference() +
      "\n## Keys of documents\n\nContents of the file that `--json FILE` names, in SI; values that "
      "do not exist are null, and `*` is any name or number.\n\n" +
      app::document_keys();
}

/// @tparam text  of the whole command line
template <std::string (*text)(const CLI::App&)> struct Text {
  void add_options(CLI::App& command) { program_ = command.get_parent(); }
  int run() {
    io::print("{}", text(*program_));
    return ok;
  }
 private:
  const CLI::App* program_ = nullptr;
};

struct Manual : Text<man_page> {
  static constexpr const char* name = "manual";
  static constexpr const char* what = "print the manual page, edmill(1), for man";
};
struct Reference : Text<reference> {
  static constexpr const char* name = "reference";
  static constexpr const char* what =
      "print the reference of commands, exit codes, keys of files and outputs, as Markdown";
};
struct Completion : Text<bash_completion> {
  static constexpr const char* name = "completion";
  static constexpr const char* what = "print the completion of these commands for bash";
};

#ifdef EDMILL_NODE
/// By the checker that has no code of edmill.
struct Certificate {
  static constexpr const char* name = "certificate";
  static constexpr const char* what =
      "check a certificate of proven events, without trusting edmill";

  void add_options(CLI::App& command) {
    command.add_option("file", file_, "certificate (JSON lines)")->required();
    command.add_flag("--quiet", quiet_, "print nothing");
  }
  int run() {
    io::InputFile in(file_, "a certificate");
    try {
      const auto verdict = checker::check(in);
      if (!quiet_) io::print("{}\n", verdict);
      return ok;
    } catch (const checker::Rejected& why) {
      if (!quiet_) io::print("rejected: {}\n", why.what());
      return outputs_differ;
    } catch (const InputError&) {
      throw;
    } catch (const std::exception&) {
      throw InputError(file_ + ": this file is not a certificate of `edmill prove --certificate`");
    }
  }
 private:
  std::string file_;
  bool quiet_ = false;
};
#endif

/// In the order of the help. A command has a name, what it does in a line, `add_options`, and
/// `run`, which gives the exit code. A new one is a file in cli/commands/ and a name here.
using Commands = std::tuple<New, Machines, Run, Demo, Resume, Report, Certify, Prove, Sensitivity,
    Bifurcation, Check, Variables, Sweep, Optimize, Compare, Audit, Export,
#ifdef EDMILL_NODE
    Certificate,
#endif
    Import, Limit, Manual, Reference, Completion>;

std::string version_text() {
  const auto parts = optional_parts();
#ifdef EDMILL_WITHOUT_MPFR
  const auto* wide = "";
#else
  const auto* wide = ", mpfr:DIGITS";
#endif
  return fmt::format("edmill {} ({})\ncompiler {}\nscalars {}{}\noptional parts {}", version(),
      commit(), compiler(), fmt::join(casefile::precisions(), ", "), wide,
      parts.empty() ? "none" : parts);
}

/// Synonyms of commands, which are not similar to their names.
constexpr std::pair<const char*, const char*> synonyms[] = {{"simulate", "run"}, {"start", "run"},
    {"execute", "run"}, {"go", "run"}, {"solve", "run"}, {"example", "demo"},
    {"continue", "resume"}, {"restart", "resume"}, {"html", "report"}, {"plot", "report"},
    {"view", "report"}, {"validate", "check"}, {"lint", "check"}, {"describe", "check"},
    {"draw", "check"}, {"scan", "sweep"}, {"study", "sweep"}, {"diff", "compare"},
    {"identify", "audit"}, {"help", "--help"}, {"version", "--version"}};

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

/// The first word with a hyphen that is none of the options; negative numbers may be values.
std::string unknown_option(
    const std::vector<std::string>& words, const std::vector<std::string>& options) {
  for (const auto& word : words) {
    if (word == "--") break;
    const auto name = word.substr(0, word.find('='));
    const bool option = name.size() > 1 && name[0] == '-' && name.find_first_of("0123456789") != 1;
    if (option && std::find(options.begin(), options.end(), name) == options.end()) return name;
  }
  return "";
}

/// The problem of a command line that could not be parsed: an unknown command or option with the
/// most similar known one, or else the message of the parser.
std::string problem_of(
    const CLI::App& app, const std::vector<std::string>& words, const CLI::ParseError& error) {
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
    return fmt::format("{}: unknown option, expected {} (see {})", word,
        casefile::nearest_of(word, options), help);
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
    added.emplace_back(
        app.add_subcommand(command.name, command.what), [&command] { return command.run(); });
    command.add_options(*added.back().first);
  };
  std::apply([&](auto&... command) { (add(command), ...); }, commands);
  std::string codes = "Exit codes:";
  for (const auto& row : exit_codes) codes += fmt::format("\n  {:<9} {}", row.code, row.meaning);
  app.footer(codes);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help, --version
      std::ostringstream text;
      app.exit(error, text, text);
      io::print("{}", text.str());
      return ok;
    }
    print_problem(problem_of(app, {argv + 1, argv + argc}, error));
    return bad_input;
  }
  for (const auto& [parsed, command] : added)
    if (*parsed) return command();
  return internal_error;
}

}  // namespace

}  // namespace edmill::cli

int main(int argc, char** argv) {
  const edmill::StandardArithmetic scope;
  const edmill::io::Spool pipes;
  return edmill::cli::as_program([&] { return edmill::cli::run_command_line(argc, argv); });
}
