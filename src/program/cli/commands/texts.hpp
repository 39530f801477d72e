// The commands that print the manual page, the reference and the completion, generated from the command line.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>
#include <string_view>

#include "app/judge.hpp"
#include "base/version.hpp"
#include "casefile/case_spec.hpp"
#include "casefile/keys.hpp"
#include "casefile/output_entry.hpp"
#include "casefile/quantity.hpp"
#include "cli/exit_codes.hpp"
#include "io/summary.hpp"
#include "io/terminal.hpp"
#include "machines/machines.hpp"

namespace edmill::cli {

/// Escapes text for troff, where backslashes, hyphens and leading dots have a meaning.
inline std::string in_roff(const std::string& text) {
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
inline std::string man_page(const CLI::App& app) {
  std::string page = fmt::format(
      ".TH EDMILL 1 \"\" \"edmill {}\" \"User Commands\"\n.SH NAME\nedmill \\- {}\n", in_roff(version()),
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

/// For bash: source it, or install it as share/bash-completion/completions/edmill. For zsh after
/// bashcompinit.
inline std::string bash_completion(const CLI::App& app) {
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

namespace detail {

/// Text in a cell of a table, where a bar would end it.
inline std::string in_cell(std::string_view text) {
  std::string out;
  for (const char c : text) out += c == '|' ? "\\|" : c == '\n' ? " " : std::string(1, c);
  return out;
}

inline std::string usage_of(const CLI::App& command) {
  std::string usage = "edmill " + command.get_name();
  for (const auto* option : command.get_options())
    if (option->get_positional()) usage += fmt::format(" {}", option->get_name());
  return usage;
}

inline std::string commands(const CLI::App& app) {
  std::string text;
  for (const auto* command : app.get_subcommands({})) {
    text += fmt::format("### {}\n\n`{}`: {}.\n\n| argument | meaning |\n|---|---|\n", command->get_name(),
                        usage_of(*command), command->get_description());
    for (const auto* option : command->get_options())
      if (option != command->get_help_ptr())
        text += fmt::format("| `{}` | {} |\n", in_cell(option->get_name(true, true)),
                            in_cell(option->get_description()));
    text += '\n';
  }
  return text;
}

inline std::string codes() {
  std::string text = "| exit code | meaning |\n|---|---|\n";
  for (const auto& row : exit_codes) text += fmt::format("| {} | {} |\n", row.code, row.meaning);
  return text + '\n';
}

inline std::string keys_of(const casefile::KeySection& section) {
  const bool types =
      std::any_of(section.keys.begin(), section.keys.end(), [](const auto& key) { return !key.of.empty(); });
  std::string text = types ? "| key | of | value | default | meaning |\n|---|---|---|---|---|\n"
                           : "| key | value | default | meaning |\n|---|---|---|---|\n";
  for (const auto& key : section.keys) {
    text += fmt::format("| `{}` | ", key.name);
    if (types) text += fmt::format("{} | ", key.of.empty() ? "all" : key.of);
    text += fmt::format("{} | {} | {} |\n", key.kind, in_cell(key.fallback), in_cell(key.meaning));
  }
  return text + '\n';
}

inline std::string sections() {
  std::string text;
  for (const auto& section : casefile::key_sections())
    text += fmt::format("### `{}`\n\n{}\n\n{}", section.heading, section.meaning, keys_of(section));
  return text;
}

/// A row for each dimension; units apart by semicolons, further spellings of one in brackets.
inline std::string units() {
  std::string text = "| quantity | units |\n|---|---|", last;
  for (const auto& unit : casefile::unit_texts()) {
    text +=
        unit.dimension == last ? "; " : fmt::format("{}\n| {} | ", last.empty() ? "" : " |", unit.dimension);
    last = unit.dimension;
    const auto& names = unit.spellings;
    text += fmt::format("`{}`", names[0]);
    if (names.size() > 1) text += fmt::format(" ({})", fmt::join(names.begin() + 1, names.end(), ", "));
  }
  return text + " |\n\n";
}

inline std::string outputs() {
  std::string text = "| type | file | content |\n|---|---|---|\n";
  for (const auto& type : casefile::output_types())
    text += fmt::format("| `{}` | `{}{}` | {} |\n", type.name, type.name, type.extension, in_cell(type.what));
  return text + '\n';
}

}  // namespace detail

/// docs/reference.md: commands with options, exit codes, keys of files, outputs, keys of
/// summary.json and of documents.
inline std::string reference(const CLI::App& app) {
  using namespace detail;
  return "# Reference\n\nPrinted by `edmill reference` from the tables with which the program reads command "
         "lines and files. Variables have a page\nof their own: [variables.md](variables.md).\n\n## "
         "Commands\n\n" +
         commands(app) + "## Exit codes\n\n" + codes() + "## Types of outputs\n\n" + outputs() +
         "## Keys of files\n\nCase files, sweep files and optimisation files are TOML. A quantity is a text "
         "with a unit, `\"38 mm\"`; a number without\nunit may be plain. Components of vectors without a "
         "unit are SI. Decimals are exact in every scalar, and have a point. Powers can be written `m/s2`, "
         "`m/s^2` or `m/s\u00b2`.\n\n"
         "### Units\n\n" +
         units() + sections() +
         "## Keys of summary.json\n\nThe result of a run; docs/files.md says how to read it.\n\n" +
         io::summary_reference() +
         "\n## Keys of documents\n\nContents of the file that `--json FILE` names, in SI; values that do not "
         "exist are null, and "
         "`*` is any name or number.\n\n" +
         app::document_keys();
}

/// @tparam text  of the whole command line
template <std::string (*text)(const CLI::App&)>
struct Text {
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

}  // namespace edmill::cli
