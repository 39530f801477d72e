// How errors grow: Lyapunov exponents of the run, and those of its intervals.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/sections.hpp"

namespace edmill::report {

using plot::add;
using plot::readable;

namespace {

const casefile::OutputSpec* exponents_of(const RunFolder& run, bool finite_time) {
  return run.output("lyapunov", [&](const auto& o) {
    return o.only.empty() && o.timer.interval.has_value() == finite_time;
  });
}

void add_spectrum(pugi::xml_node section, const OutputTable& table) {
  Rows rows;
  const auto rate = table.column("per_second"), width = table.column("half_width"),
             collision = table.column("per_collision"), digits = table.column("digits_per_impact");
  for (const auto& numbers : table.numbers) {
    std::string value = readable(numbers[rate]);
    if (std::isfinite(numbers[width])) value += " \u00b1 " + readable(numbers[width], 2);
    rows.push_back(
        {plot::brief(numbers[0]), value, readable(numbers[collision], 3), readable(numbers[digits], 3)});
  }
  add_table(section, "lyapunov-exponents", "Lyapunov exponents",
            {"exponent", "[1/s]", "per collision of a ball", "digits per impact"}, rows);
}

/// Three exponents at most.
void add_over_time(pugi::xml_node grid, const RunFolder& run, const casefile::OutputSpec& output,
                   const std::vector<std::vector<double>>& rows) {
  constexpr std::size_t most = 3;
  auto chart = over_time(run, "exponents-over-time", "Finite-time Lyapunov exponents over time",
                         "growth over an interval [1/s]");
  chart.description = "Lines of the growth of the distance to motions nearby in each interval.";
  double start = chart.x.low;
  if (output.timer.start_time) start = std::max(start, output.timer.start_time->to<double>());
  for (std::size_t k = 1; k < rows[0].size() && k <= most; ++k) {
    plot::Curve curve{fmt::format("exponent {}", k), fmt::format("c{}", k - 1), {}, false};
    double begin = start;
    for (const auto& row : rows) {
      curve.points.emplace_back((begin + row[0]) / 2, row[k]);
      begin = row[0];
    }
    chart.curves.push_back(std::move(curve));
  }
  fit_heights(chart);
  draw(grid, chart);
}

/// How often the largest exponent has which value.
void add_histogram(pugi::xml_node grid, const std::vector<std::vector<double>>& rows) {
  std::vector<double> largest;
  for (const auto& row : rows)
    if (std::isfinite(row[1])) largest.push_back(row[1]);
  if (largest.size() < 2) return;
  const auto [low, high] = std::minmax_element(largest.begin(), largest.end());
  const std::size_t bins = std::clamp<std::size_t>(largest.size() / 10, 5, 40);
  const double width = *high > *low ? (*high - *low) / static_cast<double>(bins) : 1;
  std::vector<double> counts(bins);
  for (const double x : largest) ++counts[std::min(bins - 1, static_cast<std::size_t>((x - *low) / width))];
  plot::Chart histogram;
  histogram.id = "exponents-histogram", histogram.title = "Values of the largest finite-time exponent";
  histogram.description = "Histogram of the largest finite-time exponent over the intervals.";
  histogram.x = {"growth over an interval [1/s]", *low, *low + width * static_cast<double>(bins), false};
  histogram.y.title = "share of the intervals";
  for (double& count : counts) count /= static_cast<double>(largest.size());
  histogram.curves.push_back(bars("", "c0", *low, width, counts));
  fit_heights(histogram);
  draw(grid, histogram);
}

}  // namespace

void add_exponents(pugi::xml_node main, const RunFolder& run) {
  const auto* spectrum = exponents_of(run, false);
  const auto* finite_time = exponents_of(run, true);
  if (!spectrum && !finite_time) return;
  auto section = add_section(main, "errors", "How errors grow");
  if (spectrum) add_spectrum(section, read_table(run.file_of(*spectrum), "a table of Lyapunov exponents"));
  if (finite_time) {
    const auto table = read_table(run.file_of(*finite_time), "a table of finite-time exponents");
    if (!table.numbers.empty()) {
      auto grid = add(section, "div", {{"class", "charts"}});
      add_over_time(grid, run, *finite_time, table.numbers);
      add_histogram(grid, table.numbers);
    }
  }
  add(section, "p", {{"class", "note"}},
      "The distance of two motions that begin close together grows by e in 1/exponent seconds, on the "
      "average. Errors of a code, and of its rounding, grow so, too.");
}

}  // namespace edmill::report
