// Charts as SVG: lines, steps, bands and marks in a frame with axes. Colours are CSS classes of the page.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "plot/markup.hpp"
#include "plot/ticks.hpp"

namespace edmill::plot {

struct Axis {
  std::string title;  ///< with its unit: "time [s]"
  double low = 0, high = 1;
  bool logarithmic = false;
};

using Points = std::vector<std::pair<double, double>>;

struct Curve {
  std::string name;    ///< in the legend; none when empty
  std::string colour;  ///< CSS class: "c0" to "c7"
  Points points;       ///< nan in y interrupts the line
  /// Bars of a histogram: y holds from x to the x of the next point, whose last y is not drawn.
  bool steps = false;
};

/// Filled between two heights.
struct Band {
  std::string colour;
  std::vector<double> x, low, high;
};

/// A vertical line with a word beside it.
struct Mark {
  double x;
  std::string text;
};

struct Chart {
  std::string id;           ///< unique on the page
  std::string title;        ///< a heading over the chart
  std::string description;  ///< what a reader who cannot see it should know
  Axis x, y;
  std::vector<Curve> curves;
  std::vector<Band> bands;
  std::vector<Mark> marks;
};

/// The inside of the frame in the chart's own units, as far in as the labels need. [px]
struct Frame {
  double left = 70, right = 448, top = 14, bottom = 232;
  double width = 460, height = 280;

  /// Room for the labels of the y axis and its title, and for half of the last one of the x axis.
  void make_room(const std::vector<Tick>& x, const std::vector<Tick>& y);
};

/// The convex polygon around points, against the clock.
Points hull_of(Points points);

/// Where a value stands along an axis, 0 at its low end and 1 at its high end.
double fraction(const Axis& axis, double value);

/// A figure with caption, legend and drawing.
void draw(pugi::xml_node parent, const Chart& chart);

/// The drawing alone as a file (SVG), in the colours that it has on a page of a report.
void save(std::ostream& out, const Chart& chart);

/// An <svg> with title and description, for readers who cannot see it.
pugi::xml_node add_drawing(pugi::xml_node parent, const std::string& id, const std::string& title,
                           const std::string& description, double width, double height);

/// "12.3", for places in a drawing.
std::string pixel(double place);
/// A <text> of a style [px].
pugi::xml_node add_text(pugi::xml_node parent, const char* style, double x, double y,
                        const std::string& text);
/// The title of a y axis, which reads upwards [px].
void add_y_title(pugi::xml_node axis, double x, double y, const std::string& text);

}  // namespace edmill::plot
