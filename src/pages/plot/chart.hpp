// HTML and SVG built as a tree, so that every text in it is escaped; charts and heat maps as SVG.
// Colours of charts are CSS classes of the page.
#pragma once

#include <initializer_list>
#include <ostream>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace edmill::plot {

using Attributes = std::initializer_list<std::pair<const char*, std::string>>;

/// A new element at the end of `parent`.
pugi::xml_node add(pugi::xml_node parent, const char* name, Attributes attributes = {},
    std::string_view text = {});

/// HTML text of a document, without self-closing tags, which HTML lacks, or added white space.
std::string html_of(const pugi::xml_document& document);

struct Axis {
  std::string title{};  ///< with its unit: "time [s]"
  double low = 0, high = 1;
  bool logarithmic = false;
  bool whole = false;  ///< of x: labels at whole numbers alone
};

using Points = std::vector<std::pair<double, double>>;

struct Curve {
  std::string name;    ///< in the legend; none when empty
  std::string colour;  ///< CSS class: "c0" to "c7"
  Points points;       ///< nan in y interrupts the line
  /// Bars of a histogram: each y extends from its x to the next x; the last y is not drawn.
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

/// Lines, steps, bands and marks in a frame with axes.
struct Chart {
  std::string id{};           ///< unique on the page
  std::string title{};        ///< a heading over the chart
  std::string description{};  ///< what a reader who cannot see it should know
  Axis x{}, y{};
  std::vector<Curve> curves{};
  std::vector<Band> bands{};
  std::vector<Mark> marks{};
};

/// A cell of a map in the coordinates of its axes; of a disc: angle [rad] and radius.
struct HeatCell {
  double x_low, x_high, y_low, y_high;
  double value;
};

/// Values of cells as colours, with their scale.
struct HeatMap {
  std::string id, title, description;
  Axis x, y;           ///< of a disc: y from 0 to the outer radius, x unused but for its title
  std::string value;   ///< title of the scale, with its unit
  double highest = 1;  ///< value at the top of the scale, whose bottom is 0
  double x_step = 0;   ///< between the labels along x; 0 for round numbers
  bool disc = false;   ///< polar cells, angle 0 to the right, counterclockwise
  std::vector<HeatCell> cells;
};

/// "#rrggbb" of a share of the highest value: viridis, whose lightness grows steadily.
std::string heat_colour(double share);

/// The convex hull of points, counterclockwise.
Points hull_of(Points points);

/// A figure with caption, legend or scale, and drawing.
void draw(pugi::xml_node parent, const Chart& chart);
void draw(pugi::xml_node parent, const HeatMap& map);

/// The drawing alone as a file (SVG), in the colours that it has on a page of a report.
void save(std::ostream& out, const Chart& chart);

/// An <svg> with title and description, for readers who cannot see it.
pugi::xml_node add_drawing(pugi::xml_node parent, const std::string& id, const std::string& title,
    const std::string& description, double width, double height);

/// "12.3", for places in a drawing.
std::string pixel(double place);

struct Tick {
  double place;
  std::string label;  ///< empty for a mark between the labelled ones
};

/// Multiples of 1, 2 or 5 times a power of ten inside [low, high], at most `most` of them (and two
/// at least when `most` > 3). @pre low < high
std::vector<Tick> linear_ticks(double low, double high, int most = 6);

/// Linear ticks, but fewer of them if their labels side by side would not fit. @param room  [px]
std::vector<Tick> fitting_ticks(double low, double high, int most, double room);

/// Powers of ten inside [low, high], about `most` of them with labels, and unlabelled multiples 2
/// to 9 between them if there are few decades. @pre 0 < low < high
std::vector<Tick> log_ticks(double low, double high, int most = 7);

/// Width of a label, or of the widest of several, in the largest font of the pages [px].
double width_of(const std::string& label);
double width_of(const std::vector<Tick>& ticks);

/// "0.1803", "1.2 x 10^-5" with a real minus and superscripts, thousands apart: for reading only.
/// @param digits  significant ones
std::string readable(double value, int digits = 4);

/// A value as `readable` writes it, without zeros at the end: "38", "0.5".
std::string brief(double value, int digits = 6);

/// A value and its half-width with the digits that the half-width allows: "5.542" and "0.031".
std::pair<std::string, std::string> with_interval(double value, double half_width);

}  // namespace edmill::plot
