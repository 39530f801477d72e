#include "report/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "plot/markup.hpp"

namespace edmill::report {

namespace {

using plot::add;
using Json = nlohmann::json;

/// Places of spheres in all frames together: about 20 bytes each.
constexpr std::size_t most_places = 100000;

/// Adds numbers to a JSON array, rounded: 0.01 mm is less than a pixel.
template <class Vector>
void append(Json& array, const Vector& numbers, double steps) {
  for (const double x : numbers) array.push_back(std::round(x * steps) / steps);
}

Json millimetres(const Vec3<double>& place) {
  Json array = Json::array();
  append(array, 1000 * place, 100);
  return array;
}

std::size_t frame_count(const Animation& animation) {
  return 1 +
         std::clamp<std::size_t>(most_places / std::max<std::size_t>(1, animation.spheres.size()), 40, 640);
}

}  // namespace

void add_frames(pugi::xml_node parent, const Animation& animation) {
  const auto& vessel = animation.vessel;
  const std::size_t frames = frame_count(animation);
  Json poses = Json::array(), places = Json::array(), radii = Json::array(), colours = Json::array();
  for (const auto& sphere : animation.spheres) {
    radii.push_back(1000 * sphere.radius);
    colours.push_back(sphere.colour);
  }
  for (std::size_t frame = 0; frame < frames; ++frame) {
    const double fraction = static_cast<double>(frame) / static_cast<double>(frames - 1);
    const auto pose = vessel.pose(fraction);
    append(poses, 1000 * pose.translation(), 100);
    append(poses, Eigen::Quaterniond(pose.rotation()).coeffs(), 1e6);
    for (const auto& sphere : animation.spheres) append(places, 1000 * sphere.place.at(fraction), 100);
  }
  const Json scene = {{"duration", animation.duration},
                      {"eye", millimetres(animation.eye)},
                      {"target", millimetres(animation.target)},
                      {"vessel",
                       {{"radius", 1000 * vessel.radius},
                        {"height", 1000 * vessel.height},
                        {"colour", vessel.colour},
                        {"opacity", vessel.opacity},
                        {"poses", poses}}},
                      {"spheres", {{"radii", radii}, {"colours", colours}, {"places", places}}}};
  add(parent, "script", {{"type", "application/json"}, {"id", "frames"}}, scene.dump());
}

void add_still(pugi::xml_node parent, const Animation& animation) {
  const auto& vessel = animation.vessel;
  const auto pose = vessel.pose(0);
  const Vec3<double> centre = pose.translation();
  const double half_height = vessel.height / 2, reach = 1.25 * std::hypot(vessel.radius, half_height);
  // In millimetres, y upwards.
  const auto x = [&](const Vec3<double>& place) { return 1000 * (place[0] - centre[0] + reach); };
  const auto y = [&](const Vec3<double>& place) { return 1000 * (centre[1] + reach - place[1]); };
  auto svg = add(parent, "svg",
                 {{"class", "still"},
                  {"viewBox", fmt::format("0 0 {0:.1f} {0:.1f}", 2000 * reach)},
                  {"role", "img"},
                  {"aria-label", "The vessel and its balls at the beginning of the animation"}});
  const auto outline = [&](const std::vector<Vec3<double>>& points) {
    std::string path;
    for (const auto& p : points) path += fmt::format("{}{:.2f} {:.2f}", path.empty() ? "M" : "L", x(p), y(p));
    add(svg, "path", {{"class", "vessel"}, {"d", path + "Z"}});
  };
  std::vector<Vec3<double>> caps[2];
  for (int k = 0; k < 60; ++k) {
    const double angle = k * 3.14159265358979 / 30, a = vessel.radius * std::cos(angle),
                 b = vessel.radius * std::sin(angle);
    caps[0].push_back(pose * Vec3<double>(a, -half_height, b));
    caps[1].push_back(pose * Vec3<double>(a, half_height, b));
  }
  outline({caps[0][0], caps[0][30], caps[1][30], caps[1][0]});
  for (const auto& cap : caps) outline(cap);
  std::vector<std::pair<Vec3<double>, const MovingSphere*>> spheres;
  for (const auto& sphere : animation.spheres) spheres.emplace_back(sphere.place.at(0), &sphere);
  std::stable_sort(spheres.begin(), spheres.end(),
                   [](const auto& a, const auto& b) { return a.first[2] < b.first[2]; });
  for (const auto& [place, sphere] : spheres)
    add(svg, "circle",
        {{"class", "ball"},
         {"cx", fmt::format("{:.2f}", x(place))},
         {"cy", fmt::format("{:.2f}", y(place))},
         {"r", fmt::format("{:.2f}", 1000 * sphere->radius)},
         {"fill", sphere->colour}});
}

}  // namespace edmill::report
