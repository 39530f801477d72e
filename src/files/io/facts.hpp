// The fields of a result in double, by their keys.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "base/errors.hpp"
#include "io/json_text.hpp"

namespace edmill::io {

/// The fields of a JSON file in double, by the paths of their keys ("energy/closure"), in its
/// order.
class Facts {
 public:
  using Texts = std::vector<std::string>;
  /// monostate is null, as nan and infinity are in the file.
  using Value = std::variant<std::monostate, bool, double, std::string, Texts, std::vector<double>>;

  /// @param source  name of the file, for messages
  explicit Facts(std::string source = {}) : source_(std::move(source)) {}

  /// Adds a value, or replaces that of the path.
  void set(const std::string& path, Value value);

  /// Whether there is a field, which may be null.
  bool has(std::string_view path) const { return value(path) != nullptr; }
  /// @param expected  what it should be, for the InputError when there is no such value
  const std::string& text(std::string_view path, const char* expected = "a text") const {
    return get<std::string>(path, expected);
  }
  double number(std::string_view path) const { return get<double>(path, "a number"); }
  bool flag(std::string_view path) const { return get<bool>(path, "true or false"); }
  const Texts& texts(std::string_view path) const { return get<Texts>(path, "a list of texts"); }
  /// Nothing where it is absent or null. @throws InputError for anything but a number
  std::optional<double> find(std::string_view path) const;
  /// A list of numbers; null if there is no such field.
  const std::vector<double>* numbers(std::string_view path) const {
    const auto* found = value(path);
    return found ? std::get_if<std::vector<double>>(found) : nullptr;
  }
  /// The keys in a group, in their order.
  Texts keys_of(const std::string& group) const;

  InputError wrong(std::string_view path, const char* expected) const;
  /// As JSON.
  std::string json() const;
 private:
  const Value* value(std::string_view path) const;
  template <class T> const T& get(std::string_view path, const char* expected) const {
    const auto* found = value(path);
    if (!found || !std::holds_alternative<T>(*found)) throw wrong(path, expected);
    return std::get<T>(*found);
  }

  std::string source_;
  std::vector<std::pair<std::string, Value>> values_;
};

}  // namespace edmill::io
