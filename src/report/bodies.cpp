// The dose of each ball and of each wall.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "casefile/build_case.hpp"
#include "report/sections.hpp"

namespace edmill::report {

using plot::add;
using plot::readable;

namespace {

/// A row of the table of bodies.
struct Body {
  double dose_rate, area;  ///< [W], [m2]

  std::string per_area() const { return area > 0 ? readable(dose_rate / area / 1000, 3) : "\u2013"; }
};

std::vector<Body> bodies_of(const OutputTable& table, std::string_view kind) {
  const auto rate = table.column("dose_rate"), area = table.column("area");
  std::vector<Body> list;
  for (const auto& row : table.rows_of(kind)) list.push_back({row[rate], row[area]});
  return list;
}

/// Balls of one diameter together, in the order of their numbers.
std::vector<std::vector<Body>> by_size(const std::vector<Body>& balls) {
  std::vector<std::vector<Body>> kinds;
  for (const auto& ball : balls) {
    const auto same = [&](const auto& kind) {
      return std::abs(kind.front().area - ball.area) < 1e-9 * ball.area;
    };
    const auto kind = std::find_if(kinds.begin(), kinds.end(), same);
    if (kind == kinds.end())
      kinds.push_back({ball});
    else
      kind->push_back(ball);
  }
  return kinds;
}

void add_balls(pugi::xml_node section, const std::vector<Body>& balls) {
  Rows rows;
  for (const auto& kind : by_size(balls)) {
    const double diameter = std::sqrt(kind.front().area / 3.14159265358979323846);
    const auto [least, most] = std::minmax_element(
        kind.begin(), kind.end(), [](const Body& a, const Body& b) { return a.dose_rate < b.dose_rate; });
    const double mean = std::accumulate(kind.begin(), kind.end(), 0.0,
                                        [](double sum, const Body& b) { return sum + b.dose_rate; }) /
                        static_cast<double>(kind.size());
    rows.push_back({fmt::format("{} of {} mm", kind.size(), plot::brief(1000 * diameter, 4)),
                    readable(mean, 3), readable(least->dose_rate, 3), readable(most->dose_rate, 3),
                    Body{mean, kind.front().area}.per_area()});
  }
  add_table(section, "dose-of-balls", "Dose of a ball",
            {"balls", "mean [W]", "least [W]", "most [W]", "mean per area [kW/m\u00b2]"}, rows);
}

void add_walls(pugi::xml_node section, const RunFolder& run, const std::vector<Body>& walls) {
  const auto infos = casefile::build_mill<double>(run.spec).vessel.walls();
  Rows rows;
  for (std::size_t k = 0; k < std::min(walls.size(), infos.size()); ++k) {
    if (!(walls[k].area > 0)) continue;
    rows.push_back({infos[k].meaning, readable(walls[k].dose_rate, 3), readable(1e4 * walls[k].area, 3),
                    walls[k].per_area()});
  }
  add_table(section, "dose-of-walls", "Dose of a wall",
            {"wall", "dose rate [W]", "area [cm\u00b2]", "per area [kW/m\u00b2]"}, rows);
}

/// Whether some balls get more than others is seen where they are few enough to be told apart.
void draw_balls(pugi::xml_node section, const std::vector<Body>& balls) {
  constexpr std::size_t most = 400;
  if (balls.size() < 2 || balls.size() > most) return;
  plot::Chart chart;
  chart.id = "dose-by-ball", chart.title = "Dose rate of each ball";
  chart.description = "A bar for each ball: its half of the dose rate of its impacts.";
  chart.x = {"number of the ball", 0, static_cast<double>(balls.size()), false};
  chart.y.title = "dose rate [W]";
  plot::Curve curve{"", "c0", {}, true};
  for (std::size_t k = 0; k < balls.size(); ++k)
    curve.points.emplace_back(static_cast<double>(k), balls[k].dose_rate);
  curve.points.emplace_back(chart.x.high, 0);
  chart.curves.push_back(std::move(curve));
  fit_heights(chart);
  draw(add(section, "div", {{"class", "charts"}}), chart);
}

}  // namespace

void add_bodies(pugi::xml_node section, const RunFolder& run) {
  const auto* output = run.output("bodies", [](const auto& o) { return o.only.empty(); });
  if (!output) return add_missing(section, "dose of balls and walls", "type = \"bodies\"");
  const auto table = read_table(run.file_of(*output), "a table of bodies", 1);
  if (!(table.duration() > 0))
    return add_missing(section, "time in the dose of balls and walls", "type = \"bodies\"");
  const auto balls = bodies_of(table, "ball");
  add_balls(section, balls);
  add_walls(section, run, bodies_of(table, "wall"));
  draw_balls(section, balls);
  add(section, "p", {{"class", "note"}}, "Either body of an impact gets half of its dose.");
}

}  // namespace edmill::report
