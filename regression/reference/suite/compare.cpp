// Compares the collision log of any code with a case of the suite: `c++ -std=c++17 compare.cpp`. CC0 1.0.
// usage: compare EVENTS.csv LOG.csv COUNT TOLERANCE     (the numbers that suite.json of the case has)
// Numbers are compared relative to the largest of a column. Exit code: 0 they agree, 1 they differ, 2 a file
// cannot be read.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <vector>

using Row = std::map<std::string, std::string>;

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> list;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) list.push_back(cell);
  return list;
}

std::vector<Row> read(const char* file) {
  std::ifstream in(file);
  std::vector<std::string> header;
  std::vector<Row> rows;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    const auto row = cells(line);
    if (header.empty()) {
      header = row;
      continue;
    }
    rows.emplace_back();
    for (std::size_t k = 0; k < std::min(row.size(), header.size()); ++k) rows.back()[header[k]] = row[k];
  }
  return rows;
}

std::string bodies(Row& row) {
  auto one = row["ball"], two = row["partner"], kind = row["partner_kind"];
  return kind +
         (kind == "ball" && std::stol(one) > std::stol(two) ? " " + two + " " + one : " " + one + " " + two);
}

int main(int argc, char** argv) {
  if (argc != 5) return std::cerr << "usage: compare EVENTS.csv LOG.csv COUNT TOLERANCE\n", 2;
  auto expected = read(argv[1]), found = read(argv[2]);
  const std::size_t count = std::strtoul(argv[3], nullptr, 10);
  if (expected.size() < count || count == 0) return std::cerr << argv[1] << " has too few events\n", 2;
  if (found.size() < count)
    return std::cout << "the log has " << found.size() << " of " << count << " events\n", 1;
  std::map<std::string, double> scale;
  for (const auto& [name, cell] : expected[0])
    if (name != "index" && name != "ball" && name != "partner" && name != "partner_kind" &&
        found[0].count(name))
      for (std::size_t k = 0; k < count; ++k)
        scale[name] = std::max(scale[name], std::fabs(std::atof(expected[k][name].c_str())));
  for (std::size_t k = 0; k < count; ++k) {
    if (bodies(expected[k]) != bodies(found[k]))
      return std::cout << "event " << k << ": found " << bodies(found[k]) << ", expected "
                       << bodies(expected[k]) << "\n",
             1;
    for (const auto& [name, size] : scale) {
      const double error =
          std::fabs(std::atof(found[k][name].c_str()) - std::atof(expected[k][name].c_str()));
      if (!(error <= std::atof(argv[4]) * (size > 0 ? size : 1)))
        return std::cout << "event " << k << ": " << name << " is " << found[k][name] << ", expected "
                         << expected[k][name] << "\n",
               1;
    }
  }
  std::cout << count << " events agree\n";
}
