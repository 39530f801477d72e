// A table of the case file while it is read: typed look-ups that collect problems.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#define TOML_ENABLE_FORMATTERS 0
#include <toml++/toml.h>

#include "casefile/case_spec.hpp"

namespace edmill::casefile {

/// The document with what messages need: its name, its lines, and which keys the command line set.
struct Document {
  explicit Document(std::string file = {}) : name(std::move(file)) {}

  std::string name;
  std::vector<std::string> lines;
  std::map<std::string, std::string> overrides;  ///< path -> text as given
  SizeLimit sizes = SizeLimit::physical;         ///< of quantities
  std::vector<std::string> problems;
  std::set<std::string> problem_keys;

  /// "case.toml:12" or "--set".
  std::string where(const toml::node* node, const std::string& path) const;
  /// Text of a value as written in the file, so that decimals stay exact.
  std::string raw(const toml::node& node, const std::string& path) const;
  /// The problems in the order of the lines of the file, after those that have no line.
  std::vector<std::string> problems_by_line() const;
  /// Adds a problem. Each key gets at most one; inside of an invalid table there are none.
  void report(const toml::node* node, const std::string& path, const std::string& found,
      const std::string& expected);
 private:
  using Override = std::pair<const std::string, std::string>;
  /// The command line's setting of a key or of a table that contains it; null for others.
  const Override* override_of(std::string path) const;
  std::string line(const std::string& path, std::size_t number) const;
};

/// Parses the text of the file `document.name` and keeps its lines.
/// @param settings  "section.key=value", over the text; errors become problems of the document
/// @throws InputError when the text is not valid TOML
toml::table parse_toml(const std::string& text, const std::string& kind, Document& document,
    const std::vector<std::string>& settings = {});

/// "balls", "0", "count" of "balls.0.count".
std::vector<std::string> parts_of(const std::string& path);
/// The node of a path in a table, in which indices select entries of arrays; null if there is none.
const toml::node* node_at(const toml::table& root, const std::string& path);

/// "one of "a", "b"", for messages.
std::string one_of(const std::vector<std::string>& names);
/// "an array", for messages.
std::string kind_of(const toml::node& node);

class Section {
 public:
  /// @param table  null for a section that is absent: look-ups then find nothing
  Section(Document& document, const toml::table* table, std::string path,
      const toml::node* place = nullptr)
      : document_(&document), table_(table), path_(std::move(path)), place_(place ? place : table) {
  }

  bool present() const { return table_ != nullptr; }
  const std::string& path() const { return path_; }
  std::string where() const { return document_->where(place_, path_) + ": [" + path_ + "]"; }

  /// A sub-section; a key of another kind is reported.
  Section section(const std::string& key);
  /// Entries of an array of tables. @param may_be_empty  `key = []` is valid, as in `output=[]`
  std::vector<Section> sections(const std::string& key, bool may_be_empty = false);

  std::optional<Quantity> quantity(const std::string& key, Dimension dimension);
  std::optional<QuantityVector> vector(const std::string& key, Dimension dimension);
  /// An array of pairs, such as the points of a table; empty when it is not one, which is reported.
  std::vector<std::array<Quantity, 2>> pairs(
      const std::string& key, Dimension first, Dimension second);
  std::optional<std::uint64_t> count(const std::string& key);
  std::optional<std::string> text(const std::string& key);
  /// A name, or red, green and blue: integers up to 255 or decimals up to 1.
  Colour colour(const std::string& key, const Colour& fallback);
  /// The value of a key, which must be one of `choices`; the first of them when the key is absent.
  std::string choice(const std::string& key, const std::vector<std::string>& choices);
  /// A choice that determines which other keys exist; if it is unknown, no key is rejected.
  std::string kind(const std::string& key, const std::vector<std::string>& kinds);
  bool of_unknown_kind() const { return of_unknown_kind_; }

  /// true or false; false when absent.
  bool flag(const std::string& key);
  /// Keys in the order of the file. The call does not mark them as known.
  std::vector<std::string> keys() const;
  /// A value as `--set` would take it: a text, a number, true or false, or an array in one line.
  std::optional<std::string> setting(const std::string& key);
  enum class Twice { refused, allowed };
  /// An array of such values; empty when it is not one, which is reported.
  std::vector<std::string> settings(const std::string& key, Twice twice = Twice::refused);

  bool has(const std::string& key) const { return node_of(key) != nullptr; }
  bool is_array(const std::string& key) const { return has(key) && node_of(key)->is_array(); }
  void problem(const std::string& key, const std::string& found, const std::string& expected);
  /// Reports the value of a key unless `good`.
  void require(bool good, const std::string& key, const std::string& expected);
  /// Reports every key that no look-up asked for.
  void reject_unknown_keys();
 private:
  std::string full(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }
  /// Looks up a key and marks it as known.
  const toml::node* find(const std::string& key);
  const toml::node* node_of(const std::string& key) const {
    return table_ ? table_->get(key) : nullptr;
  }
  /// Reports a value and returns nothing in its place.
  std::nullopt_t refuse(const toml::node& node, const std::string& path, const std::string& found,
      const std::string& expected) {
    document_->report(&node, path, found, expected);
    return std::nullopt;
  }
  /// Nothing when the value is no quantity, which is reported.
  std::optional<Quantity> quantity_in(
      const toml::node& node, const std::string& path, Dimension dimension, Plain plain);
  /// An entry of an array.
  std::optional<Quantity> item(
      const toml::array& array, const std::string& path, std::size_t k, Dimension dimension);
  std::optional<std::string> setting_of(const toml::node& node, const std::string& path);
  std::optional<std::string> list_of(const toml::array& entries, const std::string& path);

  Document* document_;
  const toml::table* table_;
  std::string path_;
  const toml::node* place_;
  std::set<std::string> known_;
  bool of_unknown_kind_ = false;
};

/// The key at which to report a problem of several keys: the first one present, or else the last.
inline const char* first_of(const Section& section, std::initializer_list<const char*> keys) {
  for (const char* key : keys)
    if (section.has(key)) return key;
  return *(keys.end() - 1);
}

}  // namespace edmill::casefile
