// A mill's motion drawn as a picture.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <pugixml.hpp>
#include <vector>

#include "plot/chart.hpp"
#include "report/report_page.hpp"

namespace edmill::report {

namespace {

using model::ChainMotion;
using plot::add;
using plot::pixel;
using Points = std::vector<Vec3<double>>;
using Flat = plot::Points::value_type;

/// Which axes point to the right and up.
struct View {
  const char* title;
  int right, up;
  double sign;  ///< of the direction that points up

  Flat of(const Vec3<double>& p) const { return {p[right], sign * p[up]}; }
};
constexpr std::array views = {View{"along z: x to the right, y up", 0, 1, 1},
    View{"along x: z to the right, y up", 2, 1, 1},
    View{"along y: x to the right, z down", 0, 2, -1}};

constexpr double panel = 260, margin = 24, heading = 28;  // [px]
constexpr int samples = 360;

constexpr const char* style = R"(
  text { font: 12px sans-serif; fill: #222; } .vessel { fill: #0b6cab; fill-opacity: 0.25; stroke: #0b6cab; }
  .later { fill: none; stroke: #8fb8d6; } .path { fill: none; stroke: #c2410c; } .point { fill: none; stroke: #15803d; }
  .axis { stroke: #444; stroke-dasharray: 5 3; } .arm { stroke: #444; stroke-width: 2; } .joint { fill: #444; })";

struct JointMark {
  bool rotates;
  Vec3<double> from, to;  ///< an axis passes through `from` towards `to`; an arm joins them
};

struct Pictured {
  std::array<Points, 4> vessel;  ///< corners at the quarters of a period, from time 0
  Points centre, point;
  std::vector<JointMark> joints;
};

Points corners_of(const model::AnyVessel<double>& vessel) {
  Points points;
  for (const auto& wall : vessel.surfaces())
    for (const auto& ring : wall.rings()) points.insert(points.end(), ring.begin(), ring.end());
  return points;
}

std::vector<JointMark> joints_of(const ChainMotion<double>& chain, double size) {
  const Instant<double> start{};
  std::vector<JointMark> marks;
  model::Joints<double> before{{}, chain.period()};
  for (const auto& joint : chain.joints().list) {
    const auto here = ChainMotion<double>(before).pose(start);
    before.list.push_back(joint);
    const auto behind = ChainMotion<double>(before).pose(start);
    if (joint.rotates) {
      const Vec3<double> axis = ChainMotion<double>::direction_to_inertial(
          here, {joint.axis[0], joint.axis[1], joint.axis[2]});
      marks.push_back({true, here.centre, here.centre + axis * (size / norm<double>(axis))});
    } else {
      marks.push_back({false, here.centre, behind.centre});
    }
  }
  return marks;
}

Pictured picture(const model::Mill<double>& mill) {
  Pictured p;
  const auto corners = corners_of(mill.vessel);
  const auto farthest = *std::ranges::max_element(
      corners, {}, [](const auto& corner) { return squared_norm<double>(corner); });
  for (int k = 0; k <= samples; ++k) {
    const auto pose = mill.motion.pose(Instant<double>{0, mill.motion.period() * k / samples});
    p.centre.push_back(mill.motion.to_inertial(pose, Vec3<double>::Zero()));
    p.point.push_back(mill.motion.to_inertial(pose, farthest));
    if (k % (samples / 4) == 0 && k < samples)
      for (const auto& corner : corners)
        p.vessel[k / (samples / 4)].push_back(mill.motion.to_inertial(pose, corner));
  }
  if (const auto* chain = mill.motion.get_if<ChainMotion<double>>())
    p.joints = joints_of(*chain, norm<double>(farthest));
  return p;
}

/// One view in its panel of the drawing.
struct Panel {
  pugi::xml_node svg;
  const View& view;
  double left, scale;
  Flat middle;

  double x(const Flat& p) const {
    return left + margin + panel / 2 + (p.first - middle.first) * scale;
  }
  double y(const Flat& p) const { return heading + panel / 2 - (p.second - middle.second) * scale; }

  plot::Points flat(const Points& points) const {
    plot::Points seen;
    for (const auto& p : points) seen.push_back(view.of(p));
    return seen;
  }
  void path(const char* style, const plot::Points& points, const char* end) {
    std::string d;
    for (const auto& p : points)
      d += fmt::format("{}{} {}", d.empty() ? "M" : "L", pixel(x(p)), pixel(y(p)));
    add(svg, "path", {{"class", style}, {"d", d + end}});
  }
  void line(const char* style, const Points& points) { path(style, flat(points), ""); }
  void outline(const char* style, const Points& points) {
    auto hull = plot::hull_of(flat(points));
    hull.push_back(hull.front());
    path(style, hull, "Z");
  }
  void joint(const JointMark& mark, std::size_t number) {
    const Flat at = view.of(mark.from);
    if (mark.rotates)
      line("axis", {mark.from - (mark.to - mark.from), mark.to});
    else
      line("arm", {mark.from, mark.to});
    add(svg, "circle",
        {{"class", "joint"}, {"cx", pixel(x(at))}, {"cy", pixel(y(at))}, {"r", "3"}});
    // Joints at one place have their numbers side by side.
    add(svg, "text",
        {{"x", pixel(x(at) + 5 + 12 * static_cast<double>(number - 1))}, {"y", pixel(y(at) - 5)}},
        std::to_string(number));
  }
};

/// 1, 2 or 5 times a power of ten, at most a third of the panel [m].
double bar_length(double scale) {
  const double longest = panel / 3 / scale, decade = std::pow(10, std::floor(std::log10(longest)));
  return longest >= 5 * decade ? 5 * decade : longest >= 2 * decade ? 2 * decade : decade;
}

}  // namespace

std::string mill_drawing(const model::Mill<double>& mill) {
  const auto p = picture(mill);
  Points all = p.point;
  for (const auto& vessel : p.vessel) all.insert(all.end(), vessel.begin(), vessel.end());
  for (const auto& mark : p.joints) all.push_back(mark.from);
  Vec3<double> low = all.front(), high = low;
  for (const auto& q : all) {
    low = low.cwiseMin(q);
    high = high.cwiseMax(q);
  }
  const Vec3<double> middle = (low + high) / 2;
  const double scale = panel / (high - low).maxCoeff();

  pugi::xml_document document;
  auto svg = plot::add_drawing(document, "mill", "The mill", "The vessel's motion in three views.",
      3 * (panel + margin) + margin, panel + heading + 3 * margin);
  svg.append_attribute("xmlns") = "http://www.w3.org/2000/svg";
  add(svg, "style", {}, style);
  double left = 0;
  for (const auto& view : views) {
    add(svg, "text", {{"x", pixel(left + margin)}, {"y", "16"}}, view.title);
    Panel drawn{svg, view, left, scale, view.of(middle)};
    for (std::size_t k = p.vessel.size(); k-- > 1;) drawn.outline("later", p.vessel[k]);
    drawn.outline("vessel", p.vessel[0]);
    drawn.line("point", p.point);
    drawn.line("path", p.centre);
    for (std::size_t k = 0; k < p.joints.size(); ++k) drawn.joint(p.joints[k], k + 1);
    left += panel + margin;
  }
  const double bar = bar_length(scale), at = heading + panel + margin;
  add(svg, "path",
      {{"class", "arm"}, {"d", fmt::format("M{} {}h{}", margin, at, pixel(bar * scale))}});
  add(svg, "text", {{"x", pixel(margin + bar * scale + 6)}, {"y", pixel(at + 4)}},
      fmt::format("{:g} mm; filled: the vessel at time 0; red, green: paths of its centre and of a "
                  "point in {:g} s",
          bar * 1000, mill.motion.period()));
  std::ostringstream out;
  document.save(out, " ");
  return out.str();
}

}  // namespace edmill::report
