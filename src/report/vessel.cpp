// Distribution of the dose over the vessel.
#include "model/vessel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plot/heat_map.hpp"
#include "report/sections.hpp"

namespace edmill::report {

using plot::add;
using plot::readable;

namespace {

constexpr double degrees = 180 / 3.14159265358979323846;

using Maps = std::array<plot::HeatMap, model::wall_count>;

/// The dose rates of the table's cells, by wall [kW/m2].
Maps read_maps(const OutputTable& table) {
  const auto column = [&](const char* name) { return table.column(name); };
  const auto wall = column("wall"), a_low = column("angle_low"), a_high = column("angle_high"),
             h_low = column("height_low"), h_high = column("height_high"), r_low = column("radius_low"),
             r_high = column("radius_high"), density = column("dose_per_area");
  Maps maps;
  for (auto& map : maps) map.highest = 0;
  for (const auto& row : table.numbers) {
    const auto w = static_cast<std::size_t>(row[wall]);
    if (w >= maps.size()) continue;
    const double value = row[density] / table.duration() / 1000;  // kW/m2
    if (w == 2) {
      maps[w].cells.push_back(
          {row[a_low] * degrees, row[a_high] * degrees, row[h_low] * 1000, row[h_high] * 1000, value});
    } else {
      maps[w].cells.push_back({row[a_low], row[a_high], row[r_low], row[r_high], value});
    }
    maps[w].highest = std::max(maps[w].highest, value);
  }
  return maps;
}

void label_maps(Maps& maps, double radius, double height) {
  const double highest = std::max(maps[0].highest, maps[1].highest);
  for (std::size_t w = 0; w < 2; ++w) {
    maps[w].highest = highest;  // the caps share a scale
    maps[w].disc = true;
    maps[w].y = {"", 0, radius, false};
    maps[w].x.title = "angle about the vessel\u2019s axis";
    maps[w].id = fmt::format("cap-{}", w);
  }
  maps[0].title = fmt::format("Cap \u2212y, {} mm across", plot::brief(2000 * radius));
  maps[1].title = fmt::format("Cap +y, {} mm across", plot::brief(2000 * radius));
  maps[2].id = "cylinder", maps[2].title = "Cylinder, unrolled";
  maps[2].x = {"angle about the vessel\u2019s axis [\u00b0]", 0, 360, false};
  maps[2].y = {"height along the axis [mm]", -500 * height, 500 * height, false};
  if (!maps[2].cells.empty()) {
    maps[2].x.low = maps[2].x.high = maps[2].cells[0].x_low;
    for (const auto& cell : maps[2].cells)
      maps[2].x.low = std::min(maps[2].x.low, cell.x_low),
      maps[2].x.high = std::max(maps[2].x.high, cell.x_high);
  }
}

}  // namespace

void add_vessel(pugi::xml_node main, const RunFolder& run) {
  auto section = add_section(main, "vessel", "Where the dose lands");
  const auto* output = run.output("coverage", [](const auto& o) { return o.only.empty(); });
  if (!output) return add_missing(section, "dose on the vessel's walls", "type = \"coverage\"");
  const auto table = read_table(run.file_of(*output), "a table of coverage");
  if (!(table.duration() > 0))
    return add_missing(section, "time in the coverage of the vessel", "type = \"coverage\"");
  auto maps = read_maps(table);
  label_maps(maps, std::get<0>(run.spec.vessel).diameter.to<double>() / 2,
             std::get<0>(run.spec.vessel).height.to<double>());
  auto grid = add(section, "div", {{"class", "charts maps"}});
  for (const auto w : std::initializer_list<std::size_t>{2, 0, 1}) {
    auto& map = maps[w];
    map.value = "dose rate [kW/m\u00b2]";
    if (!(map.highest > 0)) map.highest = 1;
    map.description = fmt::format("Map of the dose rate per area on {}, up to {} kW per square metre.",
                                  w == 2   ? "the cylinder"
                                  : w == 0 ? "the cap at -y"
                                           : "the cap at +y",
                                  readable(map.highest, 3));
    draw(grid, map);
  }
  add(section, "p", {{"class", "note"}},
      "Angles are measured from the direction along the arm, away from the fulcrum. Cells of one wall have "
      "equal areas. The caps share a scale.");
}

}  // namespace edmill::report
