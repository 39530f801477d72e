// Compares the collision log of any code with a case of the suite: `c++ -std=c++17 compare.cpp`.
// CC0 1.0.
//
// usage: compare EVENTS.csv LOG.csv COUNT TOLERANCE    (COUNT, TOLERANCE: suite.json of the case)
//
// Numbers are compared relative to the largest of a column. Exit code: 0 they agree, 1 they differ,
// 2 a file cannot be read.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <set>
#include <sstream>
#include <vector>

using Row = std::map<std::string, std::string>;

std::vector<Row> read(const char* file) {
  std::ifstream in(file);
  std::vector<std::string> header;
  std::vector<Row> rows;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::vector<std::string> cells;
    std::istringstream text(line);
    for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
    if (!header.empty()) rows.emplace_back();
    for (std::size_t k = 0; k < std::min(cells.size(), header.size()); ++k)
      rows.back()[header[k]] = cells[k];
    if (header.empty()) header = cells;
  }
  return rows;
}

double number(Row& row, const std::string& name) {  // nan agrees with nothing
  return row[name].find_first_of("0123456789") < row[name].size() ? std::atof(row[name].c_str())
                                                                  : NAN;
}

std::string bodies(Row& row) {
  auto one = row["ball"], two = row["partner"], kind = row["partner_kind"];
  if (kind == "ball" && number(row, "ball") > number(row, "partner")) std::swap(one, two);
  return kind + " " + one + " " + two;
}

int main(int argc, char** argv) {
  if (argc != 5) return std::cerr << "usage: compare EVENTS.csv LOG.csv COUNT TOLERANCE\n", 2;
  auto expected = read(argv[1]), found = read(argv[2]);
  const std::size_t count = std::strtoul(argv[3], nullptr, 10);
  if (expected.size() < count || count == 0)
    return std::cerr << argv[1] << " has too few events\n", 2;
  for (const char* name : {"time", "ball", "partner_kind", "partner"})
    if (!found.empty() && !found[0].count(name))
      return std::cerr << argv[2] << " has no column " << name << "\n", 2;
  if (found.size() < count)
    return std::cout << "the log ends after " << found.size() << " events\n", 1;
  const std::set<std::string> whole{"index", "ball", "partner", "partner_kind"};
  std::map<std::string, double> scale;  // the largest of each column that both have
  for (const auto& [name, cell] : expected[0])
    for (std::size_t k = 0; k < count && found[0].count(name) && !whole.count(name); ++k)
      scale[name] = std::max(scale[name], std::fabs(number(expected[k], name)));
  for (std::size_t k = 0; k < count; ++k) {
    std::string is = bodies(found[k]), should = bodies(expected[k]);
    for (const auto& [name, size] : scale)
      if (is == should &&
          !(std::fabs(number(found[k], name) - number(expected[k], name)) <=
              std::atof(argv[4]) * (size > 0 ? size : 1)))
        is = name + " " + found[k][name], should = name + " " + expected[k][name];
    if (is != should)
      return std::cout << "event " << k << ": " << is << ", expected " << should << "\n", 1;
  }
  std::cout << count << " events agree\n";
}
