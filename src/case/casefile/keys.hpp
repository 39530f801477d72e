// Every key that a case, a sweep or an optimisation file can contain, from the lists of the structs that
// these files give. A look-up of any other key is an error of the program, and the reference (`edmill
// reference`) is made from this table.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "casefile/key_reader.hpp"

namespace edmill::casefile {

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

/// In the order in which a reader wants them.
std::span<const KeySection> key_sections();
/// @param path  of a section as messages name it, "output.0.columns.1"
bool is_key(const std::string& path, const std::string& name);

/// Adds the keys of structs to a list of sections, and the sections of the tables inside them.
class KeyLister {
 public:
  explicit KeyLister(std::vector<KeySection>& sections) : sections_(sections) {}
  /// The keys of a table. @param list  whether there are several, [[key]]
  KeyLister inside(const std::string& key, bool list, const char* what) const;
  /// Keys that one type alone has.
  KeyLister only_of(const std::string& type) const {
    KeyLister lister = *this;
    lister.of_ = type;
    return lister;
  }

  template <class Value>
  void operator()(const Parameter& p, const Value& value) const {
    if (!p.key) return;
    constexpr bool optional = requires { value.has_value(); }
    , list = requires { entry_of(value); };
    if constexpr (requires { typename Value::Kinds; })
      add_choice<typename Value::Kinds>(p);
    else
      add(p, kind_of<Value>(p), default_of(p, optional || Keyed<Value> || list));
    if constexpr (optional) {
      using Inside = typename Value::value_type;
      if constexpr (Keyed<Inside>) add_section(p, false, Inside{});
    }
    if constexpr (Keyed<Value>) add_section(p, false, Value{});
    if constexpr (list) add_section(p, true, entry_of(value));
  }
  template <Keyed T>
  void operator()(const Parameter& p, const Inner<T>&) const {
    add(p, kind_of<Inner<T>>(p), default_of(p, true));
    add_section(p, false, T{});
  }
  /// One of several types, and the keys of each.
  template <class... Part>
  void operator()(const Parameter& p, const std::variant<Part...>&) const {
    add_choice<std::variant<Part...>>(p);
    (list_part(Part{}), ...);
  }
  /// The names of the types of a variant after the meaning.
  template <class Variant>
  void add_choice(const Parameter& p) const {
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

  /// A key that several types have in the same sense is one row.
  void add(const Parameter& p, const std::string& kind, const std::string& fallback) const;

  template <Keyed T>
  void add_section(const Parameter& p, bool list, T entry) const {
    T::keys(entry, inside(p.key, list, T::what));
  }

  std::vector<KeySection>& sections_;
  std::string section_, of_;
  std::string list_;  ///< heading of the list that it is in, "[[output]]"; empty outside of lists
};

}  // namespace edmill::casefile
