#include "report/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "base/errors.hpp"
#include "plot/markup.hpp"

namespace edmill::report {

namespace {

using plot::add;

std::vector<double> numbers_of(const pugi::xml_attribute& attribute) {
  std::istringstream text(attribute.as_string());
  std::vector<double> numbers;
  for (double x = 0; text >> x;) numbers.push_back(x);
  return numbers;
}

/// Key frames of an interpolator, thinned and rounded: 0.01 mm is less than a pixel.
void copy_path(pugi::xml_node target, const pugi::xml_node& source, std::size_t most_keys) {
  const auto keys = numbers_of(source.attribute("key")), values = numbers_of(source.attribute("keyValue"));
  if (keys.empty() || values.size() % keys.size() != 0) return;
  const std::size_t width = values.size() / keys.size(), step = 1 + (keys.size() - 1) / most_keys;
  std::string key_text, value_text;
  for (std::size_t k = 0; k < keys.size(); k += step) {
    if (k + step >= keys.size()) k = keys.size() - 1;  // the last one always
    key_text += fmt::format("{:.5g} ", keys[k]);
    for (std::size_t c = 0; c < width; ++c) value_text += fmt::format("{:.5f} ", values[k * width + c]);
  }
  target.append_attribute("key") = key_text.c_str();
  target.append_attribute("keyValue") = value_text.c_str();
}

/// How much of a scene a page can bear.
struct Limits {
  std::size_t keys;              ///< of each path
  const char* sphere_divisions;  ///< of longitude and latitude
};

void copy(pugi::xml_node parent, const pugi::xml_node& source, const Limits& limits) {
  const std::string name = source.name();
  if (name == "Background") return;  // the page's own shows
  auto target = parent.append_child(name.c_str());
  const bool path = name.ends_with("Interpolator");
  for (const auto& attribute : source.attributes()) {
    const std::string key = attribute.name();
    if (!path || (key != "key" && key != "keyValue")) target.append_copy(attribute);
  }
  if (name == "Viewpoint") target.append_attribute("fieldOfView") = "0.6";  // the swing just fills it
  if (name == "Sphere") target.append_attribute("subdivision") = limits.sphere_divisions;
  if (path) copy_path(target, source, limits.keys);
  for (const auto& child : source.children()) copy(target, child, limits);
}

struct Point {
  double x, y, z;
};

Point point_of(const pugi::xml_attribute& attribute) {
  const auto n = numbers_of(attribute);
  return n.size() == 3 ? Point{n[0], n[1], n[2]} : Point{0, 0, 0};
}

double angle_of(const pugi::xml_node& transform) {
  const auto n = numbers_of(transform.attribute("rotation"));
  return n.size() == 4 ? n[3] : 0;
}

/// The vessel as it stands in the first frame: places of its own frame in the inertial one.
struct Vessel {
  double theta, gamma, arm, radius, half_height;

