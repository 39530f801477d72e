// Structs that list their keys, by `keys(self, row)` with row(parameter, member) for each: how they
// are read, checked, described, digested and listed for `edmill reference`.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "base/errors.hpp"
#include "casefile/section.hpp"
#include "model/parts/parameter.hpp"

namespace edmill::casefile {

using model::Parameter;

bool in_range(const Quantity& q, const model::Range& range);

/// "a positive length", "a number from 0 to 1", for messages.
std::string expected(const Parameter& p);

/// @pre the parameter has a fallback of its dimension
Quantity fallback_of(const Parameter& p);

/// A struct that lists its keys. A member may be one too, a table in which all keys need defaults.
template <class T>
concept Keyed = requires(T& t) {
  T::keys(t, [](const Parameter&, const auto&) {});
};
/// A value with a form of its own in a file: `read_from(section, key)`.
template <class T>
concept Formed = requires(T& t, Section& section, const char* key) {
  t.read_from(section, key);
};
/// A value under a name that the user chooses: `read(section, name)`.
template <class T>
concept NamedEntry = requires(Section& section, const std::string& name) {
  T::read(section, name)->~T();
};
/// `choices_of(value)` are the names of its values in a file, in the order of the enumerators.
template <class T>
concept Choice = std::is_enum_v<T>;

/// A table with the keys of a T whose reader needs other parts of the file first.
template <Keyed T> struct Inner { std::optional<Section> section; };
/// Entries [[key]] of such tables.
template <Keyed T> struct Entries : std::vector<Section> {
  T like{};                  ///< a new entry
  bool may_be_none = false;  ///< `key = []` is allowed
};

/// A new table of a member that is one, and a new entry of a list of them.
template <Keyed T> T new_table(const T&) { return {}; }
template <Keyed T> T new_table(const std::optional<T>&) { return {}; }
template <Keyed T> T new_table(const Inner<T>&) { return {}; }
auto entry_of(const auto& list) -> decltype((list.like)) { return list.like; }
template <Keyed T> T entry_of(const std::vector<T>&) { return {}; }

/// Reads members from a section. The member of an absent key gets the fallback of its row; without
/// one it keeps its value if it is optional or the row has `otherwise`, or the key is reported.
class KeyReader {
 public:
  enum class Absent { fallback, kept };
  /// @param absent  `kept`: members of absent keys always keep their values
  explicit KeyReader(Section& section, Absent absent = Absent::fallback)
      : section_(section), kept_(absent == Absent::kept) {}

  void operator()(const Parameter& p, Quantity& value);
  void operator()(const Parameter& p, std::optional<Quantity>& value);
  void operator()(const Parameter& p, std::array<Quantity, 3>& values);
  void operator()(const Parameter& p, std::uint64_t& value);
  void operator()(const Parameter& p, int& value);
  void operator()(const Parameter& p, std::optional<std::uint64_t>& value);
  void operator()(const Parameter& p, bool& value);
  void operator()(const Parameter& p, std::string& value);
  void operator()(const Parameter& p, std::optional<std::string>& value) {
    value = section_.text(p.key);
  }
  void operator()(const Parameter& p, std::optional<Section>& value) {
    value.emplace(section_.section(p.key));
  }
  void operator()(const Parameter& p, std::optional<std::vector<std::string>>& values) {
    if (section_.has(p.key)) values = section_.settings(p.key);
  }
  void operator()(const Parameter& p, std::vector<std::string>& values) {
    values = section_.settings(p.key);
  }
  void operator()(const Parameter& p, Colour& value) { value = section_.colour(p.key, value); }
  void operator()(const Parameter& p, MotionSpec& motion) { motion = read_motion(section_, p.key); }
  void operator()(const Parameter& p, VesselSpec& vessel) { vessel = read_vessel(section_, p.key); }
  void operator()(const Parameter& p, Choice auto& value) {
    const auto& names = choices_of(value);
    const auto name = section_.choice(p.key, {names.begin(), names.end()});
    value = static_cast<std::decay_t<decltype(value)>>(
        std::find(names.begin(), names.end(), name) - names.begin());
  }
  template <Formed T> void operator()(const Parameter& p, T&& value) {
    value.read_from(section_, p.key);
  }
  template <NamedEntry T> void operator()(const Parameter&, std::vector<T>& values) {
    for (const auto& name : section_.keys())
      if (auto value = T::read(section_, name)) values.push_back(*value);
  }
  template <Keyed T> void operator()(const Parameter& p, std::optional<T>& value) {
    if (section_.section(p.key).present()) (*this)(p, value.emplace());
  }
  template <Keyed T> void operator()(const Parameter& p, T& value) {
    Section own = section_.section(p.key);
    read_all_keys(own, value);
  }
  /// Entries [[key]]. `T::check(entry, list)`, if T has it, checks the last of the list so far.
  template <Keyed T> void operator()(const Parameter& p, std::vector<T>& list) {
    for (Section& entry : section_.sections(p.key)) {
      read_keys(entry, list.emplace_back());
      if constexpr (requires { T::check(entry, list); }) T::check(entry, list);
      entry.reject_unknown_keys();
    }
  }
  template <Keyed T> void operator()(const Parameter& p, Inner<T>& table) {
    table.section.emplace(section_.section(p.key));
  }
  template <Keyed T> void operator()(const Parameter& p, Entries<T>& entries) {
    static_cast<std::vector<Section>&>(entries) = section_.sections(p.key, entries.may_be_none);
  }

