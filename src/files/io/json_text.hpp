// Writes JSON with keys in order and numbers of any precision, which common libraries cannot.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "base/clean_text.hpp"
#include "base/scalar.hpp"

namespace edmill::io {

class JsonText {
 public:
  void begin(std::string_view key) {
    put(key, "{");
    ++depth_;
    first_ = true;
  }
  void end() {
    --depth_;
    new_line();
    text_ += "}";
    first_ = false;
  }
  /// Keys, each with its value after it, as `of` writes it.
  void add(std::string_view key, const auto& value, const auto&... more) {
    put(key, of(value));
    if constexpr (sizeof...(more) > 0) add(more...);
  }
  /// A group of such keys.
  void add_group(std::string_view key, const auto&... keys_and_values) {
    begin(key);
    add(keys_and_values...);
    end();
  }
  /// JSON text of a string, flag, number or list of these; null for nothing, nan and infinity.
  template <class T> static std::string of(const T& value) {
    using std::isfinite;
    if constexpr (std::is_same_v<T, std::monostate>)
      return "null";
    else if constexpr (std::is_convertible_v<const T&, std::string_view>)
      return quoted(value);
    else if constexpr (std::is_same_v<T, bool>)
      return value ? "true" : "false";
    else if constexpr (std::is_integral_v<T>)
      return std::to_string(value);
    else if constexpr (requires { *value; })
      return value ? of(*value) : "null";
    else if constexpr (requires { value.begin(); })
      return list_of(value);
    else
      return isfinite(value) ? to_text<T>(value) : "null";
  }

  /// The whole document; nothing can be added after it.
  std::string finish() {
    depth_ = 0;
    new_line();
    return text_ + "}\n";
  }
 private:
  static std::string quoted(std::string_view value) {
    std::string out = "\"";
    for (const char c : clean_text(value)) {
      if (c == '"' || c == '\\') out += '\\';
      out += static_cast<unsigned char>(c) < 0x20 ? fmt::format("\\u{:04x}", int{c})
                                                  : std::string(1, c);
    }
    return out + "\"";
  }
  static std::string list_of(const auto& values) {
    std::string list;
    for (const auto& value : values) list += (list.empty() ? "" : ", ") + of(value);
    return "[" + list + "]";
  }
  void new_line() { text_ += "\n" + std::string(2 * depth_, ' '); }
  void put(std::string_view key, std::string_view value) {
    if (!first_) text_ += ",";
    first_ = false;
    new_line();
    text_ += quoted(key) + ": " + std::string(value);
  }

  std::string text_ = "{";
  std::size_t depth_ = 1;
  bool first_ = true;
};

}  // namespace edmill::io