  Point place(double x, double y, double z) const {
    const double y1 = y * std::cos(gamma) - z * std::sin(gamma),
                 z1 = y * std::sin(gamma) + z * std::cos(gamma);
    const double x1 = x + arm;
    return {x1 * std::cos(theta) - y1 * std::sin(theta), x1 * std::sin(theta) + y1 * std::cos(theta), z1};
  }
};

Vessel vessel_of(const pugi::xml_node& scene) {
  const auto swing = scene.find_child_by_attribute("Transform", "DEF", "theta");
  const auto arm = swing.child("Transform"), tilt = arm.child("Transform");
  const auto cylinder = tilt.child("Shape").child("Cylinder");
  return {angle_of(swing), angle_of(tilt), point_of(arm.attribute("translation")).x,
          cylinder.attribute("radius").as_double(), cylinder.attribute("height").as_double() / 2};
}

std::string colour_of(const pugi::xml_node& shape) {
  const auto c = numbers_of(shape.child("Appearance").child("Material").attribute("diffuseColor"));
  if (c.size() != 3) return "#888888";
  const auto part = [&](std::size_t k) { return static_cast<int>(std::lround(255 * c[k])); };
  return fmt::format("#{:02x}{:02x}{:02x}", part(0), part(1), part(2));
}

}  // namespace

pugi::xml_document read_animation(const std::filesystem::path& file) {
  pugi::xml_document document;
  const auto result = document.load_file(file.c_str());
  if (!result)
    throw InputError(fmt::format("{}: found no valid XML at byte {} ({}), expected an animation",
                                 file.string(), result.offset, result.description()));
  const auto scene = document.child("X3D").child("Scene");
  if (!scene.child("TimeSensor") || !scene.find_child_by_attribute("Transform", "DEF", "theta"))
    throw InputError(file.string() + ": found X3D without moving vessel, expected an animation");
  return document;
}

void add_scene(pugi::xml_node parent, const pugi::xml_document& animation, std::size_t most_keys) {
  const auto scene = animation.child("X3D").child("Scene");
  std::size_t paths = 0;
  for (const auto& child : scene.children())
    paths += std::string_view(child.name()) == "PositionInterpolator";
  auto x3d = add(parent, "x3d",
                 {{"id", "scene"}, {"disableKeys", "true"}, {"showLog", "false"}, {"showStat", "false"}});
  auto target = add(x3d, "scene");
  add(target, "NavigationInfo", {{"type", "EXAMINE"}});
  const Limits limits{std::max<std::size_t>(16, most_keys / std::max<std::size_t>(1, paths)),
                      paths > 200 ? "10 10" : "24 24"};
  for (const auto& child : scene.children()) copy(target, child, limits);
}

void add_still(pugi::xml_node parent, const pugi::xml_document& animation) {
  const auto scene = animation.child("X3D").child("Scene");
  const Vessel vessel = vessel_of(scene);
  const Point centre = vessel.place(0, 0, 0);
  const double reach = 1.25 * std::hypot(vessel.radius, vessel.half_height);
  // In millimetres, y upwards.
  const auto x = [&](double value) { return 1000 * (value - centre.x + reach); };
  const auto y = [&](double value) { return 1000 * (centre.y + reach - value); };
  auto svg = add(parent, "svg",
                 {{"class", "still"},
                  {"viewBox", fmt::format("0 0 {0:.1f} {0:.1f}", 2000 * reach)},
                  {"role", "img"},
                  {"aria-label", "The vessel and its balls at the beginning of the animation"}});
  const auto outline = [&](const std::vector<Point>& points, const char* style) {
    std::string path;
    for (const auto& p : points)
      path += fmt::format("{}{:.2f} {:.2f}", path.empty() ? "M" : "L", x(p.x), y(p.y));
    add(svg, "path", {{"class", style}, {"d", path + "Z"}});
  };
  std::vector<std::vector<Point>> caps(2);
  for (std::size_t cap = 0; cap < 2; ++cap)
    for (int k = 0; k < 60; ++k) {
      const double angle = k * 3.14159265358979 / 30;
      caps[cap].push_back(vessel.place(vessel.radius * std::cos(angle),
                                       cap == 0 ? -vessel.half_height : vessel.half_height,
                                       vessel.radius * std::sin(angle)));
    }
  outline({caps[0][0], caps[0][30], caps[1][30], caps[1][0]}, "vessel");
  for (const auto& cap : caps) outline(cap, "vessel");
  std::vector<std::pair<double, pugi::xml_node>> balls;
  for (const auto& transform : scene.children("Transform"))
    if (std::string_view(transform.attribute("DEF").as_string()).starts_with("ball_"))
      balls.emplace_back(point_of(transform.attribute("translation")).z, transform);
  std::sort(balls.begin(), balls.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [depth, transform] : balls) {
    const Point place = point_of(transform.attribute("translation"));
    const auto shape = transform.child("Shape");
    add(svg, "circle",
        {{"class", "ball"},
         {"cx", fmt::format("{:.2f}", x(place.x))},
         {"cy", fmt::format("{:.2f}", y(place.y))},
         {"r", fmt::format("{:.2f}", 1000 * shape.child("Sphere").attribute("radius").as_double())},
         {"fill", colour_of(shape)}});
  }
}

}  // namespace edmill::report
