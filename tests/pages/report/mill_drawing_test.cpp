#include <gtest/gtest.h>

#include <cmath>
#include <pugixml.hpp>
#include <sstream>

#include "casefile/build_case.hpp"
#include "casefile/case_spec.hpp"
#include "report/report_page.hpp"

namespace {

using edmill::casefile::read_case;

pugi::xml_document drawn(
    const std::string& example, const std::vector<std::string>& overrides = {}) {
  const auto spec = read_case(EDMILL_SOURCE_DIR "/docs/examples/" + example, overrides);
  pugi::xml_document document;
  const auto text =
      edmill::report::mill_drawing(edmill::casefile::build_case<double>(spec, false).the_case.mill);
  EXPECT_TRUE(document.load_string(text.c_str()));
  return document;
}

std::vector<std::pair<double, double>> points_of(const pugi::xml_node& path) {
  std::string text = path.attribute("d").value();
  for (char& c : text)
    if (c == 'M' || c == 'L' || c == 'Z' || c == 'h') c = ' ';
  std::istringstream in(text);
  std::vector<std::pair<double, double>> points;
  for (double x, y; in >> x >> y;) points.emplace_back(x, y);
  return points;
}

pugi::xml_node first(const pugi::xml_document& document, const char* style) {
  return document.select_node((".//path[@class='" + std::string(style) + "']").c_str()).node();
}

/// Length of the scale bar [px] and what it stands for [m].
std::pair<double, double> bar_of(const pugi::xml_document& document) {
  for (const auto& node : document.select_nodes("//path[@class='arm']")) {
    const std::string path = node.node().attribute("d").value();
    if (const auto at = path.find('h'); at != std::string::npos) {
      const std::string label = node.node().next_sibling("text").child_value();
      return {std::stod(path.substr(at + 1)), std::stod(label) / 1000};
    }
  }
  return {};
}

TEST(MillDrawing, TheJarOfAPlanetaryMillGoesRoundADiscOfItsRadius) {
  const auto document = drawn("planetary.toml");
  EXPECT_STREQ(document.child("svg").attribute("xmlns").value(), "http://www.w3.org/2000/svg");
  const auto path = points_of(first(document, "path"));
  ASSERT_GT(path.size(), 100u);
  double x = 0, y = 0;
  for (std::size_t k = 1; k < path.size(); ++k) x += path[k].first, y += path[k].second;
  x /= static_cast<double>(path.size() - 1), y /= static_cast<double>(path.size() - 1);
  const auto [pixels, metres] = bar_of(document);
  ASSERT_GT(pixels, 10);
  // 75 mm, in the first of the three views that sees a circle; places have 0.01 px.
  double largest = 0;
  for (const auto& [px, py] : path) largest = std::max(largest, std::hypot(px - x, py - y));
  EXPECT_NEAR(largest * metres / pixels, 0.075, 0.075 * 2e-3);
  EXPECT_EQ(document.select_nodes("//circle[@class='joint']").size(),
      3u * 3);  // three joints in three views
  EXPECT_EQ(document.select_nodes("//path[@class='axis']").size(), 2u * 3);
}

TEST(MillDrawing, AnAxisStandsWhereTheChainSays) {
  // Up by 20 mm, then a turn about x: the axis is level, 20 mm above the ground's origin.
  const auto document = drawn("planetary.toml",
      {"mill={type=\"chain\",joint=[{translate=[0,\"20 mm\",0]},{rotate=\"x\",speed=\"60 "
       "rpm\"}]}"});
  const auto arm = points_of(first(document, "arm")), axis = points_of(first(document, "axis"));
  const auto [pixels, metres] = bar_of(document);
  ASSERT_EQ(arm.size(), 2u);
  ASSERT_EQ(axis.size(), 2u);
  EXPECT_NEAR((arm[0].second - arm[1].second) * metres / pixels, 0.02, 2e-4);
  EXPECT_NEAR(axis[0].second, axis[1].second, 0.02);
  EXPECT_NEAR(axis[0].second, arm[1].second, 0.02);
}

TEST(MillDrawing, TheVesselHasItsSize) {
  const auto document = drawn("demo.toml", {"mill={type=\"still\"}"});
  const auto outline = points_of(first(document, "vessel"));
  double left = 1e9, right = 0, top = 1e9, bottom = 0;
  for (const auto& [x, y] : outline)
    left = std::min(left, x), right = std::max(right, x), top = std::min(top, y),
    bottom = std::max(bottom, y);
  const auto [pixels, metres] = bar_of(document);
  const double area = (right - left) * (bottom - top) * metres / pixels * metres / pixels;
  EXPECT_NEAR(area, 0.038 * 0.057, 3e-3 * area);  // seen from the side
}

}  // namespace
