// Reads JSON files.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/errors.hpp"
#include "io/facts.hpp"
#include "io/input_file.hpp"

namespace edmill::io {

/// @param expected  what the file should be, for the InputError: "the summary of a run"
inline nlohmann::json read_json(const std::filesystem::path& file, const std::string& expected) {
  const std::string text = read_whole(file.string(), expected);
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.size()));
    throw InputError(fmt::format("{}:{}: invalid JSON, expected {}", file.string(),
        1 + std::count(text.begin(), end, '\n'), expected));
  } catch (const nlohmann::json::exception& error) {  // a number that no double can represent
    throw InputError(
        fmt::format("{}: found {}, expected {}", file.string(), error.what(), expected));
  }
}

namespace detail {

/// Nothing for a list of values of several kinds.
inline std::optional<Facts::Value> fact_in(const nlohmann::json& value) {
  const auto all = [&](auto is) {
    return std::all_of(value.begin(), value.end(), std::mem_fn(is));
  };
  if (value.is_null()) return Facts::Value();
  if (value.is_boolean()) return value.get<bool>();
  if (value.is_number()) return value.get<double>();
  if (value.is_string()) return value.get<std::string>();
  if (all(&nlohmann::json::is_string)) return value.get<Facts::Texts>();
  if (all(&nlohmann::json::is_number)) return value.get<std::vector<double>>();
  return std::nullopt;
}

inline void add_facts(const nlohmann::json& group, const std::string& path, Facts& facts) {
  for (const auto& [key, value] : group.items())
    if (value.is_object())
      add_facts(value, path + key + "/", facts);
    else if (const auto fact = fact_in(value))
      facts.set(path + key, *fact);
}

}  // namespace detail

/// The fields of a result. @param source  of messages: the file
inline Facts facts_in(const nlohmann::json& root, const std::string& source) {
  Facts facts(source);
  detail::add_facts(root, "", facts);
  return facts;
}

}  // namespace edmill::io
