// Files as they are read, and values that are passed on as they were written.
#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "base/errors.hpp"
#include "casefile/section.hpp"
#include "io/input_file.hpp"

namespace edmill::casefile {

namespace {

/// What is after an error of TOML's grammar in a line, where that is known.
std::string hint_of(const Document& document, std::size_t line) {
  if (line == 0 || line > document.lines.size()) return "";
  const std::string& text = document.lines[line - 1];
  const auto value = text.find_first_not_of(" \t", text.find('=') + 1);
  const bool comma =
      text.find('=') != std::string::npos && value != std::string::npos && has_comma(text.substr(value));
  return comma ? " and a comma in a number, where a decimal point is expected" : "";
}

}  // namespace

std::string kind_of(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "an array";
    case toml::node_type::string:
      return "a text";
    case toml::node_type::integer:
      return "an integer";
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "true or false";
    default:
      return "a date or time";
  }
}

std::string read_file(const std::string& path, const std::string& kind) {
  return io::read_whole(path, kind + " (TOML)");
}

toml::table parse_toml(const std::string& text, const std::string& kind, Document& document) {
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) document.lines.push_back(line);
  if (const std::string mark = "\xEF\xBB\xBF"; text.starts_with(mark))
    document.lines[0].erase(0, mark.size());
  try {
    return toml::parse(text, document.name);
  } catch (const toml::parse_error& error) {
    const auto line = error.source().begin.line;
    throw InputError(document.name + ":" + std::to_string(line) + ": found no valid TOML (" +
                     std::string(error.description()) + ")" + hint_of(document, line) + ", expected " + kind);
  }
}

std::vector<std::string> Section::keys() const {
  std::vector<std::pair<toml::source_position, std::string>> found;
  if (table_)
    for (const auto& [key, node] : *table_) found.emplace_back(key.source().begin, std::string(key.str()));
  std::sort(found.begin(), found.end());
  std::vector<std::string> keys;
  for (auto& [place, key] : found) keys.push_back(std::move(key));
  return keys;
}

std::optional<std::string> Section::setting_of(const toml::node& node, const std::string& path) {
  if (const auto* text = node.as_string(); text && text->get().find_first_of("\n\r") != std::string::npos) {
    document_->report(&node, path, "a text of several lines", "a text in one line");
    return std::nullopt;
  }
  const bool in_one_line = node.source().begin.line == node.source().end.line;
  const auto* array = node.as_array();
  const bool of_tables = array && !array->empty() && array->get(0)->is_table();
  if (node.is_string() || node.is_number() || node.is_boolean() || (array && in_one_line && !of_tables))
    return document_->raw(node, path);
  if (of_tables) return list_of(*array, path);
  document_->report(&node, path, kind_of(node), "a value of this key");
  return std::nullopt;
}

/// An array of tables in one line, "[{count = 2, diameter = "12.7 mm"}]".
std::optional<std::string> Section::list_of(const toml::array& entries, const std::string& path) {
  std::string list;
  for (std::size_t k = 0; k < entries.size(); ++k) {
    const auto* table = entries.get(k)->as_table();
    const std::string place = path + "." + std::to_string(k);
    if (!table) {
      document_->report(entries.get(k), place, kind_of(*entries.get(k)), "a table");
      return std::nullopt;
    }
    std::string row;
    for (const auto& [key, value] : *table) {
      const auto text = setting_of(value, place + "." + std::string(key.str()));
      if (!text) return std::nullopt;
      const bool quoted = value.is_string();
      row +=
          (row.empty() ? "" : ", ") + std::string(key.str()) + " = " + (quoted ? "\"" + *text + "\"" : *text);
    }
    list += (list.empty() ? "{" : ", {") + row + "}";
  }
  return "[" + list + "]";
}

bool Section::flag(const std::string& key) {
  const auto* node = find(key);
  if (!node) return false;
  const auto* value = node->as_boolean();
  if (!value) document_->report(node, full(key), kind_of(*node), "true or false");
  return value && value->get();
}

std::optional<std::string> Section::setting(const std::string& key) {
  const auto* node = find(key);
  return node ? setting_of(*node, full(key)) : std::nullopt;
}

std::vector<std::string> Document::problems_by_line() const {
  const auto line_of = [&](const std::string& problem) {
    if (!problem.starts_with(name + ":")) return 0L;
    return std::strtol(problem.c_str() + name.size() + 1, nullptr, 10);
  };
  auto sorted = problems;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [&](const auto& a, const auto& b) { return line_of(a) < line_of(b); });
  return sorted;
}

std::vector<std::string> Section::settings(const std::string& key, Twice twice) {
  const auto* node = find(key);
  if (!node) return {};
  const auto* array = node->as_array();
  if (!array || array->empty()) {
    const std::string dotted = node->is_table() ? "; write a key with dots in quotes" : "";
    document_->report(node, full(key), array ? "an empty array" : kind_of(*node),
                      "an array of values" + dotted);
    return {};
  }
  std::vector<std::string> values;
  for (std::size_t k = 0; k < array->size(); ++k) {
    const std::string path = full(key) + "." + std::to_string(k);
    const auto value = setting_of(*array->get(k), path);
    if (!value) continue;
    if (twice == Twice::refused && std::find(values.begin(), values.end(), *value) != values.end())
      document_->report(array->get(k), path, "\"" + *value + "\" twice", "each value once");
    values.push_back(*value);
  }
  return values;
}

}  // namespace edmill::casefile