  /// True if every quantity was present and readable.
  bool complete() const { return complete_; }
 private:
  /// Reports an absent key that has no default and is not optional.
  void require_presence(const Parameter& p, const std::string& expected);

  Section& section_;
  bool kept_, complete_ = true;
};

void read_keys(Section& section, Keyed auto& keyed) { keyed.keys(keyed, KeyReader(section)); }

/// Reads a section that has no other keys.
void read_all_keys(Section& section, Keyed auto& keyed) {
  read_keys(section, keyed);
  section.reject_unknown_keys();
}

/// Reads each entry, hands it to `use(entry, value)`, and reports its other keys.
template <Keyed T> void read_entries(Entries<T>& entries, const auto& use) {
  for (Section& entry : entries) {
    T value = entries.like;
    read_keys(entry, value);
    use(entry, value);
    entry.reject_unknown_keys();
  }
}

/// Reports values out of range that were not read from a file.
struct KeyChecker {
  Section& section;

  void operator()(const Parameter& p, const Quantity& value) const {
    if (p.key) section.require(in_range(value, p.range), p.key, expected(p));
  }
  void operator()(const Parameter& p, const std::optional<Quantity>& value) const {
    if (value) (*this)(p, *value);
  }
  void operator()(const Parameter& p, const std::array<Quantity, 3>& values) const {
    for (const auto& value : values) (*this)(p, value);
  }
  void operator()(const Parameter&, const auto&) const {}
};

/// The kind of values that a member accepts, for readers: "count", "three lengths".
template <class Value> std::string kind_of(const Parameter& p) {
  if (p.kind) return p.kind;
  if constexpr (std::is_same_v<Value, Quantity>) {
    return p.range == Range::count ? "count" : noun(p.dimension);
  } else if constexpr (std::is_same_v<Value, std::array<Quantity, 3>>) {
    return "three " + noun(p.dimension) + "s";
  } else if constexpr (std::is_same_v<Value, Colour>) {
    return "colour";
  } else if constexpr (std::is_same_v<Value, std::string>) {
    return "text";
  } else if constexpr (std::is_integral_v<Value>) {
    return std::is_same_v<Value, bool> ? "true or false" : "count";
  } else if constexpr (requires(const Value& value) { new_table(value); }) {
    return "table";
  } else if constexpr (requires(const Value& value) { entry_of(value); }) {
    return "tables";
  } else if constexpr (requires(Value value) { value.has_value(); }) {
    return kind_of<typename Value::value_type>(p);
  } else {
    throw ContractError(std::string("a row that says what the key ") + p.key + " takes");
  }
}

/// The default of a key, for readers. @param optional  the key may be absent without a default
std::string default_of(const Parameter& p, bool optional);

/// "119/25000", "0,1/10,0", "-" for nothing, in the digest.
inline std::string digest_of(const Quantity& value) { return value.text(); }
inline std::string digest_of(const std::string& value) { return value; }
inline std::string digest_of(std::uint64_t value) { return std::to_string(value); }
std::string digest_of(const std::array<Quantity, 3>& value);
std::string digest_of(const Colour& value);
template <class Value> std::string digest_of(const std::optional<Value>& value) {
  return value ? digest_of(*value) : "-";
}

struct DigestValue {
  std::string key, value;
  bool named;  ///< with its name, as it is later than version 1.0
};

/// Values that affect a run, in the order of the keys.
template <class T> std::vector<DigestValue> digest_values(const T& keyed) {
  T plain{};
  std::vector<std::string> defaults;
  T::keys(
      plain, [&](const Parameter&, const auto& value) { defaults.push_back(digest_of(value)); });
  std::vector<DigestValue> values;
  auto usual = defaults.begin();
  T::keys(keyed, [&](const Parameter& p, const auto& value) {
    const bool named = p.digest == Parameter::Digest::named;
    auto own = digest_of(value);
    if (p.digest == Parameter::Digest::value || (named && own != *usual))
      values.push_back({p.key, own, named});
    ++usual;
  });
  return values;
}

struct Key {
  std::string section;  ///< "run", "mill.joint"
  std::string of;       ///< type of mill, vessel, law or output that alone has the key; "" for all
  std::string name;     ///< "*" where names are the user's
  std::string kind, fallback, meaning;
};

struct KeySection {
  std::string name;     ///< "mill.joint"; "" for a whole file
  std::string heading;  ///< "[[mill.joint]]", "swing of [[mill.joint]]"
  std::string meaning;
  std::vector<Key> keys;
};

/// Every key that a file can contain, in the order of the reference; no other may be looked up.
std::span<const KeySection> key_sections();
/// @param path  of a section as messages name it, "output.0.columns.1"
bool is_key(const std::string& path, const std::string& name);

/// Adds the keys of structs to a list of sections, and the sections of the tables inside them.
class KeyLister {
 public:
  explicit KeyLister(std::vector<KeySection>& sections) : sections_(sections) {}
  /// A lister for the keys of a table inside this one. @param list  for an array, [[key]]
  KeyLister inside(const std::string& key, bool list, const char* what) const;
  /// A lister for keys of a single type.
  KeyLister only_of(const std::string& type) const {
    KeyLister lister = *this;
    lister.of_ = type;
    return lister;
  }

