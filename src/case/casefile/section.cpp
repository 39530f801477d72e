// Reads TOML files, applies settings "section.key=value", and looks up typed values.
#include "casefile/section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <sstream>

#include "base/errors.hpp"
#include "casefile/keys.hpp"
#include "casefile/nearest.hpp"

namespace edmill::casefile {

namespace {

constexpr std::pair<std::string_view, Colour> named_colours[]{{"black", {0, 0, 0}},
    {"blue", {0, 0, 1}}, {"cyan", {0, 1, 1}}, {"fuchsia", {1, 0, 1}}, {"grey", {0.5, 0.5, 0.5}},
    {"green", {0, 0.5, 0}}, {"lime", {0, 1, 0}}, {"magenta", {1, 0, 1}}, {"maroon", {0.5, 0, 0}},
    {"navy", {0, 0, 0.5}}, {"olive", {0.5, 0.5, 0}}, {"purple", {0.5, 0, 0.5}}, {"red", {1, 0, 0}},
    {"teal", {0, 0.5, 0.5}}, {"white", {1, 1, 1}}, {"yellow", {1, 1, 0}}};

/// Byte position of a column that counts characters.
std::size_t byte_of_column(const std::string& line, std::size_t column) {
  std::size_t at = 0;
  for (std::size_t k = 1; k < column && at < line.size(); ++k) {
    ++at;
    while (at < line.size() && (static_cast<unsigned char>(line[at]) & 0xC0) == 0x80) ++at;
  }
  return at;
}

/// The probable cause of a syntax error in a line of TOML, for messages; empty if unknown.
std::string hint_of(const Document& document, std::size_t line) {
  if (line == 0 || line > document.lines.size()) return "";
  const std::string& text = document.lines[line - 1];
  const auto value = text.find_first_not_of(" \t", text.find('=') + 1);
  const bool comma = text.find('=') != std::string::npos && value != std::string::npos &&
      has_comma(text.substr(value));
  for (const auto* quote : {"\u201c", "\u201d", "\u2018", "\u2019"})
    if (text.find(quote) != std::string::npos)
      return " with a typographic quotation mark in place of \"";
  return comma ? " with a comma in place of a decimal point" : "";
}

/// Parses the index of an array entry, "3"; nothing if there is no such entry.
std::optional<std::size_t> entry_of(const toml::array& array, const std::string& index) {
  if (index.empty() || index.size() > 6 ||
      index.find_first_not_of("0123456789") != std::string::npos)
    return std::nullopt;
  const std::size_t place = std::stoul(index);
  return place < array.size() ? std::optional(place) : std::nullopt;
}

/// The child of a table by key, or of an array by index; null if there is none.
template <class Node> Node* child_of(Node& parent, const std::string& key) {
  if (auto* table = parent.as_table()) return table->get(key);
  auto* array = parent.as_array();
  const auto entry = array ? entry_of(*array, key) : std::nullopt;
  return entry ? array->get(*entry) : nullptr;
}

void apply(toml::table& root, Document& document, const std::string& text) {
  const auto equals = text.find('=');
  const auto complain = [&](const std::string& problem) {
    document.problems.push_back("--set " + text + ": " + problem + ", expected section.key=value");
  };
  if (equals == std::string::npos) return complain("'=' is missing");
  if (equals == 0) return complain("the key is missing");
  const std::string value = text.substr(equals + 1);
  auto key = text.substr(0, equals);
  key.erase(key.find_last_not_of(" \t") + 1);
  auto keys = parts_of(key);
  toml::node* parent = &root;
  std::string path;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    if (const auto* array = parent->as_array()) {
      const auto entry = entry_of(*array, keys[k]);
      if (!entry) return complain("'" + keys[k - 1] + "' has no entry '" + keys[k] + "'");
      keys[k] = std::to_string(*entry);  // "00" is entry 0
    } else if (!parent->as_table()) {
      return complain("'" + keys[k - 1] + "' is not a section");
    }
    path += (path.empty() ? "" : ".") + keys[k];
    if (k + 1 == keys.size()) break;
    auto* next = child_of(*parent, keys[k]);
    parent = next ? next : &parent->as_table()->insert(keys[k], toml::table{}).first->second;
  }
  toml::table parsed;
  try {
    parsed = toml::parse("value = " + value);
  } catch (const toml::parse_error&) {
  }
  if (parsed.size() != 1) parsed = toml::table{{"value", value}};  // otherwise it is taken as text
  auto& read = *parsed.get("value");
  const auto& last = keys.back();
  if (parent->is_array() && child_of(*parent, last)->is_table() && !read.is_table())
    return complain("'" + path + "' is a section, not a key");
  std::erase_if(document.overrides, [&](const auto& o) { return o.first.starts_with(path + "."); });
  document.overrides[path] = value;
  if (auto* table = parent->as_table())
    table->insert_or_assign(last, std::move(read));
  else if (auto* list = parent->as_array())
    list->replace(list->cbegin() + static_cast<std::ptrdiff_t>(std::stoul(last)), std::move(read));
}

}  // namespace

