// Rates over time and by partner, spectra, speeds of balls, Lyapunov exponents, hits of powder.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "base/scalar.hpp"
#include "casefile/build_case.hpp"
#include "model/variables.hpp"
#include "report/sections.hpp"

namespace edmill::report {

namespace {

constexpr std::size_t most_points = 120;

void add_dose_rate(pugi::xml_node grid, const RunFolder& run) {
  const auto series = rate_of(run, "milling_dose", most_points);
  if (!series)
    return add_missing(grid, "dose rate over time",
        "type = \"trends\", columns = [{ variable = \"milling_dose\", statistics = [\"rate\"] }]");
  const auto& f = run.facts;
  auto chart = over_time(run, "dose-rate", "Milling dose rate over time", "milling dose rate [W]");
  chart.curves.push_back({"", "c0", points_of(*series)});
  if (const auto rate = rate_in(f, "milling_dose_rate"); rate && rate->half_width) {
    chart.curves[0].name =
        fmt::format("over {} s", readable(series->front().end - series->front().begin, 2));
    add_level(chart, f.number("start_time"), f.number("end_time"), *rate,
        "mean with its 95 % interval", "c1");
  }
  chart.description =
      fmt::format("Line of the milling dose rate in watts from {} s to {} s of simulated time.",
          brief(chart.x.low), brief(chart.x.high));
  draw_fitted(grid, chart);
}

void add_collision_rates(pugi::xml_node grid, const RunFolder& run) {
  auto chart = over_time(run, "collision-rates", "Collision rates over time", "collisions [1/s]");
  for (int k = 0; k < run.partners.count(); ++k)
    if (const auto series = rate_of(run, "collision", most_points, k))
      chart.curves.push_back(
          {typeset(run.partners[k].label), partner_colour(run.partners, k), points_of(*series)});
  if (chart.curves.empty())
    if (const auto all = rate_of(run, "collision", most_points))
      chart.curves.push_back({"all", "c4", points_of(*all)});
  if (chart.curves.empty())
    return add_missing(grid, "collision rates over time",
        "type = \"trends\", columns = [{ variable = \"collision\", statistics = [\"rate\"] }]");
  chart.description = "Lines of the collisions per second with each wall and between balls.";
  draw_fitted(grid, chart);
}

/// Areas of the walls by id, then of all balls together [m2].
std::vector<double> areas_of(const RunFolder& run) {
  std::vector<double> areas;
  const auto mill = casefile::build_mill<double>(run.spec);
  for (const auto& surface : mill.vessel.surfaces()) areas.push_back(surface.area());
  for (const auto& body : mill.bodies) areas.push_back(body.shape.area());
  double balls = 0;
  run.spec.for_each_ball([&](const casefile::BallSpec& ball) {
    const double d = ball.diameter.to<double>();
    balls += ball.count * numerics::pi<double>() * d * d;
  });
  areas.push_back(balls);
  return areas;
}

void add_partners(pugi::xml_node section, const RunFolder& run) {
  const auto& f = run.facts;
  const auto areas = areas_of(run);
  const auto balls = run.spec.ball_count();
  Rows rows;
  const double duration = f.number("duration"), whole_dose = f.number("milling_dose");
  const auto row = [&](const std::string& name, const std::string& key, double dose, double area) {
    const double collisions = f.number("collisions/" + key);
    const auto rate = f.find("collision_rate/" + key);
    rows.push_back({name, brief(collisions, 12), rate ? readable(*rate) : "\u2013",
        duration > 0 ? readable(dose / duration) : "\u2013",
        whole_dose > 0 ? readable(100 * dose / whole_dose, 3) : "\u2013",
        collisions > 0 ? readable(1000 * dose / collisions, 3) : "\u2013",
        duration > 0 && area > 0 ? readable(dose / duration / area / 1e4, 3) : "\u2013"});
  };
  for (int k = 0; k < run.partners.count(); ++k) {
    const auto& [key, label, meaning] = run.partners[k];
    row(typeset(label), key, f.number("milling_dose_by_partner/" + key), areas[k]);
  }
  row("all", "total", whole_dose, 0);
  add_table(section, "by-partner", "Collisions and dose by partner",
      {"with", "collisions", "[1/s]", "dose rate [W]", "share of the dose [%]", "mean dose [mJ]",
          "dose rate per area [W/cm\u00b2]"},
      rows);
  if (const auto rate = f.find("milling_dose_rate"))
    add_note(section,
        fmt::format("Area: of the wall, or of all balls. A ball (of {}) has a part in {} W on "
                    "the average: an impact between balls counts half for either, one with a "
                    "wall whole.",
            balls, readable(*rate / static_cast<double>(balls), 3)));
}

void add_cutoffs(pugi::xml_node section, const RunFolder& run) {
  const auto table = run.table("rates_above", "a table of rates above cutoffs");
  if (!table) return add_missing(section, "rates above speed cutoffs", "type = \"rates_above\"");
  std::vector<std::string> headings{"approach speed [m/s]"}, columns;
  for (int k = 0; k < run.partners.count(); ++k) {
    headings.push_back(typeset(run.partners[k].label));
    columns.push_back(run.partners[k].key + " rate");
  }
  headings.insert(headings.end(), {"all", "dose rate of all [W]"});
  columns.insert(columns.end(), {"total rate", "total dose_rate"});
  Rows rows;
  for (const auto& numbers : table->numbers) {
    auto& row = rows.emplace_back(1, brief(numbers[0]));
    for (const auto& column : columns) row.push_back(readable(numbers[table->column(column)]));
  }
  add_table(section, "above-cutoffs", "Collisions per second at or above an approach speed",
      headings, rows);
}

/// Mean, least and largest speed of the balls over time.
void add_speeds_over_time(pugi::xml_node grid, const RunFolder& run) {
  using casefile::Statistic;
  const int speed = *model::find_ball_variable("speed");
  const std::vector wanted{Statistic::average, Statistic::minimum, Statistic::maximum};
  const auto table = run.table("trends_balls", "a table of trends of balls", 0, [&](const auto& o) {
    return o.columns.size() == 1 && o.columns[0].variable == speed && !o.columns[0].with_ball &&
        o.columns[0].statistics == wanted;
  });
  if (!table)
    return add_missing(grid, "ball speeds over time",
        "type = \"trends_balls\", columns = [{ variable = \"speed\", "
        "statistics = [\"average\", \"minimum\", \"maximum\"] }]");
  const auto& rows = table->numbers;
  auto chart = over_time(run, "ball-speeds-over-time", "Ball speeds over time", "speed [m/s]");
  // Groups of five: each point covers all phases of the drive that the report's table samples.
  const std::size_t together = (rows.size() / most_points + 5) / 5 * 5;
  plot::Curve mean{"mean of all balls", "c0", {}};
  plot::Band range{"c0", {}, {}, {}};
  for (std::size_t first = 0; first < rows.size(); first += together) {
    const std::size_t last = std::min(rows.size(), first + together);
    double sum = 0, low = rows[first].at(3), high = 0;
    for (std::size_t k = first; k < last; ++k) {
      sum += rows[k].at(2);
      low = std::min(low, rows[k].at(3));
      high = std::max(high, rows[k].at(4));
    }
    const double time = (rows[first][0] + rows[last - 1][0]) / 2;
    mean.points.emplace_back(time, sum / static_cast<double>(last - first));
    range.x.push_back(time);
    range.low.push_back(low);
    range.high.push_back(high);
  }
  chart.curves.push_back(std::move(mean));
  chart.bands.push_back(std::move(range));
  chart.description =
      "Line of the balls' mean speed, within a band from the slowest to the fastest ball.";
  draw_fitted(grid, chart);
}

void add_speed_frequency(pugi::xml_node grid, const RunFolder& run) {
  const int variable = *model::find_variable("ball_speed_before");
  const auto table = run.table("frequency", "a table of frequencies", 1,
      [&](const auto& o) { return o.only.empty() && o.frequency.variable.variable == variable; });
  if (!table)
    return add_missing(grid, "distribution of ball speeds",
        "type = \"frequency\", variable = \"ball_speed_before\", low = \"0 m/s\", high = \"10 "
        "m/s\"");
  const auto lower = table->column("lower"), upper = table->column("upper");
  plot::Chart chart{"ball-speeds", "Speed of balls at their impacts",
      "Histograms of the ball's speed before an impact with a wall and with another ball.",
      {"speed before the impact [m/s]"}, {"share of impacts [1/(m/s)]"}};
  double last = 0;
  for (const auto& [name, column, colour] :
      {std::tuple{"with walls", "walls", "c2"}, std::tuple{"with balls", "ball_ball", "c3"}}) {
    const auto place = table->column(column);
    double all = 0;
    for (const auto& row : table->numbers) all += row[place];
    plot::Curve curve{name, colour, {}, true};
    for (const auto& row : table->numbers) {
      if (std::isnan(row[lower]) || std::isnan(row[upper])) continue;  // out of range
      curve.points.emplace_back(
          row[lower], all > 0 ? row[place] / all / (row[upper] - row[lower]) : 0);
      if (row[place] > 0) last = std::max(last, row[upper]);
      chart.x.low = std::min(chart.x.low, row[lower]);
      if (&row == &table->numbers.back() || std::isnan((&row)[1][upper]))
        curve.points.emplace_back(row[upper], 0);
    }
    chart.curves.push_back(std::move(curve));
  }
  chart.x.high = last > chart.x.low ? last : chart.x.low + 1;
  draw_fitted(grid, chart);
}

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

/// Shows the bins above a thousandth of the top, or on a logarithmic y axis within 5 decades of it.
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

plot::Chart over_time(const RunFolder& run, const std::string& id, const std::string& title,
    const std::string& y_title) {
  const plot::Axis x{"time [s]", run.spec.initial_time.to<double>(), run.facts.number("end_time")};
  plot::Chart chart{.id = id, .title = title, .x = x, .y = {y_title}};
  if (const double start = run.facts.number("start_time"); start > chart.x.low)
    chart.marks.push_back({start, "statistics from here"});
  return chart;
}

void draw_fitted(pugi::xml_node grid, plot::Chart chart) {
  double low = 0, high = 0;
  const auto see = [&](double y) {
    if (!std::isfinite(y)) return;
    low = std::min(low, y);
    high = std::max(high, y);
  };
  for (const auto& curve : chart.curves)
    for (const auto& [x, y] : curve.points) see(y);
  for (const auto& band : chart.bands)
    for (const double y : band.high) see(y);
  const double room = high > low ? 0.1 * (high - low) : 1;
  chart.y.low = low < 0 ? low - room : 0;
  chart.y.high = high + room;
  draw(grid, chart);
}

void add_rates(pugi::xml_node main, const RunFolder& run) {
  auto section = add_section(main, "rates", "Rates");
  auto grid = add(section, "div", {{"class", "charts"}});
  add_dose_rate(grid, run);
  add_collision_rates(grid, run);
  add_partners(section, run);
  add_cutoffs(section, run);
}

void add_ball_speeds(pugi::xml_node main, const RunFolder& run) {
  auto grid = add(add_section(main, "speeds", "Ball speeds"), "div", {{"class", "charts"}});
  add_speeds_over_time(grid, run);
  add_speed_frequency(grid, run);
}

void add_exponents(pugi::xml_node main, const RunFolder& run) {
  const auto table = run.table("lyapunov", "a table of Lyapunov exponents", 0,
      [](const auto& o) { return o.only.empty() && !o.timer.interval; });
  if (!table) return;
  Rows rows;
  for (const auto& numbers : table->numbers) {
    const auto cell = [&](const char* column, int digits) {
      return readable(numbers[table->column(column)], digits);
    };
    std::string value = cell("per_second", 4);
    if (std::isfinite(numbers[table->column("half_width")]))
      value += " \u00b1 " + cell("half_width", 2);
    rows.push_back(
        {brief(numbers[0]), value, cell("per_collision", 3), cell("digits_per_impact", 3)});
  }
  auto section = add_section(main, "errors", "How errors grow");
  add_table(section, "lyapunov-exponents", "Lyapunov exponents",
      {"exponent", "[1/s]", "per collision of a ball", "digits per impact"}, rows);
  add_note(section,
      "The distance of two motions that begin close together grows by e in 1/exponent seconds, on "
      "the average. Errors of a code, and of its rounding, grow so, too.");
}

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
