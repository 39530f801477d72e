#include "plot/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "base/clean_text.hpp"

namespace edmill::plot {

namespace {

/// Position of a value along an axis, 0 at its low end and 1 at its high end.
double fraction(const Axis& axis, double value) {
  if (!axis.logarithmic) return (value - axis.low) / (axis.high - axis.low);
  return value > 0 ? std::log(value / axis.low) / std::log(axis.high / axis.low) : -1;
}

/// A <text> of a style [px].
pugi::xml_node add_text(
    pugi::xml_node parent, const char* style, double x, double y, const std::string& text) {
  return add(parent, "text", {{"class", style}, {"x", pixel(x)}, {"y", pixel(y)}}, text);
}

/// The title of a y axis, which reads upwards [px].
void add_y_title(pugi::xml_node axis, double x, double y, const std::string& text) {
  add_text(axis, "axis-title", x, y, text).append_attribute("transform") =
      fmt::format("rotate(-90 {} {})", pixel(x), pixel(y)).c_str();
}

/// The plot area within the margins that the labels need [px], and the positions of values in it.
/// Values outside are moved to a position slightly beyond the frame, where they are clipped.
class Frame {
 public:
  explicit Frame(const Chart& chart) : chart_(chart) {
    constexpr double title = 20, gap = 8;
    left = std::max(left, title + gap + width_of(y_ticks()));
    // Half of the last label of the x axis.
    if (const auto ticks = x_ticks(); !ticks.empty())
      right = std::min(right, width - width_of(ticks.back().label) / 2);
  }
  std::vector<Tick> x_ticks() const {
    const Axis& axis = chart_.x;
    if (axis.logarithmic) return log_ticks(axis.low, axis.high);
    auto ticks = fitting_ticks(axis.low, axis.high, 6, most_right - least_left);
    if (!axis.whole) return ticks;
    std::erase_if(ticks, [](const Tick& tick) { return tick.place != std::round(tick.place); });
    for (auto& tick : ticks) tick.label = fmt::format("{:.0f}", tick.place);
    return ticks;
  }
  std::vector<Tick> y_ticks() const {
    const Axis& axis = chart_.y;
    return axis.logarithmic ? log_ticks(axis.low, axis.high) : linear_ticks(axis.low, axis.high);
  }
  double x(double value) const {
    return left + bounded(fraction(chart_.x, value)) * (right - left);
  }
  double y(double value) const {
    return bottom - bounded(fraction(chart_.y, value)) * (bottom - top);
  }
  /// "M12 34": a step of a path.
  std::string step(const char* pen, double x_value, double y_value) const {
    return fmt::format("{}{} {}", pen, pixel(x(x_value)), pixel(y(y_value)));
  }