std::string kind_of(const toml::node& node) {
  return node.is_table()         ? "a table"
      : node.is_array()          ? "an array"
      : node.is_string()         ? "a text"
      : node.is_integer()        ? "an integer"
      : node.is_floating_point() ? "a number"
      : node.is_boolean()        ? "true or false"
                                 : "a date or time";
}

std::string one_of(const std::vector<std::string>& names) {
  return fmt::format("one of \"{}\"", fmt::join(names, "\", \""));
}

std::vector<std::string> parts_of(const std::string& path) {
  std::istringstream stream(path);
  std::vector<std::string> parts;
  for (std::string part; std::getline(stream, part, '.');) parts.push_back(part);
  return parts;
}

const toml::node* node_at(const toml::table& root, const std::string& path) {
  const toml::node* node = path.ends_with('.') ? nullptr : &root;
  for (const auto& part : parts_of(path)) node = node ? child_of(*node, part) : nullptr;
  return node;
}

toml::table parse_toml(const std::string& text, const std::string& kind, Document& document,
    const std::vector<std::string>& settings) {
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) document.lines.push_back(line);
  if (const std::string mark = "\xEF\xBB\xBF"; text.starts_with(mark))
    document.lines[0].erase(0, mark.size());
  try {
    auto table = toml::parse(text, document.name);
    for (const auto& setting : settings) apply(table, document, setting);
    return table;
  } catch (const toml::parse_error& error) {
    const auto line = error.source().begin.line;
    throw InputError(document.name + ":" + std::to_string(line) + ": invalid TOML (" +
        std::string(error.description()) + ")" + hint_of(document, line) + ", expected " + kind);
  }
}

const Document::Override* Document::override_of(std::string path) const {
  for (;;) {
    if (const auto found = overrides.find(path); found != overrides.end()) return &*found;
    const auto dot = path.rfind('.');
    if (dot == std::string::npos) return nullptr;
    path.erase(dot);
  }
}

std::string Document::line(const std::string& path, std::size_t number) const {
  const auto* set = override_of(path);
  if (!set) return number <= lines.size() ? lines[number - 1] : "";
  std::istringstream text("value = " + set->second);  // as it was parsed
  std::string line;
  for (std::size_t k = 0; k < number; ++k)
    if (!std::getline(text, line)) return "";
  return line;
}

std::string Document::where(const toml::node* node, const std::string& path) const {
  if (const auto* set = override_of(path)) return "--set " + set->first + "=" + set->second;
  if (!node || !node->source().begin) {
    for (const auto& [key, text] : overrides)
      if (key.starts_with(path + ".")) return "--set " + key + "=" + text;
    return name;
  }
  return name + ":" + std::to_string(node->source().begin.line);
}

std::string Document::raw(const toml::node& node, const std::string& path) const {
  if (const auto* text = node.as_string()) return text->get();
  const auto& source = node.source();
  if (!source.begin || source.begin.line != source.end.line) return kind_of(node);
  const std::string whole = line(path, source.begin.line);
  const auto first = byte_of_column(whole, source.begin.column);
  std::string text = whole.substr(first, byte_of_column(whole, source.end.column) - first);
  std::erase(text, '_');
  while (!text.empty() && (text.back() == ' ' || text.back() == ',' || text.back() == '\r'))
    text.pop_back();
  return text;
}

