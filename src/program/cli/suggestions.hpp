// What mistyped commands and options were meant to be.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "casefile/nearest.hpp"
#include "casefile/quantity.hpp"

namespace edmill::cli {

namespace detail {

/// Words for a command that are not near to its name.
inline constexpr std::pair<const char*, const char*> synonyms[] = {
    {"simulate", "run"},     {"start", "run"},      {"execute", "run"},     {"go", "run"},
    {"solve", "run"},        {"example", "demo"},   {"continue", "resume"}, {"restart", "resume"},
    {"html", "report"},      {"plot", "report"},    {"view", "report"},     {"validate", "check"},
    {"lint", "check"},       {"describe", "check"}, {"draw", "check"},      {"scan", "sweep"},
    {"study", "sweep"},      {"diff", "compare"},   {"identify", "audit"},  {"help", "--help"},
    {"version", "--version"}};

inline std::vector<std::string> commands_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const auto* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

inline std::vector<std::string> options_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const auto* option : command.get_options()) {
    for (const auto& name : option->get_lnames()) names.push_back("--" + name);
    for (const auto& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

inline std::string unknown_command(const std::string& word, const std::vector<std::string>& commands) {
  const auto* synonym = std::find_if(std::begin(synonyms), std::end(synonyms),
                                     [&](const auto& known) { return word == known.first; });
  const auto expected = synonym == std::end(synonyms) ? casefile::nearest_of(word, commands)
                                                      : fmt::format("'{}'", synonym->second);
  return fmt::format("{}: found an unknown command, expected {} (see edmill --help)", word, expected);
}

/// The first word that begins with a hyphen and is none of these; numbers may be values.
inline std::string unknown_option(const std::vector<std::string>& words,
                                  const std::vector<std::string>& options) {
  for (const auto& word : words) {
    if (word == "--") break;
    const auto name = word.substr(0, word.find('='));
    const bool option = name.size() > 1 && name[0] == '-' && name.find_first_of("0123456789") != 1;
    if (option && std::find(options.begin(), options.end(), name) == options.end()) return name;
  }
  return "";
}

}  // namespace detail

/// What is wrong with the words of a command line that could not be read: an unknown command or option with
/// the nearest that there is, else what the parser says.
inline std::string problem_of(const CLI::App& app, const std::vector<std::string>& words,
                              const CLI::ParseError& error) {
  using namespace detail;
  const auto commands = commands_of(app);
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
    return fmt::format("{}: found an unknown option, expected {} (see {})", word,
                       casefile::nearest_of(word, options), help);
  std::string text = error.what();
  for (const auto& word : words)
    if (casefile::has_comma(word) && text.find(word) != std::string::npos)
      text += ": a decimal point is expected";
  return fmt::format("{} (see {})", text, help);
}

}  // namespace edmill::cli