  static constexpr double width = 460, height = 280, top = 14, bottom = 232;
  double left = least_left, right = most_right;
 private:
  static constexpr double least_left = 70, most_right = 448;
  static double bounded(double fraction) { return std::clamp(fraction, -0.05, 1.05); }
  const Chart& chart_;
};

/// The points of a curve as text, "0.1,5.8 0.2,5.9", from which a page makes a table.
std::string points_of(const Curve& curve) {
  std::string points;
  for (const auto& [x, y] : curve.points)
    if (!std::isnan(y)) points += fmt::format("{}{:.6g},{:.6g}", points.empty() ? "" : " ", x, y);
  return points;
}

std::string path_of(const Curve& curve, const Frame& frame) {
  std::string path;
  const auto& points = curve.points;
  const char* pen = "M";
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto [x, y] = points[k];
    if (std::isnan(y)) {
      pen = "M";
      continue;
    }
    if (curve.steps && k + 1 == points.size()) break;
    path += frame.step(std::exchange(pen, "L"), x, y);
    if (curve.steps) path += frame.step("L", points[k + 1].first, y);
  }
  return path;
}

std::string path_of(const Band& band, const Frame& frame) {
  std::string path;
  for (std::size_t k = 0; k < band.x.size(); ++k)
    path += frame.step(k == 0 ? "M" : "L", band.x[k], band.high[k]);
  for (std::size_t k = band.x.size(); k-- > 0;) path += frame.step("L", band.x[k], band.low[k]);
  return path + "Z";
}

void add_line(
    pugi::xml_node parent, const char* style, double x1, double y1, double x2, double y2) {
  add(parent, "line",
      {{"class", style}, {"x1", pixel(x1)}, {"y1", pixel(y1)}, {"x2", pixel(x2)},
          {"y2", pixel(y2)}});
}

void add_axes(pugi::xml_node svg, const Chart& chart, const Frame& f) {
  auto x_axis = add(svg, "g", {{"class", "axis x-axis"}}),
       y_axis = add(svg, "g", {{"class", "axis y-axis"}});
  for (const auto& tick : f.x_ticks()) {
    const double x = f.x(tick.place);
    add_line(x_axis, "tick", x, f.bottom, x, f.bottom + (tick.label.empty() ? 3 : 5));
    if (!tick.label.empty()) add_text(x_axis, "label", x, f.bottom + 18, tick.label);
  }
  for (const auto& tick : f.y_ticks()) {
    const double y = f.y(tick.place);
    if (!tick.label.empty()) add_line(y_axis, "grid", f.left, y, f.right, y);
    add_line(y_axis, "tick", f.left - (tick.label.empty() ? 3 : 5), y, f.left, y);
    if (!tick.label.empty()) add_text(y_axis, "label", f.left - 8, y + 4, tick.label);
  }
  add_line(x_axis, "spine", f.left, f.bottom, f.right, f.bottom);
  add_line(y_axis, "spine", f.left, f.top, f.left, f.bottom);
  add_text(x_axis, "axis-title", (f.left + f.right) / 2, f.height - 8, chart.x.title);
  add_y_title(y_axis, 12, (f.top + f.bottom) / 2, chart.y.title);
}

void add_legend(pugi::xml_node figure, const Chart& chart) {
  if (std::ranges::all_of(chart.curves, [](const auto& c) { return c.name.empty(); })) return;
  auto legend = add(figure, "ul", {{"class", "legend"}});
  for (const auto& curve : chart.curves)
    if (!curve.name.empty()) {
      auto entry = add(legend, "li");
      add(entry, "span", {{"class", "swatch " + curve.colour}, {"aria-hidden", "true"}}, " ");
      add(entry, "span", {}, curve.name);
    }
}

using std::numbers::pi;

void add_cell(
    pugi::xml_node parent, const std::string& path, const HeatMap& map, const HeatCell& cell) {
  auto node = add(parent, "path", {{"d", path}, {"fill", heat_colour(cell.value / map.highest)}});
  add(node, "title", {}, readable(cell.value, 3) + map.value.substr(map.value.find(" [") + 1));
}

/// Path of the sector of a ring between two angles.
std::string sector(const HeatCell& c, double scale, double cx, double cy) {
  const auto place = [&](double radius, double angle) {
    return fmt::format("{} {}", pixel(cx + scale * radius * std::cos(angle)),
        pixel(cy - scale * radius * std::sin(angle)));
  };
  const std::string outer = pixel(scale * c.y_high), inner = pixel(scale * c.y_low);
  const int large = c.x_high - c.x_low > pi ? 1 : 0;
  return fmt::format("M{}A{} {} 0 {} 0 {}L{}A{} {} 0 {} 1 {}Z", place(c.y_high, c.x_low), outer,
      outer, large, place(c.y_high, c.x_high), place(c.y_low, c.x_high), inner, inner, large,
      place(c.y_low, c.x_low));
}

constexpr double bar = 12, bar_gap = 5;

/// Width of the scale including its labels.
double scale_width(const HeatMap& map) {
  return bar + bar_gap + width_of(linear_ticks(0, map.highest, 6)) + 2;
}

void add_scale(pugi::xml_node svg, const HeatMap& map, double x, double top, double bottom) {
  auto scale = add(svg, "g", {{"class", "axis y-axis"}});
  constexpr int parts = 48;
  const double height = (bottom - top) / parts;
  for (int k = 0; k < parts; ++k)
    add(scale, "rect",
        {{"x", pixel(x)}, {"y", pixel(bottom - (k + 1) * height)}, {"width", pixel(bar)},
            {"height", pixel(height + 0.5)}, {"fill", heat_colour((k + 0.5) / parts)}});
  for (const auto& tick : linear_ticks(0, map.highest, 6))
    add_text(scale, "label after", x + bar + bar_gap,
        bottom - (bottom - top) * tick.place / map.highest + 4, tick.label);
  add_text(scale, "axis-title end", x + scale_width(map), top - 12, map.value);
}

void draw_disc(pugi::xml_node figure, const HeatMap& map) {
  constexpr double height = 270, cx = 122, cy = 138, radius = 86, scale_left = 246;
  const double width = std::max(300.0, scale_left + scale_width(map));
  auto svg = add_drawing(figure, map.id, map.title, map.description, width, height);
  const double scale = radius / map.y.high;
  auto cells = add(svg, "g", {{"class", "cells"}});
  for (const auto& cell : map.cells) add_cell(cells, sector(cell, scale, cx, cy), map, cell);
  auto axis = add(svg, "g", {{"class", "axis x-axis"}});
  for (int k = 0; k < 4; ++k) {
    const double c = std::cos(k * pi / 2), s = std::sin(k * pi / 2);
    add_text(axis, "label", cx + (radius + 20) * c, cy - (radius + 12) * s + 4,
        fmt::format("{}\u00b0", 90 * k));
  }
  add_text(axis, "axis-title", cx, height - 6, map.x.title);
  add_scale(svg, map, scale_left, 50, 226);
}

std::vector<Tick> x_ticks(const HeatMap& map, double room) {
  if (!(map.x_step > 0)) return fitting_ticks(map.x.low, map.x.high, 7, room);
  std::vector<Tick> ticks;
  for (double x = std::ceil(map.x.low / map.x_step) * map.x_step; x <= map.x.high; x += map.x_step)
    ticks.push_back({x, pixel(x)});
  return ticks;
}

void draw_sheet(pugi::xml_node figure, const HeatMap& map) {
  constexpr double width = 460, height = 270, top = 30, bottom = 222;
  const auto rows = linear_ticks(map.y.low, map.y.high, 7);
  const double left = std::max(56.0, 26 + width_of(rows)),
               scale_left = width - std::max(64.0, scale_width(map)), right = scale_left - 20;
  auto svg = add_drawing(figure, map.id, map.title, map.description, width, height);
  const auto x = [&](double value) { return left + fraction(map.x, value) * (right - left); };
  const auto y = [&](double value) { return bottom - fraction(map.y, value) * (bottom - top); };
  auto cells = add(svg, "g", {{"class", "cells"}});
  for (const auto& c : map.cells)
    add_cell(cells,
        fmt::format("M{0} {1}H{2}V{3}H{0}Z", pixel(x(c.x_low)), pixel(y(c.y_low)),
            pixel(x(c.x_high)), pixel(y(c.y_high))),
        map, c);
  auto x_axis = add(svg, "g", {{"class", "axis x-axis"}}),
       y_axis = add(svg, "g", {{"class", "axis y-axis"}});
  for (const auto& tick : x_ticks(map, right - left))
    add_text(x_axis, "label", x(tick.place), bottom + 16, tick.label);
  for (const auto& tick : rows) add_text(y_axis, "label", left - 6, y(tick.place) + 4, tick.label);
  add_text(x_axis, "axis-title", (left + right) / 2, height - 8, map.x.title);
  add_y_title(y_axis, 14, (top + bottom) / 2, map.y.title);
  add_scale(svg, map, scale_left, top, bottom);
}

}  // namespace

