// Every key that a case, a sweep or an optimisation file can contain. A look-up of any other key is an error
// of the program, and the reference (`edmill reference`) is made from this table.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace edmill::casefile {

struct Key {
  std::string section;  ///< "run", "mill.joint"; "" for the sections themselves
  std::string of;       ///< type of mill, vessel, law or output that alone has the key; "" for all
  std::string name;     ///< "*" where names are the user's
  std::string kind, fallback, meaning;
};

struct SectionText {
  std::string_view name;     ///< "mill.joint"
  std::string_view heading;  ///< "[[mill.joint]]"
  std::string_view meaning;
};

/// In the order in which a reader wants them.
std::span<const SectionText> section_texts();
/// By section. Keys of motions, vessels, laws and outputs stand with these.
const std::vector<Key>& keys();
/// @param path  of a section as messages name it, "output.0.columns.1"
bool is_key(const std::string& path, const std::string& name);

}  // namespace edmill::casefile
