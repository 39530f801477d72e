// Texts in CSV (RFC 4180).
#pragma once

#include <string>

namespace edmill::io {

/// A text as a cell, quoted where necessary.
inline std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace edmill::io
