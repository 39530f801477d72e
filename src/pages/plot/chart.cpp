#include "plot/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace edmill::plot {

namespace {

std::vector<Tick> x_ticks(const Axis& axis) {
  const Frame frame;
  return axis.logarithmic ? log_ticks(axis.low, axis.high)
                          : fitting_ticks(axis.low, axis.high, 6, frame.right - frame.left);
}
std::vector<Tick> y_ticks(const Axis& axis) {
  return axis.logarithmic ? log_ticks(axis.low, axis.high) : linear_ticks(axis.low, axis.high);
}

/// Places of values in the frame; what lies outside stops a little beyond it and is clipped.
class Places {
 public:
  explicit Places(const Chart& chart) : chart_(chart) { frame.make_room(x_ticks(chart.x), y_ticks(chart.y)); }
  double x(double value) const {
    return frame.left + bounded(fraction(chart_.x, value)) * (frame.right - frame.left);
  }
  double y(double value) const {
    return frame.bottom - bounded(fraction(chart_.y, value)) * (frame.bottom - frame.top);
  }
  /// "M12 34": a step of a path.
  std::string step(const char* pen, double x_value, double y_value) const {
    return fmt::format("{}{} {}", pen, pixel(x(x_value)), pixel(y(y_value)));
  }
  Frame frame;

 private:
  static double bounded(double fraction) { return std::clamp(fraction, -0.05, 1.05); }
  const Chart& chart_;
};

/// "0.1,5.8 0.2,5.9": for a reader who takes the curve as a table.
std::string points_of(const Curve& curve) {
  std::string points;
  for (const auto& [x, y] : curve.points)
    if (!std::isnan(y)) points += fmt::format("{}{:.6g},{:.6g}", points.empty() ? "" : " ", x, y);
  return points;
}

std::string path_of(const Curve& curve, const Places& places) {
  std::string path;
  const auto& points = curve.points;
  bool pen_down = false;
  const auto go = [&](double x, double y) {
    path += places.step(pen_down ? "L" : "M", x, y);
    pen_down = true;
  };
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto [x, y] = points[k];
    if (std::isnan(y)) {
      pen_down = false;
      continue;
    }
    if (curve.steps && k + 1 == points.size()) break;
    go(x, y);
    if (curve.steps) go(points[k + 1].first, y);
  }
  return path;
}

std::string path_of(const Band& band, const Places& places) {
  std::string path;
  for (std::size_t k = 0; k < band.x.size(); ++k)
    path += places.step(k == 0 ? "M" : "L", band.x[k], band.high[k]);
  for (std::size_t k = band.x.size(); k-- > 0;) path += places.step("L", band.x[k], band.low[k]);
  return path + "Z";
}

void add_line(pugi::xml_node parent, const char* style, double x1, double y1, double x2, double y2) {
  add(parent, "line",
      {{"class", style}, {"x1", pixel(x1)}, {"y1", pixel(y1)}, {"x2", pixel(x2)}, {"y2", pixel(y2)}});
}

