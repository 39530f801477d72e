// Settings over a document: "section.key=value".
#include <sstream>

#include "casefile/section.hpp"

namespace edmill::casefile {

namespace {

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

toml::table parse_toml(const std::string& text, const std::string& kind,
                       const std::vector<std::string>& settings, Document& document) {
  auto table = parse_toml(text, kind, document);
  for (const auto& setting : settings) apply(table, document, setting);
  return table;
}

}  // namespace edmill::casefile
