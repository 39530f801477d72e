#include "plot/heat_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace edmill::plot {

namespace {

using std::numbers::pi;

void add_cell(pugi::xml_node parent, const std::string& path, const HeatMap& map, const HeatCell& cell) {
  auto node = add(parent, "path", {{"d", path}, {"fill", heat_colour(cell.value / map.highest)}});
  add(node, "title", {}, readable(cell.value, 3) + map.value.substr(map.value.find(" [") + 1));
}

/// A ring's part between two angles.
std::string sector(const HeatCell& c, double scale, double cx, double cy) {
  const auto place = [&](double radius, double angle) {
    return fmt::format("{} {}", pixel(cx + scale * radius * std::cos(angle)),
                       pixel(cy - scale * radius * std::sin(angle)));
  };
  const std::string outer = pixel(scale * c.y_high), inner = pixel(scale * c.y_low);
  const int large = c.x_high - c.x_low > pi ? 1 : 0;
  return fmt::format("M{}A{} {} 0 {} 0 {}L{}A{} {} 0 {} 1 {}Z", place(c.y_high, c.x_low), outer, outer, large,
                     place(c.y_high, c.x_high), place(c.y_low, c.x_high), inner, inner, large,
                     place(c.y_low, c.x_low));
}

constexpr double bar = 12, bar_gap = 5;

/// From the left edge of the scale to the end of its labels.
double scale_width(const HeatMap& map) {
  return bar + bar_gap + width_of(linear_ticks(0, map.highest, 6)) + 2;
}

void add_scale(pugi::xml_node svg, const HeatMap& map, double x, double top, double bottom) {
  auto scale = add(svg, "g", {{"class", "axis y-axis"}});
  constexpr int parts = 48;
  const double height = (bottom - top) / parts;
  for (int k = 0; k < parts; ++k)
    add(scale, "rect",
        {{"x", pixel(x)},
         {"y", pixel(bottom - (k + 1) * height)},
         {"width", pixel(bar)},
         {"height", pixel(height + 0.5)},
         {"fill", heat_colour((k + 0.5) / parts)}});
  for (const auto& tick : linear_ticks(0, map.highest, 6))
    add_text(scale, "label after", x + bar + bar_gap, bottom - (bottom - top) * tick.place / map.highest + 4,
             tick.label);
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
             fmt::format("M{0} {1}H{2}V{3}H{0}Z", pixel(x(c.x_low)), pixel(y(c.y_low)), pixel(x(c.x_high)),
                         pixel(y(c.y_high))),
             map, c);
  auto x_axis = add(svg, "g", {{"class", "axis x-axis"}}), y_axis = add(svg, "g", {{"class", "axis y-axis"}});
  for (const auto& tick : x_ticks(map, right - left))
    add_text(x_axis, "label", x(tick.place), bottom + 16, tick.label);
  for (const auto& tick : rows) add_text(y_axis, "label", left - 6, y(tick.place) + 4, tick.label);
  add_text(x_axis, "axis-title", (left + right) / 2, height - 8, map.x.title);
  add_y_title(y_axis, 14, (top + bottom) / 2, map.y.title);
  add_scale(svg, map, scale_left, top, bottom);
}

}  // namespace

std::string heat_colour(double share) {
  // Every eighth of matplotlib's viridis (public domain, CC0); straight lines between.
  static constexpr std::array<std::array<double, 3>, 9> stops{{{68, 1, 84},
                                                               {71, 44, 122},
                                                               {59, 81, 139},
                                                               {44, 113, 142},
                                                               {33, 144, 141},
                                                               {39, 173, 129},
                                                               {92, 200, 99},
                                                               {170, 220, 50},
                                                               {253, 231, 37}}};
  const double place = std::clamp(share, 0.0, 1.0) * 8;
  const auto k = std::min<std::size_t>(7, static_cast<std::size_t>(place));
  const auto part = [&](std::size_t c) {
    return static_cast<int>(
        std::lround(stops[k][c] + (place - static_cast<double>(k)) * (stops[k + 1][c] - stops[k][c])));
  };
  return fmt::format("#{:02x}{:02x}{:02x}", part(0), part(1), part(2));
}

void draw(pugi::xml_node parent, const HeatMap& map) {
  auto figure =
      add(parent, "figure", {{"class", map.disc ? "chart heat disc" : "chart heat"}, {"id", map.id}});
  add(figure, "figcaption", {}, map.title);
  if (map.disc)
    draw_disc(figure, map);
  else
    draw_sheet(figure, map);
}

}  // namespace edmill::plot