void add_axes(pugi::xml_node svg, const Chart& chart, const Places& places) {
  const Frame& f = places.frame;
  auto x_axis = add(svg, "g", {{"class", "axis x-axis"}}), y_axis = add(svg, "g", {{"class", "axis y-axis"}});
  for (const auto& tick : x_ticks(chart.x)) {
    const double x = places.x(tick.place);
    add_line(x_axis, "tick", x, f.bottom, x, f.bottom + (tick.label.empty() ? 3 : 5));
    if (!tick.label.empty()) add_text(x_axis, "label", x, f.bottom + 18, tick.label);
  }
  for (const auto& tick : y_ticks(chart.y)) {
    const double y = places.y(tick.place);
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

}  // namespace

void Frame::make_room(const std::vector<Tick>& x, const std::vector<Tick>& y) {
  constexpr double title = 20, gap = 8;
  left = std::max(left, title + gap + width_of(y));
  if (!x.empty()) right = std::min(right, width - width_of(x.back().label) / 2);
}

std::string pixel(double place) {
  std::string text = fmt::format("{:.2f}", place);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

pugi::xml_node add_text(pugi::xml_node parent, const char* style, double x, double y,
                        const std::string& text) {
  return add(parent, "text", {{"class", style}, {"x", pixel(x)}, {"y", pixel(y)}}, text);
}

void add_y_title(pugi::xml_node axis, double x, double y, const std::string& text) {
  add_text(axis, "axis-title", x, y, text).append_attribute("transform") =
      fmt::format("rotate(-90 {} {})", pixel(x), pixel(y)).c_str();
}

Points hull_of(Points points) {
  std::sort(points.begin(), points.end());
  Points hull;
  const auto add_side = [&](const auto& begin, const auto& end) {
    const std::size_t base = hull.size();
    for (auto p = begin; p != end; ++p) {
      while (hull.size() >= base + 2) {
        const auto &a = hull[hull.size() - 2], &b = hull.back();
        if ((b.first - a.first) * (p->second - a.second) - (b.second - a.second) * (p->first - a.first) > 0)
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

double fraction(const Axis& axis, double value) {
  if (!axis.logarithmic) return (value - axis.low) / (axis.high - axis.low);
  return value > 0 ? std::log(value / axis.low) / std::log(axis.high / axis.low) : -1;
}

pugi::xml_node add_drawing(pugi::xml_node parent, const std::string& id, const std::string& title,
                           const std::string& description, double width, double height) {
  auto svg = add(parent, "svg",
                 {{"viewBox", fmt::format("0 0 {} {}", pixel(width), pixel(height))},
                  {"role", "img"},
                  {"aria-labelledby", id + "-title " + id + "-desc"}});
  add(svg, "title", {{"id", id + "-title"}}, title);
  add(svg, "desc", {{"id", id + "-desc"}}, description);
  return svg;
}

void draw(pugi::xml_node parent, const Chart& chart) {
  const Places places(chart);
  const Frame& f = places.frame;
  auto figure = add(parent, "figure", {{"class", "chart"}, {"id", chart.id}});
  add(figure, "figcaption", {}, chart.title);
  add_legend(figure, chart);
  auto svg = add_drawing(figure, chart.id, chart.title, chart.description, f.width, f.height);
  const std::string clip = chart.id + "-frame";
  add(add(add(svg, "defs"), "clipPath", {{"id", clip}}), "rect",
      {{"x", pixel(f.left)},
       {"y", pixel(f.top - 1)},
       {"width", pixel(f.right - f.left)},
       {"height", pixel(f.bottom - f.top + 1)}});
  add_axes(svg, chart, places);
  auto inside = add(svg, "g", {{"clip-path", "url(#" + clip + ")"}});
  for (const auto& band : chart.bands)
    add(inside, "path", {{"class", "band " + band.colour}, {"d", path_of(band, places)}});
  for (const auto& mark : chart.marks) {
    const double x = places.x(mark.x);
    add_line(inside, "mark", x, f.top, x, f.bottom);
    const bool room = x < (f.left + f.right) / 2;
    add_text(inside, room ? "mark-text" : "mark-text before", x + (room ? 5 : -5), f.top + 10, mark.text);
  }
  for (const auto& curve : chart.curves)
    add(inside, "path",
        {{"class", "curve " + curve.colour},
         {"d", path_of(curve, places)},
         {"data-name", curve.name},
         {"data-points", points_of(curve)}});
}

void save(std::ostream& out, const Chart& chart) {
  pugi::xml_document page, document;
  draw(page, chart);
  auto svg = document.append_copy(page.first_element_by_path("figure/svg"));
  svg.append_attribute("xmlns") = "http://www.w3.org/2000/svg";
  for (auto group : svg.children("g"))
    for (auto path : group.children("path")) path.remove_attribute("data-points");
  svg.append_child("style").text() =
      "text { font: 11px sans-serif; fill: #333; } .axis text { text-anchor: middle; } .y-axis .label { "
      "text-anchor: end; } path, line { fill: none; stroke: currentColor; stroke-width: 1.2; stroke-linecap: "
      "round; } .axis { color: #999; } .c0 { color: #1f4e79; } .c1 { color: #b0472a; } .c2 { color: #2f8f4e; "
      "} .c3 { color: #7a4fa0; }";
  document.save(out, " ");
}

}  // namespace edmill::plot
