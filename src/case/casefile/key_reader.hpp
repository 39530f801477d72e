// Structs that list their keys, by `keys(self, visit)` with visit(parameter, member) for each: how they are
// read, checked, described and written to the digest.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>

#include "casefile/section.hpp"
#include "model/parts/parameter.hpp"

namespace edmill::casefile {

using model::Parameter;

bool in_range(const Quantity& q, const model::Range& range);

/// "a positive length", "a number from 0 to 1", for messages.
std::string expected(const Parameter& p);

/// @pre the parameter has a fallback of its dimension
Quantity fallback_of(const Parameter& p);

/// Reads members from a section; what is wrong is reported. A key that is absent gives the fallback; without
/// one the member keeps its value where it is optional or the row says what holds `otherwise`, else the key
/// is missed.
class KeyReader {
 public:
  explicit KeyReader(Section& section) : section_(section) {}

  void operator()(const Parameter& p, Quantity& value);
  void operator()(const Parameter& p, std::optional<Quantity>& value);
  void operator()(const Parameter& p, std::array<Quantity, 3>& values);
  void operator()(const Parameter& p, std::uint64_t& value);
  void operator()(const Parameter& p, int& value);
  void operator()(const Parameter& p, std::optional<std::uint64_t>& value);
  void operator()(const Parameter& p, bool& value);
  void operator()(const Parameter& p, std::string& value);
  void operator()(const Parameter& p, Colour& value);

  /// No quantity is missing or cannot be read.
  bool complete() const { return complete_; }

 private:
  /// Reports an absent key that nothing stands in for.
  void require_presence(const Parameter& p, const std::string& expected);

  Section& section_;
  bool complete_ = true;
};

void read_keys(Section& section, auto& keyed) {
  KeyReader read(section);
  keyed.keys(keyed, read);
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

/// What a member takes, for readers: "count", "three lengths", "true or false".
template <class Value>
std::string kind_of(const Parameter& p, const Value&) {
  if constexpr (std::is_same_v<Value, Quantity>) {
    return p.range == Range::count ? "count" : noun(p.dimension);
  } else if constexpr (std::is_same_v<Value, std::array<Quantity, 3>>) {
    return "three " + noun(p.dimension) + "s";
  } else if constexpr (std::is_same_v<Value, Colour>) {
    return "colour";
  } else {
    static_assert(std::is_integral_v<Value> || std::is_same_v<Value, std::string>);
    return std::is_same_v<Value, std::string> ? "text"
           : std::is_same_v<Value, bool>      ? "true or false"
                                              : "count";
  }
}
template <class Value>
std::string kind_of(const Parameter& p, const std::optional<Value>&) {
  return kind_of(p, Value{});
}

/// What holds without the key, for readers. @param optional  nothing need hold
std::string default_of(const Parameter& p, bool optional);

/// One key for readers.
using SeeKey = std::function<void(const Parameter& p, const std::string& kind, const std::string& fallback)>;

/// Shows every key of a struct.
template <class Keyed>
void see_keys(const SeeKey& see) {
  const Keyed plain{};
  Keyed::keys(plain, [&](const Parameter& p, const auto& value) {
    see(p, kind_of(p, value),
        default_of(
            p, requires { value.has_value(); }));
  });
}

/// "119/25000", "0,1/10,0", "-" for nothing, in the digest.
std::string digest_of(const Quantity& value);
std::string digest_of(const std::array<Quantity, 3>& value);
std::string digest_of(const Colour& value);
std::string digest_of(const std::string& value);
std::string digest_of(std::uint64_t value);
template <class Value>
std::string digest_of(const std::optional<Value>& value) {
  return value ? digest_of(*value) : "-";
}

/// What a run depends on, in the order of the list.
/// @param in_lines  each with its key in a line of its own
template <class Keyed>
std::string digest_text(const Keyed& keyed, bool in_lines = false) {
  const Keyed plain{};
  std::vector<std::string> defaults;
  Keyed::keys(plain, [&](const auto&, const auto& value) { defaults.push_back(digest_of(value)); });
  std::string text, named;
  auto usual = defaults.begin();
  Keyed::keys(keyed, [&](const Parameter& p, const auto& value) {
    const auto own = digest_of(value);
    const std::string line = (in_lines ? "\n" : " ") + std::string(p.key) + " " + own;
    if (p.digest == Parameter::Digest::value) text += in_lines ? line : " " + own;
    if (p.digest == Parameter::Digest::named && own != *usual) named += line;
    ++usual;
  });
  return text + named;
}

}  // namespace edmill::casefile
