#include "report/series.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <limits>

#include "base/errors.hpp"
#include "io/csv_reader.hpp"

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

std::optional<Series> series_of(const casefile::OutputSpec& output, const OutputTable& table, int variable,
                                double start) {
  std::size_t place = 1;  // after the time
  for (const auto& column : output.columns)
    for (const auto statistic : column.statistics) {
      if (column.variable != variable || statistic != casefile::Statistic::rate) {
        ++place;
        continue;
      }
      Series series;
      double begin = start;
      if (output.timer.start_time) begin = std::max(begin, output.timer.start_time->to<double>());
      for (const auto& row : table.numbers) {
        series.begin.push_back(begin);
        series.end.push_back(begin = row.at(0));
        series.rate.push_back(row.at(place));
      }
      return series;
    }
  return std::nullopt;
}

Series whole(Series s) {
  if (s.rate.size() > 1 && s.end.back() - s.begin.back() < (1 - 1e-6) * (s.end.front() - s.begin.front()))
    s.begin.pop_back(), s.end.pop_back(), s.rate.pop_back();
  return s;
}

Series coarser(const Series& series, std::size_t most) {
  const std::size_t count = series.rate.size(), together = (count + most - 1) / most;
  Series result;
  for (std::size_t first = 0; first < count; first += together) {
    const std::size_t last = std::min(count, first + together) - 1;
    double amount = 0;
    for (std::size_t k = first; k <= last; ++k) amount += series.rate[k] * (series.end[k] - series.begin[k]);
    result.begin.push_back(series.begin[first]);
    result.end.push_back(series.end[last]);
    result.rate.push_back(amount / (series.end[last] - series.begin[first]));
  }
  return result;
}

plot::Points points_of(const Series& series) {
  plot::Points points;
  for (std::size_t k = 0; k < series.rate.size(); ++k)
    points.emplace_back((series.begin[k] + series.end[k]) / 2, series.rate[k]);
  return points;
}

}  // namespace edmill::report
