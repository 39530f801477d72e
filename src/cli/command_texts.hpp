// The command line in other forms, made of what it knows itself: a man page and the completion of bash.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>

#include "cli/exit_codes.hpp"

namespace edmill::cli {

/// Text for troff: backslashes, hyphens and leading dots mean something there.
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
inline std::string man_page(const CLI::App& app, const std::string& version) {
  std::string page = fmt::format(
      ".TH EDMILL 1 \"\" \"edmill {}\" \"User Commands\"\n.SH NAME\nedmill \\- {}\n", in_roff(version),
      in_roff(app.get_description().substr(app.get_description().find(": ") + 2)));
  page += ".SH SYNOPSIS\n.B edmill\n.I command\n[\n.I options\n]\n.SH COMMANDS\n";
  for (const auto* command : app.get_subcommands([](const CLI::App*) { return true; })) {
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

/// For bash: source it, or install it as share/bash-completion/completions/edmill.
inline std::string bash_completion(const CLI::App& app) {
  std::string commands, cases;
  for (const auto* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    commands += command->get_name() + " ";
    std::string options;
    for (const auto* option : command->get_options())
      for (const auto& name : option->get_lnames()) options += "--" + name + " ";
    cases += fmt::format("    {}) words=\"{}\" ;;\n", command->get_name(), options);
  }
  return fmt::format(R"(# Completion of edmill for bash; made by `edmill completion`.
_edmill() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} words
  case ${{COMP_WORDS[1]}} in
{}    *) words="{}--help --version" ;;
  esac
  if [ "$COMP_CWORD" = 1 ]; then words="{}--help --version"; fi
  COMPREPLY=($(compgen -W "$words" -- "$word"))
  if [ "$COMP_CWORD" -gt 1 ] && [[ $word != -* ]]; then COMPREPLY=($(compgen -f -- "$word")); fi
}}
complete -o filenames -F _edmill edmill
)",
                     cases, commands, commands);
}

}  // namespace edmill::cli
