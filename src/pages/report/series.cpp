#include "report/series.hpp"

#include <algorithm>

namespace edmill::report {

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
