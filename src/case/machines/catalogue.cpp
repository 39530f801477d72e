#include <fmt/format.h>

#define TOML_ENABLE_FORMATTERS 0
#include <toml++/toml.h>

#include "machines/machines.hpp"

namespace edmill::machines {

extern const std::string_view machines_toml;  ///< the file of this folder

namespace {

std::string text_of(const toml::table& table, std::string_view key) {
  return table[key].value_or(std::string());
}

/// Entries of an array of tables.
void each(const toml::table& root, std::string_view key, const auto& f) {
  if (const auto* entries = root[key].as_array())
    for (const auto& entry : *entries) f(*entry.as_table());
}

Catalogue read() {
  const auto root = toml::parse(machines_toml);
  const auto source_of = [&](const toml::table& table) {
    return root["source"][text_of(table, "source")].value_or(std::string());
  };
  Catalogue all;
  each(root, "machine", [&](const toml::table& m) {
    Machine machine{text_of(m, "key"),
                    text_of(m, "name"),
                    m["speeds"][0].value_or(std::string()),
                    m["speeds"][1].value_or(std::string()),
                    {}};
    each(m, "setting", [&](const toml::table& s) {
      machine.settings.push_back({text_of(s, "key"), text_of(s, "value"), source_of(s), text_of(s, "note")});
    });
    all.machines.push_back(std::move(machine));
  });
  each(root, "material", [&](const toml::table& m) {
    all.materials.push_back({text_of(m, "key"), text_of(m, "density"), source_of(m)});
  });
  each(root, "contact", [&](const toml::table& c) {
    all.contacts.push_back({text_of(c, "key"), text_of(c, "what"), text_of(c, "model"),
                            text_of(c, "restitution"), source_of(c)});
  });
  const auto& friction = *root["friction"].as_table();
  all.friction = text_of(friction, "value");
  all.friction_source = source_of(friction);
  return all;
}

/// "mill.type = "spex8000"" as a cell.
std::string code(const std::string& text) { return "`" + text + "`"; }

}  // namespace

const Catalogue& catalogue() {
  static const Catalogue all = read();
  return all;
}

std::string table() {
  std::string out;
  for (const auto& m : catalogue().machines) {
    out += fmt::format("{:<16}{}, {} to {}\n", m.key, m.name, m.slowest, m.fastest);
    std::string before;
    for (const auto& s : m.settings) {
      out += fmt::format("  {:<18}{:<26}{}\n", s.key, s.value, s.source == before ? "\"" : s.source);
      if (!s.note.empty()) out += fmt::format("  {:<18}  {}\n", "", s.note);
      before = s.source;
    }
  }
  return out;
}

std::string markdown() {
  const auto& all = catalogue();
  std::string out =
      "# Machines\n\nWritten by `edmill machines --markdown`. Mills that [edmill new](usage.md) knows, with "
      "the source of each number. Data sheets round, and a mill wears: measure your own machine where the "
      "result matters.\n";
  for (const auto& m : all.machines) {
    out += fmt::format("\n## {}\n\n`--mill {}`, {} to {}.\n\n| key | value | source |\n|---|---|---|\n",
                       m.name, m.key, m.slowest, m.fastest);
    for (const auto& s : m.settings)
      out += fmt::format("| {} | {}{} | {} |\n", code(s.key), code(s.value),
                         s.note.empty() ? "" : ", " + s.note, s.source);
  }
  out +=
      "\n## Balls\n\n`--balls 10x12.7mm:zirconia`; steel unless a material is given.\n\n| material | density "
      "| source |\n|---|---|---|\n";
  for (const auto& m : all.materials)
    out += fmt::format("| {} | {} | {} |\n", code(m.key), m.density, m.source);
  out +=
      "\n## Contacts\n\nWhat a case has unless `--restitution` and `--friction` say otherwise. The powder "
      "decides the restitution more than the balls do; the [tutorial](tutorial.md) shows what a change of "
      "either does to the result.\n\n| charge | restitution | source |\n|---|---|---|\n";
  for (const auto& c : all.contacts)
    out += fmt::format("| {} | {} | {} |\n", c.what,
                       c.model.empty() ? c.restitution : "model " + code(c.model), c.source);
  return out + fmt::format("| all | friction {} | {} |\n", all.friction, all.friction_source);
}

}  // namespace edmill::machines
