// Tables of a run, for tests.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace edmill {

using Row = std::map<std::string, std::string>;

/// Columns by name; comment lines are skipped. None of these files has a quoted cell.
inline std::vector<Row> table(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> header;
  std::vector<Row> rows;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with('#')) continue;
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    if (line.ends_with(',')) cells.emplace_back();
    if (header.empty()) {
      header = cells;
      continue;
    }
    EXPECT_EQ(cells.size(), header.size()) << line;
    for (std::size_t k = 0; k < std::min(cells.size(), header.size()); ++k)
      rows.resize(rows.size() + (k == 0)), rows.back()[header[k]] = cells[k];
  }
  return rows;
}

inline double number(const Row& row, const std::string& column) {
  const auto found = row.find(column);
  if (found == row.end() || found->second.empty()) {
    ADD_FAILURE() << "no value in column " << column;
    return NAN;
  }
  return std::stod(found->second);
}

}  // namespace edmill
