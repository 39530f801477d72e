// JSON that is read.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "base/errors.hpp"
#include "io/input_file.hpp"

namespace edmill::io {

/// @param expected  what the file should be, for messages: "the summary of a run"
/// @throws InputError with file and line
inline nlohmann::json read_json(const std::filesystem::path& file, const std::string& expected) {
  const std::string text = read_whole(file.string(), expected);
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.size()));
    throw InputError(fmt::format("{}:{}: found no valid JSON, expected {}", file.string(),
                                 1 + std::count(text.begin(), end, '\n'), expected));
  } catch (const nlohmann::json::exception& error) {  // a number that no double holds
    throw InputError(fmt::format("{}: found {}, expected {}", file.string(), error.what(), expected));
  }
}

}  // namespace edmill::io
