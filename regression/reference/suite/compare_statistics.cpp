// Compares the statistics of any code with a case: `c++ -std=c++17 compare_statistics.cpp`. (CC0)
//
// usage: compare_statistics STATISTICS.csv FOUND.csv [FACTOR]
//
// FOUND has the header name,value[,uncertainty]; uncertainties are standard ones, of the mean. A
// value agrees if it differs by no more than the tolerance of the case and FACTOR (default: 3)
// combined standard uncertainties. Exit code: 0 all agree, 1 one differs, 2 bad file.
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
    for (std::size_t k = 0; k < std::min(row.size(), header.size()); ++k)
      rows.back()[header[k]] = row[k];
  }
  return rows;
}

double number(Row& row, const char* name) { return std::atof(row[name].c_str()); }

int main(int argc, char** argv) {
  if (argc != 3 && argc != 4)
    return std::cerr << "usage: compare_statistics STATISTICS.csv FOUND.csv [FACTOR]\n", 2;
  const double factor = argc == 4 ? std::atof(argv[3]) : 3;
  auto expected = read(argv[1]), found = read(argv[2]);
  if (found.empty()) return std::cerr << argv[2] << " has no values\n", 2;
  std::size_t differ = 0;
  for (auto& row : found) {
    const auto want = std::find_if(
        expected.begin(), expected.end(), [&](Row& r) { return r["name"] == row["name"]; });
    if (want == expected.end()) return std::cerr << argv[1] << " has no " << row["name"] << "\n", 2;
    const double off = number(row, "value") - number(*want, "value");
    const double combined =
        std::hypot(number(row, "uncertainty"), number(*want, "standard_uncertainty"));
    const bool agrees = std::fabs(off) <= number(*want, "tolerance") + factor * combined;
    differ += !agrees;
    std::cout << (agrees ? "agrees  " : "DIFFERS ") << row["name"] << ": " << row["value"]
              << ", expected " << (*want)["value"] << ", off by " << off
              << ", combined uncertainty " << combined << "\n";
  }
  std::cout << found.size() - differ << " of " << found.size() << " agree\n";
  return differ > 0;
}
