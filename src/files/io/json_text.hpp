// JSON for other programs, in order and with numbers of any precision, which common libraries do not write.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/clean_text.hpp"
#include "base/scalar.hpp"

namespace edmill::io {

class JsonText {
 public:
  JsonText() { text_ = "{"; }

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
  void text(std::string_view key, std::string_view value) { put(key, quoted(value)); }
  void integer(std::string_view key, auto value) { put(key, std::to_string(value)); }
  void flag(std::string_view key, bool value) { put(key, value ? "true" : "false"); }
  void null(std::string_view key) { put(key, "null"); }
  void integers(std::string_view key, const std::vector<int>& values) {
    put_list(key, values, [](int value) { return std::to_string(value); });
  }
  void numbers(std::string_view key, const std::vector<double>& values) {
    put_list(key, values, [](double value) { return to_text<double>(value); });
  }
  void texts(std::string_view key, const std::vector<std::string>& values) { put_list(key, values, quoted); }
  /// nan and infinity, which JSON does not have, become null.
  template <class Real>
  void number(std::string_view key, const Real& value) {
    using std::isfinite;
    isfinite(value) ? put(key, to_text<Real>(value)) : null(key);
  }
  /// null for nothing.
  template <class Real>
  void number(std::string_view key, const std::optional<Real>& value) {
    value ? number(key, *value) : null(key);
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
      if (static_cast<unsigned char>(c) < 0x20) {
        constexpr char digits[] = "0123456789abcdef";
        out += std::string("\\u00") + digits[(c >> 4) & 15] + digits[c & 15];
      } else {
        out += c;
      }
    }
    return out + "\"";
  }
  void new_line() { text_ += "\n" + std::string(2 * depth_, ' '); }
  void put(std::string_view key, std::string_view value) {
    if (!first_) text_ += ",";
    first_ = false;
    new_line();
    text_ += quoted(key) + ": " + std::string(value);
  }

  void put_list(std::string_view key, const auto& values, const auto& text_of) {
    std::string list;
    for (const auto& value : values) list += (list.empty() ? "" : ", ") + text_of(value);
    put(key, "[" + list + "]");
  }

  std::string text_;
  std::size_t depth_ = 1;
  bool first_ = true;
};

}  // namespace edmill::io
