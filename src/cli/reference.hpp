// The reference of the manual, made from the tables that the program itself uses.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>

#include "casefile/keys.hpp"
#include "casefile/output_entry.hpp"
#include "casefile/quantity.hpp"
#include "cli/exit_codes.hpp"

namespace edmill::cli {

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
  for (const auto* command : app.get_subcommands([](const CLI::App*) { return true; })) {
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

inline std::string keys_of(std::string_view section) {
  bool types = false;
  for (const auto& key : casefile::keys()) types = types || (key.section == section && !key.of.empty());
  std::string text = types ? "| key | of | value | default | meaning |\n|---|---|---|---|---|\n"
                           : "| key | value | default | meaning |\n|---|---|---|---|\n";
  for (const auto& key : casefile::keys()) {
    if (key.section != section) continue;
    text += fmt::format("| `{}` | ", key.name);
    if (types) text += fmt::format("{} | ", key.of.empty() ? "all" : key.of);
    text += fmt::format("{} | {} | {} |\n", key.kind, in_cell(key.fallback), in_cell(key.meaning));
  }
  return text + '\n';
}

inline std::string sections() {
  std::string text;
  for (const auto& section : casefile::section_texts())
    text += fmt::format("### `{}`\n\n{}\n\n{}", section.heading, section.meaning, keys_of(section.name));
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

/// docs/reference.md: commands with options, exit codes, keys of files, outputs.
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
         units() + sections();
}

}  // namespace edmill::cli