void Document::report(const toml::node* node, const std::string& path, const std::string& found,
    const std::string& expected) {
  for (auto dot = path.find('.'); dot != std::string::npos; dot = path.find('.', dot + 1))
    if (problem_keys.count(path.substr(0, dot))) return;
  if (!problem_keys.insert(path).second) return;
  const auto what = found == "nothing" ? "missing" : "found " + found;
  problems.push_back(
      where(node, path) + ": key '" + path + "': " + what + ", expected " + expected);
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

const toml::node* Section::find(const std::string& key) {
  EDMILL_REQUIRE(is_key(path_, key), "the table of keys has " + full(key));
  known_.insert(key);
  return node_of(key);
}

Section Section::section(const std::string& key) {
  const auto* node = find(key);
  if (node && !node->as_table())
    document_->report(node, full(key), kind_of(*node), "a table [" + full(key) + "]");
  return {*document_, node ? node->as_table() : nullptr, full(key), node ? node : place_};
}

std::vector<Section> Section::sections(const std::string& key, bool may_be_empty) {
  std::vector<Section> entries;
  const auto* node = find(key);
  if (!node) return entries;
  const auto* array = node->as_array();
  if (may_be_empty && array && array->empty()) return entries;
  if (!array || !array->is_array_of_tables()) {
    document_->report(node, full(key), kind_of(*node), "entries [[" + full(key) + "]]");
    return entries;
  }
  for (std::size_t k = 0; k < array->size(); ++k)
    entries.emplace_back(
        *document_, array->get(k)->as_table(), full(key) + "." + std::to_string(k));
  return entries;
}

std::optional<Quantity> Section::quantity_in(
    const toml::node& node, const std::string& path, Dimension dimension, Plain plain) {
  if (!node.is_string() && !node.is_number())
    return refuse(node, path, kind_of(node), describe(dimension));
  const auto result =
      parse_quantity(document_->raw(node, path), dimension, document_->sizes, plain);
  if (const auto* problem = std::get_if<QuantityProblem>(&result))
    return refuse(node, path, problem->found, describe(dimension));
  return std::get<Quantity>(result);
}

std::optional<Quantity> Section::quantity(const std::string& key, Dimension dimension) {
  const auto* node = find(key);
  return node ? quantity_in(*node, full(key), dimension, Plain::refused) : std::nullopt;
}

std::optional<Quantity> Section::item(
    const toml::array& array, const std::string& path, std::size_t k, Dimension dimension) {
  return quantity_in(*array.get(k), path + "." + std::to_string(k), dimension, Plain::is_si);
}

std::optional<QuantityVector> Section::vector(const std::string& key, Dimension dimension) {
  const auto* node = find(key);
  if (!node) return std::nullopt;
  const std::string expected = "an array of three numbers or texts, each " + describe(dimension);
  const auto* array = node->as_array();
  if (!array || array->size() != 3)
    return refuse(*node, full(key),
        array ? "an array of " + std::to_string(array->size()) : kind_of(*node), expected);
  QuantityVector vector;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto value = item(*array, full(key), k, dimension);
    if (!value) return std::nullopt;
    vector[k] = *value;
  }
  return vector;
}

std::vector<std::array<Quantity, 2>> Section::pairs(
    const std::string& key, Dimension first, Dimension second) {
  const auto* node = find(key);
  if (!node) return {};
  const auto* array = node->as_array();
  std::vector<std::array<Quantity, 2>> pairs;
  for (std::size_t k = 0; array && k < array->size(); ++k) {
    const auto* pair = array->get(k)->as_array();
    const std::string path = full(key) + "." + std::to_string(k);
    if (!pair || pair->size() != 2) {
      document_->report(array->get(k), path, kind_of(*array->get(k)),
          "an array of two: " + describe(first) + " and " + describe(second));
      continue;
    }
    const auto one = item(*pair, path, 0, first), two = item(*pair, path, 1, second);
    if (one && two) pairs.push_back({*one, *two});
  }
  if (!array || array->empty())
    document_->report(
        node, full(key), array ? "an empty array" : kind_of(*node), "an array of pairs");
  return pairs;
}

std::optional<std::uint64_t> Section::count(const std::string& key) {
  const auto* node = find(key);
  if (!node) return std::nullopt;
  const auto* integer = node->as_integer();
  if (!integer || integer->get() < 0)
    return refuse(*node, full(key),
        node->is_value() ? "\"" + document_->raw(*node, full(key)) + "\"" : kind_of(*node),
        "an integer, 0 or more");
  return static_cast<std::uint64_t>(integer->get());
}

std::optional<std::string> Section::text(const std::string& key) {
  const auto* node = find(key);
  if (!node) return std::nullopt;
  const auto* string = node->as_string();
  if (!string || string->get().empty())
    return refuse(*node, full(key), string ? "an empty text" : kind_of(*node), "a text");
  const auto control = [](char c) { return std::iscntrl(static_cast<unsigned char>(c)) != 0; };
  if (std::any_of(string->get().begin(), string->get().end(), control))
    return refuse(*node, full(key), "a text with control characters", "a text in one line");
  return string->get();
}

