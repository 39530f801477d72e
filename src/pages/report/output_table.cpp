// Tables of outputs.
#include <cstdio>
#include <fstream>
#include <limits>

#include "base/errors.hpp"
#include "io/csv_reader.hpp"
#include "report/series.hpp"

namespace edmill::report {

namespace {

/// "# from 0.5 s to 10 s: ..." in the first line.
void read_times(OutputTable& table) {
  std::ifstream in(table.file);
  std::string line;
  double from = 0, until = 0;
  if (std::getline(in, line) && std::sscanf(line.c_str(), "# from %lf s to %lf s", &from, &until) == 2)
    table.from = from, table.until = until;
}

}  // namespace

std::size_t OutputTable::column(std::string_view name) const {
  const std::size_t text_columns = texts.empty() ? 0 : texts.front().size();
  for (std::size_t k = text_columns; k < header.size(); ++k)
    if (header[k] == name || header[k].starts_with(std::string(name) + " [")) return k - text_columns;
  throw InputError(file + ": found no column '" + std::string(name) + "', expected it in the header");
}

std::vector<std::vector<double>> OutputTable::rows_of(std::string_view text) const {
  std::vector<std::vector<double>> rows;
  for (std::size_t k = 0; k < numbers.size(); ++k)
    if (texts[k].front() == text) rows.push_back(numbers[k]);
  return rows;
}

OutputTable read_table(const std::filesystem::path& file, const std::string& expected, std::size_t texts) {
  io::CsvReader reader(file, expected);
  OutputTable table;
  table.file = file.string();
  table.header = reader.header();
  read_times(table);
  if (table.header.size() <= texts) reader.bad_line("found too few columns, expected " + expected);
  while (reader.next_row()) {
    std::vector<std::string> words;
    std::vector<double> row;
    for (std::size_t k = 0; k < table.header.size(); ++k) {
      if (k < texts)
        words.emplace_back(reader.field(k));
      else if (reader.field(k).empty())
        row.push_back(std::numeric_limits<double>::quiet_NaN());
      else
        row.push_back(reader.number(k).value_or(0));
    }
    table.texts.push_back(std::move(words));
    table.numbers.push_back(std::move(row));
  }
  reader.throw_problems();
  return table;
}

}  // namespace edmill::report
