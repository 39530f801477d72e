// Distribution of the dose over the vessel and the balls.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <variant>

#include "casefile/build_case.hpp"
#include "report/sections.hpp"

namespace edmill::report {

namespace {

using Surface = model::WallSurface<double>;
using model::Coordinate;

/// A wall and the map of the dose rate on it [kW/m2].
struct WallMap {
  std::size_t id;
  Surface surface;
  model::WallInfo info;
  plot::HeatMap map{};

  bool has(Coordinate c) const { return std::ranges::count(surface.coordinates(), c) > 0; }
  /// The ends of the wall along an axis of the map; its own coordinate may run the other way.
  std::pair<double, double> ends(int axis) const {
    return std::minmax(
        scale(axis) * surface.edge(axis, 0, 1), scale(axis) * surface.edge(axis, 1, 1));
  }
  /// Factor from a coordinate of the table to the map's: degrees and millimetres; 1 for a disc.
  double scale(int axis) const {
    if (map.disc) return 1;
    const bool angle = surface.coordinates()[axis] == Coordinate::angle;
    return angle ? 180 / std::numbers::pi : 1000;
  }
};

std::string axis_title(const Surface& surface, int axis) {
  const auto coordinate = surface.coordinates()[axis];
  if (coordinate == Coordinate::angle) return "angle about the vessel\u2019s axis [\u00b0]";
  if (coordinate == Coordinate::height) return "height along the axis [mm]";
  if (const auto* rectangle = std::get_if<model::Rectangle<double>>(&surface.kind())) {
    const auto& half = rectangle->halves[axis];
    for (int k = 0; k < 3; ++k)
      if (half[k] == norm<double>(half)) return fmt::format("along {} [mm]", "xyz"[k]);
  }
  return axis == 0 ? "along the first edge [mm]" : "along the second edge [mm]";
}

void label(WallMap& wall) {
  auto& map = wall.map;
  const std::string name = capitalised(typeset(wall.info.label));
  map.value = "dose rate [kW/m\u00b2]";
  map.highest = 0;
  map.disc = wall.has(Coordinate::radius);
  const auto [left, right] = wall.ends(0);
  const auto [bottom, top] = wall.ends(1);
  map.x = {axis_title(wall.surface, 0), left, right};
  map.y = {axis_title(wall.surface, 1), bottom, top};
  if (map.disc) {
    map.id = fmt::format("cap-{}", wall.id);
    map.title = fmt::format("{}, {} mm across", name, brief(2000 * top));
    map.x.title = "angle about the vessel\u2019s axis";
  } else if (wall.has(Coordinate::angle)) {
    map.id = wall.info.label == "cylinder" ? wall.info.label : fmt::format("wall-{}", wall.id);
    map.title = name + ", unrolled";
    map.x_step = 90;
  } else {
    map.id = fmt::format("wall-{}", wall.id);
    map.title =
        fmt::format("{}, {} mm \u00d7 {} mm", name, brief(right - left), brief(top - bottom));
  }
}

void read_cells(std::vector<WallMap>& walls, const OutputTable& table) {
  const auto wall_id = table.column("wall"), density = table.column("dose_per_area");
  for (auto& wall : walls) {
    const auto column = [&](std::size_t axis, const std::string& end) {
      return table.column(model::info_of(wall.surface.coordinates()[axis]).name + end);
    };
    const std::array columns{
        column(0, "_low"), column(0, "_high"), column(1, "_low"), column(1, "_high")};
    for (const auto& row : table.numbers) {
      if (row[wall_id] != static_cast<double>(wall.id)) continue;
      const double value = row[density] / table.duration / 1000;  // kW/m2
      const double x = wall.scale(0), y = wall.scale(1);
      wall.map.cells.push_back({row[columns[0]] * x, row[columns[1]] * x, row[columns[2]] * y,
          row[columns[3]] * y, value});
      wall.map.highest = std::max(wall.map.highest, value);
    }
  }
}

/// Gives walls of one kind a common scale. @return a note about it for the reader
std::string share_scales(std::vector<WallMap>& walls) {
  std::map<std::string, std::vector<WallMap*>> kinds;
  for (auto& wall : walls) kinds[wall.surface.name()].push_back(&wall);
  std::string note;
  for (const auto& [name, list] : kinds) {
    double highest = 0;
    for (const auto* wall : list) highest = std::max(highest, wall->map.highest);
    for (auto* wall : list) wall->map.highest = highest > 0 ? highest : 1;
    if (list.size() > 1) note += fmt::format(" The {} share a scale.", name);
  }
  return note;
}

void add_maps(pugi::xml_node section, const RunFolder& run) {
  const auto table = run.table("coverage", "a table of coverage");
  if (!table || !(table->duration > 0))
    return add_missing(section,
        table ? "time in the coverage of the vessel" : "dose on the vessel's walls",
        "type = \"coverage\"");
  const auto vessel = casefile::build_mill<double>(run.spec).vessel;
  const auto surfaces = vessel.surfaces();
  const double extent = vessel.extent();
  std::vector<WallMap> walls;
  for (std::size_t id = 0; id < surfaces.size(); ++id) {
    // A capsule as high as it is wide has nothing left of the cylinder.
    if (surfaces[id].area() < 1e-9 * extent * extent) continue;
    walls.push_back({id, surfaces[id], vessel.walls()[id]});
    label(walls.back());
  }
  read_cells(walls, *table);
  const std::string shared = share_scales(walls);
  std::ranges::stable_partition(walls, [](const WallMap& wall) { return !wall.map.disc; });
  const auto discs =
      std::ranges::count_if(walls, [](const WallMap& wall) { return wall.map.disc; });
  const bool can = discs == 2 && walls.size() == 3;  // a cylinder's two caps are drawn beside it
  auto grid = add(section, "div", {{"class", can ? "charts maps" : "charts"}});
  bool angles = false;
  for (auto& [id, surface, info, map] : walls) {
    map.description =
        fmt::format("Map of the dose rate per area on {}, up to {} kW per square metre.",
            info.meaning, readable(map.highest, 3));
    draw(grid, map);
    angles = angles || surface.coordinates()[0] == Coordinate::angle;
  }
  add_note(section,
      (!angles ? ""
              : casefile::name_of(run.spec.mill).starts_with("spex")
              ? "Angles are measured from the direction along the arm, away from the fulcrum. "
              : "Angles are measured about the vessel\u2019s y axis, from x to z. ") +
          ("Cells of one wall have equal areas." + shared));
}

struct Ball {
  double dose_rate, area;  ///< [W], [m2]
};

/// Groups of equal balls, the smallest first; if there are many diameters, one group of all.
std::vector<std::vector<Ball>> by_size(std::vector<Ball> balls) {
  constexpr std::size_t most = 12;
  std::ranges::stable_sort(balls, {}, &Ball::area);
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
    return brief(1000 * std::sqrt(ball.area / std::numbers::pi), 4);
  };
  const auto least = text(kind.front()), most = text(kind.back());
  return least == most ? least : least + " to " + most;
}

void add_sizes(pugi::xml_node section, const std::vector<Ball>& balls) {
  Rows rows;
  for (const auto& kind : by_size(balls)) {
    const auto [least, most] = std::ranges::minmax_element(kind, {}, &Ball::dose_rate);
    Ball all{0, 0};
    for (const auto& ball : kind) {
      all.dose_rate += ball.dose_rate;
      all.area += ball.area;
    }
    rows.push_back({fmt::format("{} of {} mm", kind.size(), diameters_of(kind)),
        readable(all.dose_rate / static_cast<double>(kind.size()), 3),
        readable(least->dose_rate, 3), readable(most->dose_rate, 3),
        readable(all.dose_rate / all.area / 1e4, 3)});
  }
  add_table(section, "dose-of-balls", "Dose of a ball",
      {"balls", "mean [W]", "least [W]", "most [W]", "mean per area [W/cm\u00b2]"}, rows);
}

/// Draws the dose rate of each ball, for up to 400 balls.
void draw_balls(pugi::xml_node section, const std::vector<Ball>& balls) {
  constexpr std::size_t most = 400;
  if (balls.size() < 2 || balls.size() > most) return;
  plot::Chart chart{"dose-by-ball", "Dose rate of each ball",
      "A bar for each ball: its half of the dose rate of its impacts.",
      {"number of the ball", 0, static_cast<double>(balls.size())}, {"dose rate [W]"}};
  std::vector<double> rates;
  for (const auto& ball : balls) rates.push_back(ball.dose_rate);
  chart.curves.push_back(bars("", "c0", 0, 1, rates));
  draw_fitted(add(section, "div", {{"class", "charts"}}), chart);
}

void add_balls(pugi::xml_node section, const RunFolder& run) {
  const auto table = run.table("bodies", "a table of bodies", 1);
  if (!table || !(table->duration > 0))
    return add_missing(section, table ? "time in the dose of each ball" : "dose of each ball",
        "type = \"bodies\"");
  const auto rate = table->column("dose_rate"), area = table->column("area");
  std::vector<Ball> balls;
  for (const auto& row : table->rows_of("ball")) balls.push_back({row[rate], row[area]});
  add_sizes(section, balls);
  draw_balls(section, balls);
  add_note(section,
      "Either body of an impact gets half of its dose here; the table by partner has all of the "
      "dose of the impacts with a wall.");
}

}  // namespace

void add_vessel(pugi::xml_node main, const RunFolder& run) {
  auto section = add_section(main, "vessel", "Where the dose lands");
  add_maps(section, run);
  add_balls(section, run);
}

}  // namespace edmill::report