Colour Section::colour(const std::string& key, const Colour& fallback) {
  const auto* node = find(key);
  if (!node) return fallback;
  if (const auto* name = node->as_string())
    for (const auto& [known, colour] : named_colours)
      if (known == name->get()) return colour;
  const auto* array = node->as_array();
  if (array && array->size() == 3 && array->is_homogeneous() && array->get(0)->is_number()) {
    const double full = array->get(0)->is_integer() ? 255 : 1;
    Colour colour;
    bool good = true;
    for (std::size_t k = 0; k < 3; ++k) {
      colour[k] = array->get(k)->value_or(-1.0) / full;
      good = good && colour[k] >= 0 && colour[k] <= 1;
    }
    if (good) return colour;
  }
  std::vector<std::string_view> names;
  for (const auto& [known, colour] : named_colours) names.push_back(known);
  problem(key, node->is_string() ? "\"" + node->as_string()->get() + "\"" : kind_of(*node),
      fmt::format("three integers from 0 to 255, three decimals from 0 to 1, or one of {}",
          fmt::join(names, ", ")));
  return fallback;
}

std::string Section::choice(const std::string& key, const std::vector<std::string>& choices) {
  const auto* node = find(key);
  if (!node) return choices.front();
  const auto* string = node->as_string();
  if (string && std::find(choices.begin(), choices.end(), string->get()) != choices.end())
    return string->get();
  problem(key, string ? "\"" + string->get() + "\"" : kind_of(*node), one_of(choices));
  return choices.front();
}

std::string Section::kind(const std::string& key, const std::vector<std::string>& kinds) {
  auto chosen = choice(key, kinds);
  of_unknown_kind_ = has(key) && !(table_->get(key)->value<std::string>() == chosen);
  return chosen;
}

std::vector<std::string> Section::keys() const {
  std::multimap<toml::source_position, std::string> found;
  if (table_)
    for (const auto& [key, node] : *table_)
      found.emplace(key.source().begin, std::string(key.str()));
  std::vector<std::string> keys;
  for (auto& [place, key] : found) keys.push_back(std::move(key));
  return keys;
}

std::optional<std::string> Section::setting_of(const toml::node& node, const std::string& path) {
  if (const auto* text = node.as_string();
      text && text->get().find_first_of("\n\r") != std::string::npos)
    return refuse(node, path, "a text of several lines", "a text in one line");
  const bool in_one_line = node.source().begin.line == node.source().end.line;
  const auto* array = node.as_array();
  const bool of_tables = array && !array->empty() && array->get(0)->is_table();
  if (node.is_string() || node.is_number() || node.is_boolean() ||
      (array && in_one_line && !of_tables))
    return document_->raw(node, path);
  if (of_tables) return list_of(*array, path);
  return refuse(node, path, kind_of(node), "a value for this key");
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
      row += fmt::format("{}{} = {}", row.empty() ? "" : ", ", key.str(),
          value.is_string() ? "\"" + *text + "\"" : *text);
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

std::vector<std::string> Section::settings(const std::string& key, Twice twice) {
  const auto* node = find(key);
  if (!node) return {};
  const auto* array = node->as_array();
  if (!array || array->empty()) {
    const std::string dotted = node->is_table() ? "; write a key with dots in quotes" : "";
    document_->report(
        node, full(key), array ? "an empty array" : kind_of(*node), "an array of values" + dotted);
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

void Section::problem(
    const std::string& key, const std::string& found, const std::string& expected) {
  const auto* node = node_of(key);
  document_->report(node ? node : place_, full(key), found, expected);
}

void Section::require(bool good, const std::string& key, const std::string& expected) {
  if (good) return;
  const auto* node = node_of(key);
  problem(key, node ? "\"" + document_->raw(*node, full(key)) + "\"" : "nothing", expected);
}

void Section::reject_unknown_keys() {
  if (!table_ || of_unknown_kind_) return;
  for (const auto& [key, node] : *table_) {
    const std::string name(key.str());
    if (known_.count(name)) continue;
    const std::vector<std::string> known(known_.begin(), known_.end());
    document_->report(&node, full(name), "an unknown key", nearest_of(name, known));
  }
}

void AnyValue::read_from(Section& section, const char* key) { text = section.setting(key); }

}  // namespace edmill::casefile
