// Documents as lists of fields, each with its unit and meaning: a function that calls a visitor for
// every field gives JSON with one visitor and a table of the reference with another.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "io/json_text.hpp"

namespace edmill::io {

/// JSON, in all digits of the scalar.
class JsonFields {
 public:
  /// @param fields  calls the visitor for each field of a document
  static std::string of(const auto& fields) {
    JsonFields visitor;
    fields(visitor);
    return visitor.json_.finish();
  }
  void operator()(std::string_view key, std::string_view, std::string_view, const auto& value) {
    json_.add(key, value);
  }
  void group(std::string_view key, std::string_view, const auto& fill) {
    json_.begin(key);
    fill();
    json_.end();
  }
  /// A group for each item of a list. @param name_of  of an item @param fill  its fields
  void each(
      std::string_view key, std::string_view, const auto& list, auto name_of, const auto& fill) {
    group(key, "", [&] {
      for (const auto& item : list) group(std::invoke(name_of, item), "", [&] { fill(item); });
    });
  }
  /// Names items by their numbers, from "1" on.
  static auto numbers() {
    return [number = 0](const auto&) mutable { return std::to_string(++number); };
  }
  /// A group for each item of a list, named by its number.
  void numbered(std::string_view key, std::string_view, const auto& list, const auto& fill) {
    each(key, "", list, numbers(), fill);
  }
  void texts(std::string_view key, std::string_view, const std::vector<std::string>& list) {
    by_name(key, "", "", list, numbers(), std::identity());
  }
  /// A group of values whose names depend on the items of a list.
  void by_name(std::string_view key, std::string_view, std::string_view, const auto& list,
      auto name_of, const auto& value_of) {
    group(key, "", [&] {
      for (const auto& item : list)
        json_.add(std::invoke(name_of, item), std::invoke(value_of, item));
    });
  }
  /// True if optional fields are to be visited.
  static bool has(bool present) { return present; }
 private:
  JsonText json_;
};

/// A table of keys, units and meanings, including those of optional fields.
class KeyTable {
 public:
  static std::string of(const auto& fields) {
    KeyTable visitor;
    fields(visitor);
    return visitor.text_;
  }
  void operator()(
      std::string_view key, std::string_view unit, std::string_view meaning, const auto&) {
    text_ += fmt::format("| `{}{}` | {} | {} |\n", path_, key, unit, meaning);
  }
  void group(std::string_view key, std::string_view meaning, const auto& fill) {
    (*this)(key, "", meaning, 0);
    within(std::string(key) + ".", fill);
  }
  template <class List>
  void each(
      std::string_view key, std::string_view meaning, const List&, const auto&, const auto& fill) {
    (*this)(key, "", meaning, 0);
    within(std::string(key) + ".*.", [&] { fill(typename List::value_type{}); });
  }
  void numbered(
      std::string_view key, std::string_view meaning, const auto& list, const auto& fill) {
    each(key, meaning, list, 0, fill);
  }
  void texts(std::string_view key, std::string_view meaning, const auto&) {
    (*this)(key, "", meaning, 0);
  }
  void by_name(
      std::string_view key, std::string_view unit, std::string_view meaning, const auto&...) {
    (*this)(key, unit, meaning, 0);
  }
  static bool has(bool) { return true; }
 private:
  void within(const std::string& part, const auto& fill) {
    const auto outside = path_;
    path_ += part;
    fill();
    path_ = outside;
  }

  std::string text_ = "| key | unit | meaning |\n|---|---|---|\n", path_ = {};
};

}  // namespace edmill::io