  template <class Value> void operator()(const Parameter& p, const Value& value) const {
    if (!p.key) return;
    constexpr bool optional = requires { value.has_value(); };
    constexpr bool table = requires { new_table(value); };
    constexpr bool list = requires { entry_of(value); };
    if constexpr (requires { typename Value::Kinds; })
      add_choice<typename Value::Kinds>(p);
    else
      add(p, kind_of<Value>(p), default_of(p, optional || table || list));
    if constexpr (table) add_section(p, false, new_table(value));
    if constexpr (list) add_section(p, true, entry_of(value));
  }
  /// Adds the key of a choice between types, and the keys of each type.
  template <class... Part> void operator()(const Parameter& p, const std::variant<Part...>&) const {
    add_choice<std::variant<Part...>>(p);
    (list_part(Part{}), ...);
  }
  /// Adds a key whose meaning is followed by the names of a variant's types.
  template <class Variant> void add_choice(const Parameter& p) const {
    std::string meaning = p.meaning;
    for (const auto& name : names_of_kinds<Variant>())
      meaning += (meaning.ends_with('`') ? ", `" : ": `") + name + "`";
    Parameter named = p;
    named.meaning = meaning.c_str();
    add(named, p.kind, p.otherwise);
  }
 private:
  void list_part(auto part) const {
    const auto own = only_of(part.name);
    if constexpr (requires { table_of(part); }) {
      auto table = table_of(part);
      table.keys(table, own);
    } else {
      part.parameters(part, own);
    }
  }

  /// Adds a row. A key that several types have with the same meaning gets only one.
  void add(const Parameter& p, const std::string& kind, const std::string& fallback) const;

  template <Keyed T> void add_section(const Parameter& p, bool list, T entry) const {
    T::keys(entry, inside(p.key, list, T::what));
  }

  std::vector<KeySection>& sections_;
  std::string section_, of_;
  std::string list_;  ///< heading of the list that it is in, "[[output]]"; empty outside of lists
};

}  // namespace edmill::casefile
