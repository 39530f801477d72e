// Impact speeds, and the energies at which dissipation takes place.
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "report/sections.hpp"

namespace edmill::report {

namespace {

/// One column of one spectrum per second, as density over the decades of its bins.
plot::Points density(
    const OutputTable& table, const std::string& spectrum, const std::string& column) {
  const auto place = table.column(column);
  const double scale = 1 / table.duration;
  plot::Points points;
  double end = 0;
  for (const auto& row : table.rows_of(spectrum)) {
    const double low = row[0], high = row[1];
    if (std::isnan(low) || std::isnan(high)) continue;  // below or above all bins
    points.emplace_back(low, scale * row[place] / std::log10(high / low));
    end = high;
  }
  if (!points.empty()) points.emplace_back(end, 0);
  return points;
}

/// Shows the bins with a visible value: on a linear y axis a thousandth of the top, on a
/// logarithmic one within 5 decades of it.
void fit(plot::Chart& chart) {
  double first = 0, last = 0, top = 0, least = std::numeric_limits<double>::infinity();
  for (const auto& curve : chart.curves)
    for (const auto& [x, y] : curve.points) {
      top = std::max(top, y);
      if (y > 0) least = std::min(least, y);
    }
  for (const auto& curve : chart.curves)
    for (std::size_t k = 0; k + 1 < curve.points.size(); ++k) {
      const auto [x, y] = curve.points[k];
      if (!(y > (chart.y.logarithmic ? 0 : 1e-3 * top))) continue;
      first = first == 0 ? x : std::min(first, x);
      last = std::max(last, curve.points[k + 1].first);
    }
  chart.x.logarithmic = true;
  chart.x.low = first > 0 ? first : 0.1;
  chart.x.high = last > chart.x.low ? last : 10 * chart.x.low;
  if (!chart.y.logarithmic) {
    chart.y.low = 0;
    chart.y.high = top > 0 ? 1.06 * top : 1;
    return;
  }
  chart.y.high = top > 0 ? 2 * top : 10;
  chart.y.low = std::max(std::min(least, chart.y.high) / 2, chart.y.high / 1e5);
}

std::optional<OutputTable> spectra_of(
    const RunFolder& run, const std::string& of, const char* first) {
  std::optional<OutputTable> found;
  run.output("spectra", [&](const casefile::OutputSpec& o) {
    if (!o.only.empty()) return false;
    OutputTable table = read_table(run.file_of(o), "a table of spectra of " + of, 2);
    if (table.numbers.empty() || table.texts[0][0] != first || !(table.duration > 0)) return false;
    found = std::move(table);
    return true;
  });
  return found;
}

/// @param whose  "of each run"
plot::Chart energy_chart(const std::string& whose) {
  return {"energy-spectrum", "Dose by the energy of the impact",
      "Histograms on a logarithmic scale of impact energy: dose rate per decade " + whose + ".",
      {"energy that the impact dissipates [J]"}, {"dose rate [W per decade]"}};
}

/// @param spectrum  "approach" or "slip"
plot::Chart speed_chart(const std::string& spectrum, const std::string& whose) {
  return {spectrum + "-speeds", "Impacts by " + spectrum + " speed",
      "Histograms on logarithmic scales: impacts per second and decade " + whose + ".",
      {spectrum + " speed [m/s]"}, {.title = "impacts [1/s per decade]", .logarithmic = true}};
}

/// @param quantity  "energy" or "impacts"
void draw_partners(pugi::xml_node grid, plot::Chart chart, const OutputTable& table,
    const std::string& spectrum, const std::string& quantity, const model::Partners& partners) {
  for (int k = 0; k < partners.count(); ++k)
    chart.curves.push_back({typeset(partners[k].label), partner_colour(partners, k),
        density(table, spectrum, partners[k].key + " " + quantity), true});
  fit(chart);
  draw(grid, chart);
}

void add_energies(pugi::xml_node grid, const OutputTable& table, const model::Partners& partners) {
  draw_partners(
      grid, energy_chart("with each wall and between balls"), table, "total", "energy", partners);
  plot::Chart by_direction{"energy-parts", "Normal and tangential dose",
      "Histograms of dose rate per decade: the normal part, the tangential part and both, each by "
      "its own size.",
      {"that part of the impact's energy [J]"}, {"dose rate [W per decade]"}};
  for (const auto& [spectrum, colour] :
      {std::pair{"normal", "c0"}, std::pair{"tangential", "c1"}, std::pair{"total", "c4"}})
    by_direction.curves.push_back(
        {spectrum, colour, density(table, spectrum, "total energy"), true});
  fit(by_direction);
  draw(grid, by_direction);
}

void add_speeds(pugi::xml_node grid, const OutputTable& table, const model::Partners& partners) {
  for (const std::string spectrum : {"approach", "slip"})
    draw_partners(grid,
        speed_chart(spectrum, "of " + spectrum + " speed, with each wall and between balls"), table,
        spectrum, "impacts", partners);
}

}  // namespace

void add_spectra(pugi::xml_node main, const RunFolder& run) {
  auto grid = add(add_section(main, "spectra", "Impact spectra"), "div", {{"class", "charts"}});
  if (const auto table = spectra_of(run, "speed", "approach"))
    add_speeds(grid, *table, run.partners);
  else
    add_missing(grid, "spectra of impact speed", "type = \"spectra\", of = \"speed\"");
  if (const auto table = spectra_of(run, "energy", "normal"))
    add_energies(grid, *table, run.partners);
  else
    add_missing(grid, "spectra of impact energy", "type = \"spectra\"");
}

void add_treatment(pugi::xml_node main, const RunFolder& run) {
  const auto table = run.table("treatment", "a table of treatment", 1);
  if (!table) return;
  plot::Chart chart{"treatment-hits", "How often powder has been hit",
      "Histograms of the part of the powder that was hit so many times: mixed, and in place.",
      {"hits", 0, static_cast<double>(table->numbers.size())}, {"part of the powder"}};
  for (const auto& [name, column, colour] : {std::tuple{"mixed between impacts", "mixed", "c0"},
           std::tuple{"stays in place", "in_place", "c1"}}) {
    std::vector<double> parts;
    for (const auto& row : table->numbers) parts.push_back(row[table->column(column)]);
    chart.curves.push_back(bars(name, colour, 0, 1, parts));
  }
  auto section = add_section(main, "treatment", "How evenly the powder is treated");
  draw_fitted(add(section, "div", {{"class", "charts"}}), chart);
  add_note(section,
      "The last bar is of all that was hit more often. The counts and what an impact works are "
      "those of the output (type = \"treatment\").");
}

void add_spectra_of(pugi::xml_node main, const std::vector<RunFolder>& runs) {
  auto energies = energy_chart("of each run"), speeds = speed_chart("approach", "of each run");
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const auto put = [&](plot::Chart& chart, const std::optional<OutputTable>& table,
                         const char* spectrum, const char* column) {
      if (table)
        chart.curves.push_back(
            {runs[k].name, run_colour(k), density(*table, spectrum, column), true});
    };
    put(energies, spectra_of(runs[k], "energy", "normal"), "total", "total energy");
    put(speeds, spectra_of(runs[k], "speed", "approach"), "approach", "total impacts");
  }
  auto section = add_section(main, "spectra", "Impact spectra");
  auto grid = add(section, "div", {{"class", "charts"}});
  for (auto* chart : {&energies, &speeds}) {
    if (!chart->curves.empty()) {
      fit(*chart);
      draw(grid, *chart);
    }
    if (chart->curves.size() < runs.size())
      add(section, "p", {{"class", "missing"}},
          chart->title + ": runs without --report have no such table and are left out.");
  }
}

}  // namespace edmill::report
