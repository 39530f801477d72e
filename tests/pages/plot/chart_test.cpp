#include "plot/chart.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

namespace {

using namespace edmill::plot;

Chart some_chart() {
  Chart chart;
  chart.id = "speed", chart.title = "Speed <of> balls & walls", chart.description = "A line.";
  chart.x = {"time [s]", 0, 10, false};
  chart.y = {"speed [m/s]", 0, 4, false};
  chart.curves.push_back({"mean", "c0", {{0, 1}, {2.5, 3}, {10, 2}}, false});
  return chart;
}

pugi::xml_document drawn(const Chart& chart) {
  pugi::xml_document document;
  draw(document, chart);
  return document;
}

std::vector<std::pair<double, double>> points_of(const pugi::xml_node& path) {
  std::string text = path.attribute("d").as_string();
  for (char& c : text)
    if (std::string("MLZ").find(c) != std::string::npos) c = ' ';
  std::istringstream in(text);
  std::vector<std::pair<double, double>> points;
  for (double x = 0, y = 0; in >> x >> y;) points.emplace_back(x, y);
  return points;
}

/// The value at a position in the drawing, by two labelled ticks of its axis.
double by_ticks(
    const pugi::xml_document& document, const char* axis, const char* coordinate, double place) {
  std::vector<std::pair<double, double>> ticks;  // place, value
  for (const auto& found : document.select_nodes(
           (std::string("//g[contains(@class,'") + axis + "')]/text[@class='label']").c_str()))
    ticks.emplace_back(
        found.node().attribute(coordinate).as_double(), found.node().text().as_double());
  const auto [p0, v0] = ticks.front();
  const auto [p1, v1] = ticks.back();
  return v0 + (place - p0) * (v1 - v0) / (p1 - p0);
}

TEST(Chart, PointsStandWhereTheTicksSay) {
  const auto document = drawn(some_chart());
  const auto points = points_of(document.select_node("//path[contains(@class,'curve')]").node());
  ASSERT_EQ(points.size(), 3u);
  // Labels of the y axis are 4 px below their ticks.
  EXPECT_NEAR(by_ticks(document, "x-axis", "x", points[1].first), 2.5, 1e-3);
  EXPECT_NEAR(by_ticks(document, "y-axis", "y", points[1].second + 4), 3, 1e-3);
  EXPECT_NEAR(by_ticks(document, "x-axis", "x", points[2].first), 10, 1e-3);
  EXPECT_NEAR(by_ticks(document, "y-axis", "y", points[2].second + 4), 2, 1e-3);
}

TEST(Chart, ADecadeIsAsLongAsAnyOtherOnALogarithmicAxis) {
  auto chart = some_chart();
  chart.y = {"energy [J]", 1e-6, 1, true};
  chart.curves[0].points = {{0, 1e-5}, {1, 1e-4}, {2, 1e-3}};
  const auto points =
      points_of(drawn(chart).select_node("//path[contains(@class,'curve')]").node());
  ASSERT_EQ(points.size(), 3u);
  EXPECT_NEAR(points[0].second - points[1].second, points[1].second - points[2].second, 0.02);
  EXPECT_GT(points[0].second, points[1].second);
}

TEST(Chart, AHistogramIsLevelOverEachBin) {
  auto chart = some_chart();
  chart.curves[0].points = {{0, 1}, {5, 3}, {10, 0}};
  chart.curves[0].steps = true;
  const auto points =
      points_of(drawn(chart).select_node("//path[contains(@class,'curve')]").node());
  ASSERT_EQ(points.size(), 4u);
  EXPECT_EQ(points[0].second, points[1].second);
  EXPECT_EQ(points[1].first, points[2].first);
  EXPECT_EQ(points[2].second, points[3].second);
}

TEST(Chart, ALineIsInterruptedWhereItHasNoValue) {
  auto chart = some_chart();
  chart.curves[0].points = {{0, 1}, {1, 2}, {2, std::nan("")}, {3, 1}, {4, 2}};
  const auto document = drawn(chart);
  const std::string path =
      document.select_node("//path[contains(@class,'curve')]").node().attribute("d").as_string();
  EXPECT_EQ(std::count(path.begin(), path.end(), 'M'), 2);
  EXPECT_EQ(path.find("nan"), std::string::npos);
}

TEST(Chart, HasTitlesForReadersWhoCannotSeeItAndNoMarkupFromTexts) {
  const auto document = drawn(some_chart());
  const auto svg = document.select_node("//svg").node();
  EXPECT_STREQ(svg.attribute("role").as_string(), "img");
  EXPECT_STREQ(svg.attribute("aria-labelledby").as_string(), "speed-title speed-desc");
  EXPECT_STREQ(svg.child("desc").text().as_string(), "A line.");
  const std::string html = html_of(document);
  EXPECT_NE(html.find("Speed &lt;of&gt; balls &amp; walls"), std::string::npos);
  EXPECT_EQ(html.find("/>"), std::string::npos);  // HTML has no self-closed tags
}

/// Relative luminance by WCAG 2.
double luminance(const std::string& colour) {
  const auto part = [&](std::size_t k) {
    const double c = std::stoi(colour.substr(k, 2), nullptr, 16) / 255.0;
    return c <= 0.03928 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * part(1) + 0.7152 * part(3) + 0.0722 * part(5);
}

TEST(HeatMap, MoreIsAlwaysLighter) {
  for (int k = 1; k <= 32; ++k)
    EXPECT_GT(luminance(heat_colour(k / 32.0)), luminance(heat_colour((k - 1) / 32.0))) << k;
  EXPECT_EQ(heat_colour(2), heat_colour(1));
  EXPECT_EQ(heat_colour(-1), heat_colour(0));
}

TEST(HeatMap, CellsOfADiscLieOnTheirRing) {
  HeatMap map;
  map.id = "cap", map.title = "Cap", map.value = "dose rate [kW/m2]", map.disc = true,
  map.highest = 2;
  map.y = {"", 0, 0.019, false};
  map.cells = {{0, std::acos(-1.0) / 2, 0.0095, 0.019, 2}};
  pugi::xml_document document;
  draw(document, map);
  const auto cell = document.select_node("//g[@class='cells']/path").node();
  EXPECT_EQ(std::string(cell.attribute("fill").as_string()), heat_colour(1));
  double x0 = 0, y0 = 0, rx = 0, ry = 0, turn = 0, large = 0, sweep = 0, x1 = 0, y1 = 0;
  std::string path = cell.attribute("d").as_string();
  for (char& c : path)
    if (c == 'M' || c == 'A' || c == 'L') c = ' ';
  std::istringstream(path) >> x0 >> y0 >> rx >> ry >> turn >> large >> sweep >> x1 >> y1;
  // From angle 0 on the outer circle a quarter against the clock: left and up by the radius.
  EXPECT_NEAR(x0 - x1, rx, 0.02);
  EXPECT_NEAR(y0 - y1, rx, 0.02);
}

TEST(HeatMap, LabelsAlongXAreRoundOrAtSteps) {
  HeatMap map;
  map.id = "wall", map.title = "Wall", map.value = "dose rate [kW/m2]";
  map.x = {"along x [mm]", -20, 20, false}, map.y = {"along y [mm]", -10, 10, false};
  const auto labels = [&] {
    pugi::xml_document document;
    draw(document, map);
    std::string text;
    for (const auto& label :
        document.select_nodes("//g[@class='axis x-axis']/text[@class='label']"))
      text += std::string(label.node().text().as_string()) + " ";
    return text;
  };
  EXPECT_EQ(labels(), "\u221220 \u221210 0 10 20 ");
  map.x = {"angle [\u00b0]", 0, 360, false}, map.x_step = 90;
  EXPECT_EQ(labels(), "0 90 180 270 360 ");
}

}  // namespace
