// Texts in CSV (RFC 4180), which readers with comments (#) and with other separators read, too.
#pragma once

#include <string>

#include "base/clean_text.hpp"

namespace edmill::io {

/// A text as a cell, quoted where necessary.
inline std::string csv_cell(const std::string& text) {
  const bool blank_ends = text.starts_with(' ') || text.ends_with(' ');
  if (!blank_ends && text.find_first_of(",;\t\"#\n\r") == std::string::npos) return clean_text(text);
  std::string quoted = "\"";
  for (const char c : clean_text(text)) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace edmill::io
