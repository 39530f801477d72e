// Files as they are read, settings over them, "section.key=value", and values passed on as written.
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

/// The place of "3" in an array; none where there is no such entry.
std::optional<std::size_t> entry_of(const toml::array& array, const std::string& index) {
  if (index.empty() || index.size() > 6 || index.find_first_not_of("0123456789") != std::string::npos)
    return std::nullopt;
  const std::size_t place = std::stoul(index);
  return place < array.size() ? std::optional(place) : std::nullopt;
}

/// The value of a setting: TOML, or else a text.
void put(toml::node& parent, const std::string& key, auto&& value) {
  if (auto* table = parent.as_table())
    table->insert_or_assign(key, std::forward<decltype(value)>(value));
  else
    parent.as_array()->replace(parent.as_array()->cbegin() + static_cast<std::ptrdiff_t>(std::stoul(key)),
                               std::forward<decltype(value)>(value));
}

void apply(toml::table& root, Document& document, const std::string& text) {
  const auto equals = text.find('=');
  const auto complain = [&](const std::string& found) {
    document.problems.push_back("--set " + text + ": found " + found + ", expected section.key=value");
  };
  if (equals == std::string::npos) return complain("no '='");
  if (equals == 0) return complain("no key");
  const std::string value = text.substr(equals + 1);
  std::istringstream parts(text.substr(0, equals));
  std::vector<std::string> keys;
  for (std::string key; std::getline(parts, key, '.');) keys.push_back(key);
  toml::node* parent = &root;
  std::string path;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    if (const auto* array = parent->as_array()) {
      const auto entry = entry_of(*array, keys[k]);
      if (!entry) return complain("no entry '" + keys[k] + "' of '" + keys[k - 1] + "'");
      keys[k] = std::to_string(*entry);  // "00" is entry 0
    } else if (!parent->as_table()) {
      return complain("'" + keys[k - 1] + "', which is no section");
    }
    path += (path.empty() ? "" : ".") + keys[k];
    if (k + 1 == keys.size()) break;
    auto* table = parent->as_table();
    auto* next = table ? table->get(keys[k]) : parent->as_array()->get(std::stoul(keys[k]));
    parent = next ? next : &table->insert(keys[k], toml::table{}).first->second;
  }
  toml::table parsed;
  try {
    parsed = toml::parse("value = " + value);
  } catch (const toml::parse_error&) {
  }
  const auto* read = parsed.size() == 1 ? parsed.get("value") : nullptr;
  const auto* list = parent->as_array();
  if (list && list->get(std::stoul(keys.back()))->is_table() && !(read && read->is_table()))
    return complain("a value for '" + path + "', which is a section");
  std::erase_if(document.overrides, [&](const auto& o) { return o.first.starts_with(path + "."); });
  document.overrides[path] = value;
  if (read)
    put(*parent, keys.back(), std::move(*parsed.get("value")));
  else
    put(*parent, keys.back(), value);
}

}  // namespace

std::string kind_of(const toml::node& node) {
  return node.is_table()            ? "a table"
         : node.is_array()          ? "an array"
         : node.is_string()         ? "a text"
         : node.is_integer()        ? "an integer"
         : node.is_floating_point() ? "a number"
         : node.is_boolean()        ? "true or false"
                                    : "a date or time";
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

toml::table parse_toml(const std::string& text, const std::string& kind,
                       const std::vector<std::string>& settings, Document& document) {
  auto table = parse_toml(text, kind, document);
  for (const auto& setting : settings) apply(table, document, setting);
  return table;
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
  if (const auto* text = node.as_string(); text && text->get().find_first_of("\n\r") != std::string::npos)
    return refuse(node, path, "a text of several lines", "a text in one line");
  const bool in_one_line = node.source().begin.line == node.source().end.line;
  const auto* array = node.as_array();
  const bool of_tables = array && !array->empty() && array->get(0)->is_table();
  if (node.is_string() || node.is_number() || node.is_boolean() || (array && in_one_line && !of_tables))
    return document_->raw(node, path);
  if (of_tables) return list_of(*array, path);
  return refuse(node, path, kind_of(node), "a value of this key");
}

/// An array of tables in one line, "[{count = 2, diameter = "12.7 mm"}]".
std::optional<std::string> Section::list_of(const toml::array& entries, const std::string& path) {
  std::string list;
  for (std::size_t k = 0; k < entries.size(); ++k) {
    const auto* table = entries.get(k)->as_table();
    const std::string place = path + "." + std::to_string(k);
    if (!table) return refuse(*entries.get(k), place, kind_of(*entries.get(k)), "a table");
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
