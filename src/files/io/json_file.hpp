// Reads JSON files.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
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
    throw InputError(fmt::format("{}: found {}, expected {}", file.string(), error.what(), expected));
  }
}

namespace detail {

inline void add_facts(const nlohmann::json& group, const std::string& path, Facts& facts) {
  const auto all = [](const nlohmann::json& list, auto is) {
    return std::all_of(list.begin(), list.end(), is);
  };
  for (const auto& [key, value] : group.items()) {
    if (value.is_object())
      add_facts(value, path + key + "/", facts);
    else if (value.is_null())
      facts.set(path + key, {});
    else if (value.is_boolean())
      facts.set(path + key, value.get<bool>());
    else if (value.is_number())
      facts.set(path + key, value.get<double>());
    else if (value.is_string())
      facts.set(path + key, value.get<std::string>());
    else if (all(value, [](const auto& item) { return item.is_string(); }))
      facts.set(path + key, value.get<Facts::Texts>());
    else if (all(value, [](const auto& item) { return item.is_number(); }))
      facts.set(path + key, value.get<std::vector<double>>());
  }
}

}  // namespace detail

/// The fields of a result. @param source  of messages: the file
inline Facts facts_in(const nlohmann::json& root, const std::string& source) {
  Facts facts(source);
  detail::add_facts(root, "", facts);
  return facts;
}

}  // namespace edmill::io
