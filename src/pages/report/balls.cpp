// The dose of each ball.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/sections.hpp"

namespace edmill::report {

using plot::add;
using plot::readable;

namespace {

struct Ball {
  double dose_rate, area;  ///< [W], [m2]
};

std::vector<Ball> balls_of(const OutputTable& table) {
  const auto rate = table.column("dose_rate"), area = table.column("area");
  std::vector<Ball> list;
  for (const auto& row : table.rows_of("ball")) list.push_back({row[rate], row[area]});
  return list;
}

/// Balls of one diameter together, the smallest first; all of them where they have many diameters.
std::vector<std::vector<Ball>> by_size(std::vector<Ball> balls) {
  constexpr std::size_t most = 12;
  std::stable_sort(balls.begin(), balls.end(), [](const Ball& a, const Ball& b) { return a.area < b.area; });
  std::vector<std::vector<Ball>> kinds;
  for (const auto& ball : balls) {
    if (kinds.empty() || ball.area > (1 + 1e-9) * kinds.back().front().area) kinds.emplace_back();
    kinds.back().push_back(ball);
    if (kinds.size() > most) return {balls};
  }
  return kinds;
}

/// "4.76", or "2 to 3" [mm].
std::string diameters_of(const std::vector<Ball>& kind) {
  const auto text = [](const Ball& ball) {
    return plot::brief(1000 * std::sqrt(ball.area / 3.14159265358979323846), 4);
  };
  const auto least = text(kind.front()), most = text(kind.back());
  return least == most ? least : least + " to " + most;
}

void add_sizes(pugi::xml_node section, const std::vector<Ball>& balls) {
  Rows rows;
  for (const auto& kind : by_size(balls)) {
    const auto [least, most] = std::minmax_element(
        kind.begin(), kind.end(), [](const Ball& a, const Ball& b) { return a.dose_rate < b.dose_rate; });
    Ball all{0, 0};
    for (const auto& ball : kind) all.dose_rate += ball.dose_rate, all.area += ball.area;
    rows.push_back({fmt::format("{} of {} mm", kind.size(), diameters_of(kind)),
                    readable(all.dose_rate / static_cast<double>(kind.size()), 3),
                    readable(least->dose_rate, 3), readable(most->dose_rate, 3),
                    readable(all.dose_rate / all.area / 1e4, 3)});
  }
  add_table(section, "dose-of-balls", "Dose of a ball",
            {"balls", "mean [W]", "least [W]", "most [W]", "mean per area [W/cm\u00b2]"}, rows);
}

/// Whether some balls get more than others is seen where they are few enough to be told apart.
void draw_balls(pugi::xml_node section, const std::vector<Ball>& balls) {
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

void add_balls(pugi::xml_node section, const RunFolder& run) {
  const auto* output = run.output("bodies", [](const auto& o) { return o.only.empty(); });
  if (!output) return add_missing(section, "dose of each ball", "type = \"bodies\"");
  const auto table = read_table(run.file_of(*output), "a table of bodies", 1);
  if (!(table.duration() > 0))
    return add_missing(section, "time in the dose of each ball", "type = \"bodies\"");
  const auto balls = balls_of(table);
  add_sizes(section, balls);
  draw_balls(section, balls);
  add(section, "p", {{"class", "note"}},
      "Either body of an impact gets half of its dose here; the table by partner has all of the dose of the "
      "impacts with a wall.");
}

}  // namespace edmill::report
