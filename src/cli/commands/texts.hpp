// The commands that print the command line in other forms, made of what it knows itself.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>

#include "base/version.hpp"
#include "cli/exit_codes.hpp"
#include "cli/reference.hpp"
#include "io/terminal.hpp"

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

inline std::string manual_text(const CLI::App& app) { return man_page(app, version()); }

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

struct Manual : Text<manual_text> {
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
