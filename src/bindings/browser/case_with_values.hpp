// A case file with the page's settings in it.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "base/clean_text.hpp"
#include "base/errors.hpp"
#include "casefile/section.hpp"

namespace edmill::browser {

namespace detail {

using Lines = std::vector<std::string>;

/// "vessel.piston" of a line "[[vessel.piston]]  # one"; empty for other lines.
inline std::string section_of(const std::string& line) {
  const auto text = trimmed(line);
  if (!text.starts_with('[')) return "";
  const auto begin = text.find_first_not_of('['), end = text.find(']');
  return std::string(end == text.npos || begin > end ? "" : trimmed(text.substr(begin, end - begin)));
}

inline std::string key_of(const std::string& line) {
  const auto equals = line.find('=');
  return std::string(equals == line.npos ? "" : trimmed(std::string_view(line).substr(0, equals)));
}

inline bool is_header(const std::string& line) { return !section_of(line).empty(); }

/// The lines "key = value" of a table in one line; none where the value is no table.
inline Lines lines_of_table(const std::string& value) {
  const std::string line = "value = " + value;
  Lines lines;
  const auto parsed = toml::parse(line);
  const auto* table = parsed.get("value")->as_table();
  if (!table) throw InputError("found " + value + ", expected a table");
  for (auto&& [key, node] : *table) {
    const auto& source = node.source();
    lines.push_back(
        std::string(key.str()) + " = " +
        std::string(trimmed(line.substr(source.begin.column - 1, source.end.column - source.begin.column))));
  }
  return lines;
}

/// Replaces a section and what is inside of it.
inline void put_section(Lines& lines, const std::string& name, const std::string& value) {
  const auto body = lines_of_table(value);
  bool inside = false;
  std::erase_if(lines, [&](const std::string& line) {
    if (const auto section = section_of(line); !section.empty())
      inside = section == name || section.starts_with(name + ".");
    return inside;
  });
  lines.push_back("");
  lines.push_back("[" + name + "]");
  lines.insert(lines.end(), body.begin(), body.end());
}

inline void put_value(Lines& lines, const std::string& path, const std::string& value) {
  const auto last = path.rfind('.');
  std::string section;
  std::size_t entry = 0;
  for (const auto& part : casefile::parts_of(path.substr(0, last))) {
    if (part.find_first_not_of("0123456789") == std::string::npos)
      entry = std::stoul(part);
    else
      section += (section.empty() ? "" : ".") + part;
  }
  const std::string key = path.substr(last + 1), line = key + " = " + value;
  auto header = lines.begin();
  for (std::size_t seen = 0;; ++header) {
    header = std::find_if(header, lines.end(), [&](const auto& l) { return section_of(l) == section; });
    if (header == lines.end() || seen++ == entry) break;
  }
  if (header == lines.end()) {
    lines.insert(lines.end(), {"", "[" + section + "]", line});
    return;
  }
  const auto end = std::find_if(header + 1, lines.end(), is_header);
  const auto found = std::find_if(header + 1, end, [&](const auto& l) { return key_of(l) == key; });
  if (found != end)
    *found = line;
  else
    lines.insert(header + 1, line);
}

}  // namespace detail

/// The text of a case whose values are those of its settings, so that it is the same case without them. Where
/// that cannot be done line by line, settings follow as comments.
/// @param log  whether an output "collisions" is added unless the case has one
inline std::string text_with_values(const casefile::CaseSpec& spec, bool log) try {
  detail::Lines lines;
  std::istringstream in(spec.text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  for (const auto& setting : spec.settings) {
    const auto equals = setting.find('=');
    const auto key = setting.substr(0, equals), value = setting.substr(equals + 1);
    if (key.find('.') == std::string::npos)
      detail::put_section(lines, key, value);
    else
      detail::put_value(lines, key, value);
  }
  const auto joined = [&] { return fmt::format("{}\n", fmt::join(lines, "\n")); };
  const auto same = casefile::parse_case(joined(), spec.file);
  if (same.digest != spec.digest) return casefile::text_with_settings(spec);
  const auto is_log = [](const auto& output) { return output.type == "collisions"; };
  if (log && std::none_of(same.outputs.begin(), same.outputs.end(), is_log))
    lines.insert(lines.end(), {"", "[[output]]", "type = \"collisions\""});
  return joined();
} catch (const std::exception&) {
  return casefile::text_with_settings(spec);
}

}  // namespace edmill::browser