pugi::xml_node add(
    pugi::xml_node parent, const char* name, Attributes attributes, std::string_view text) {
  auto node = parent.append_child(name);
  for (const auto& [key, value] : attributes)
    node.append_attribute(key) = clean_text(value).c_str();
  if (!text.empty()) node.append_child(pugi::node_pcdata).set_value(clean_text(text).c_str());
  return node;
}

std::string html_of(const pugi::xml_document& document) {
  std::ostringstream out;
  document.save(out, "",
      pugi::format_raw | pugi::format_no_declaration | pugi::format_no_empty_element_tags,
      pugi::encoding_utf8);
  return out.str();
}

std::string pixel(double place) {
  std::string text = fmt::format("{:.2f}", place);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

Points hull_of(Points points) {
  std::sort(points.begin(), points.end());
  Points hull;
  const auto add_side = [&](const auto& begin, const auto& end) {
    const std::size_t base = hull.size();
    for (auto p = begin; p != end; ++p) {
      while (hull.size() >= base + 2) {
        const auto &a = hull[hull.size() - 2], &b = hull.back();
        if ((b.first - a.first) * (p->second - a.second) -
                (b.second - a.second) * (p->first - a.first) >
            0)
          break;
        hull.pop_back();
      }
      hull.push_back(*p);
    }
    hull.pop_back();  // begins the other side
  };
  add_side(points.begin(), points.end());
  add_side(points.rbegin(), points.rend());
  return hull;
}

pugi::xml_node add_drawing(pugi::xml_node parent, const std::string& id, const std::string& title,
    const std::string& description, double width, double height) {
  auto svg = add(parent, "svg",
      {{"viewBox", fmt::format("0 0 {} {}", pixel(width), pixel(height))}, {"role", "img"},
          {"aria-labelledby", id + "-title " + id + "-desc"}});
  add(svg, "title", {{"id", id + "-title"}}, title);
  add(svg, "desc", {{"id", id + "-desc"}}, description);
  return svg;
}

void draw(pugi::xml_node parent, const Chart& chart) {
  const Frame f(chart);
  auto figure = add(parent, "figure", {{"class", "chart"}, {"id", chart.id}});
  add(figure, "figcaption", {}, chart.title);
  add_legend(figure, chart);
  auto svg = add_drawing(figure, chart.id, chart.title, chart.description, f.width, f.height);
  const std::string clip = chart.id + "-frame";
  add(add(add(svg, "defs"), "clipPath", {{"id", clip}}), "rect",
      {{"x", pixel(f.left)}, {"y", pixel(f.top - 1)}, {"width", pixel(f.right - f.left)},
          {"height", pixel(f.bottom - f.top + 1)}});
  add_axes(svg, chart, f);
  auto inside = add(svg, "g", {{"clip-path", "url(#" + clip + ")"}});
  for (const auto& band : chart.bands)
    add(inside, "path", {{"class", "band " + band.colour}, {"d", path_of(band, f)}});
  for (const auto& mark : chart.marks) {
    const double x = f.x(mark.x);
    add_line(inside, "mark", x, f.top, x, f.bottom);
    const bool room = x < (f.left + f.right) / 2;
    add_text(inside, room ? "mark-text" : "mark-text before", x + (room ? 5 : -5), f.top + 10,
        mark.text);
  }
  for (const auto& curve : chart.curves)
    add(inside, "path",
        {{"class", "curve " + curve.colour}, {"d", path_of(curve, f)}, {"data-name", curve.name},
            {"data-points", points_of(curve)}});
}

void save(std::ostream& out, const Chart& chart) {
  pugi::xml_document page, document;
  draw(page, chart);
  auto svg = document.append_copy(page.first_element_by_path("figure/svg"));
  svg.append_attribute("xmlns") = "http://www.w3.org/2000/svg";
  for (const auto& path : svg.select_nodes("g/path")) path.node().remove_attribute("data-points");
  svg.append_child("style").text() =
      "text { font: 11px sans-serif; fill: #333; } .axis text { text-anchor: middle; } .y-axis "
      ".label { text-anchor: end; } path, line { fill: none; stroke: currentColor; stroke-width: "
      "1.2; stroke-linecap: round; } .axis { color: #999; } .c0 { color: #1f4e79; } .c1 { color: "
      "#b0472a; } .c2 { color: #2f8f4e; } .c3 { color: #7a4fa0; }";
  document.save(out, " ");
}

std::string heat_colour(double share) {
  // Every eighth of matplotlib's viridis (public domain, CC0); straight lines between.
  static constexpr std::array stops{
      0x440154, 0x472c7a, 0x3b518b, 0x2c718e, 0x21908d, 0x27ad81, 0x5cc863, 0xaadc32, 0xfde725};
  const double place = std::clamp(share, 0.0, 1.0) * 8;
  const auto k = std::min<std::size_t>(7, static_cast<std::size_t>(place));
  std::string colour = "#";
  for (const int shift : {16, 8, 0}) {
    const double low = (stops[k] >> shift) & 255, high = (stops[k + 1] >> shift) & 255;
    colour +=
        fmt::format("{:02x}", std::lround(low + (place - static_cast<double>(k)) * (high - low)));
  }
  return colour;
}

void draw(pugi::xml_node parent, const HeatMap& map) {
  auto figure = add(
      parent, "figure", {{"class", map.disc ? "chart heat disc" : "chart heat"}, {"id", map.id}});
  add(figure, "figcaption", {}, map.title);
  if (map.disc)
    draw_disc(figure, map);
  else
    draw_sheet(figure, map);
}

}  // namespace edmill::plot
