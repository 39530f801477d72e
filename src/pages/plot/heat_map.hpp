// Values of cells as colours, with the scale that tells them apart.
#pragma once

#include <string>
#include <vector>

#include "plot/chart.hpp"

namespace edmill::plot {

/// A cell of a map in the coordinates of its axes; of a disc: angle [rad] and radius.
struct HeatCell {
  double x_low, x_high, y_low, y_high;
  double value;
};

struct HeatMap {
  std::string id, title, description;
  Axis x, y;           ///< of a disc: y from 0 to the outer radius, x unused but for its title
  std::string value;   ///< title of the scale, with its unit
  double highest = 1;  ///< value at the top of the scale, whose bottom is 0
  double x_step = 0;   ///< between the labels along x; 0 for round numbers
  bool disc = false;   ///< polar cells, angle 0 to the right, turning against the clock
  std::vector<HeatCell> cells;
};

/// A figure with caption, drawing and scale.
void draw(pugi::xml_node parent, const HeatMap& map);

/// "#rrggbb" of a share of the highest value: viridis, whose lightness grows steadily.
std::string heat_colour(double share);

}  // namespace edmill::plot
