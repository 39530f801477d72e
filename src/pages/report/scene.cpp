// An animation as part of an HTML page: the frames that its player shows, and a still drawing.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "report/animation.hpp"
#include "report/sections.hpp"

namespace edmill::report {

namespace {

using plot::add;
using Json = nlohmann::json;

/// Places of spheres in all frames together: about 20 bytes each.
constexpr std::size_t most_places = 100000;

/// Adds numbers to a JSON array, rounded to multiples of 1 / steps.
template <class Vector>
void append(Json& array, const Vector& numbers, double steps) {
  for (const double x : numbers) array.push_back(std::round(x * steps) / steps);
}

/// Steps in a millimetre that are less than a pixel from where the viewer stands: 100 from 100 mm to 1 m.
double steps_of(const Animation& animation) {
  const double distance = 1000 * norm<double>(Vec3<double>(animation.eye - animation.target));
  return std::pow(10, 4 - std::floor(std::log10(distance)));
}

Json millimetres(const Vec3<double>& place, double steps) {
  Json array = Json::array();
  append(array, 1000 * place, steps);
  return array;
}

std::size_t frame_count(const Animation& animation) {
  return 1 +
         std::clamp<std::size_t>(most_places / std::max<std::size_t>(1, animation.spheres.size()), 40, 640);
}

double fraction_of(std::size_t frame, std::size_t frames) {
  return static_cast<double>(frame) / static_cast<double>(frames - 1);
}

/// Corners of the triangles of all walls, by their places in the list of all points.
Json triangles_of(const std::vector<model::Mesh>& walls) {
  Json triangles = Json::array();
  int first = 0;
  for (const auto& wall : walls) {
    for (const auto& face : wall.faces)
      for (std::size_t k = 2; k < face.size(); ++k)
        for (const int corner : {face[0], face[k - 1], face[k]}) triangles.push_back(first + corner);
    first += static_cast<int>(wall.points.size());
  }
  return triangles;
}

/// Lists each wall that moves in the vessel: its part of the list of all points, and its shift in each frame.
Json pistons_of(const MovingVessel& vessel, std::size_t frames, double steps) {
  Json pistons = Json::array();
  std::size_t first = 0;
  for (std::size_t wall = 0; wall < vessel.walls.size(); ++wall) {
    const std::size_t count = vessel.walls[wall].points.size();
    if (const auto& shift = vessel.shifts[wall]; shift.keys.size() > 1) {
      Json shifts = Json::array();
      for (std::size_t frame = 0; frame < frames; ++frame)
        append(shifts, 1000 * shift.at(fraction_of(frame, frames)), 10 * steps);
      pistons.push_back({{"first", first}, {"count", count}, {"shifts", std::move(shifts)}});
    }
    first += count;
  }
  return pistons;
}

}  // namespace

void add_frames(pugi::xml_node parent, const Animation& animation) {
  const auto& vessel = animation.vessel;
  const std::size_t frames = frame_count(animation);
  const double steps = steps_of(animation);
  Json points = Json::array(), poses = Json::array(), places = Json::array(), radii = Json::array(),
       colours = Json::array();
  for (const auto& wall : vessel.walls)
    for (const auto& point : wall.points) append(points, 1000 * point, 10 * steps);
  for (const auto& sphere : animation.spheres) {
    radii.push_back(1000 * sphere.radius);
    colours.push_back(sphere.colour);
  }
  for (std::size_t frame = 0; frame < frames; ++frame) {
    const double fraction = fraction_of(frame, frames);
    const auto pose = vessel.pose(fraction);
    append(poses, 1000 * pose.translation(), steps);
    append(poses, Eigen::Quaterniond(pose.rotation()).coeffs(), 1e6);
    for (const auto& sphere : animation.spheres) append(places, 1000 * sphere.place.at(fraction), steps);
  }
  const Json scene = {{"duration", animation.duration},
                      {"eye", millimetres(animation.eye, steps)},
                      {"target", millimetres(animation.target, steps)},
                      {"vessel",
                       {{"points", points},
                        {"triangles", triangles_of(vessel.walls)},
                        {"colour", vessel.colour},
                        {"opacity", vessel.opacity},
                        {"pistons", pistons_of(vessel, frames, steps)},
                        {"poses", poses}}},
                      {"spheres", {{"radii", radii}, {"colours", colours}, {"places", places}}}};
  add(parent, "script", {{"type", "application/json"}, {"id", "frames"}}, scene.dump());
}

void add_still(pugi::xml_node parent, const Animation& animation) {
  const auto& vessel = animation.vessel;
  const auto pose = vessel.pose(0);
  const Vec3<double> centre = pose.translation();
  // In percent of the picture, whose strokes have one width for vessels of any size; y upwards.
  const double reach = 1.25 * vessel.reach(), percent = 50 / reach;
  const auto x = [&](double place) { return percent * (place - centre[0] + reach); };
  const auto y = [&](double place) { return percent * (centre[1] + reach - place); };
  auto svg = add(parent, "svg",
                 {{"class", "still"},
                  {"viewBox", "0 0 100 100"},
                  {"role", "img"},
                  {"aria-label", "The vessel and its balls at the beginning of the animation"}});
  const auto outline = [&](const plot::Points& points) {
    std::string path;
    for (const auto& p : points)
      path += fmt::format("{}{:.2f} {:.2f}", path.empty() ? "M" : "L", x(p.first), y(p.second));
    add(svg, "path", {{"class", "vessel"}, {"d", path + "Z"}});
  };
  plot::Points all;
  std::vector<plot::Points> flat;
  for (const auto& wall : vessel.walls) {
    plot::Points points;
    for (const auto& point : wall.points) {
      const Vec3<double> place = pose * point;
      points.emplace_back(place[0], place[1]);
    }
    all.insert(all.end(), points.begin(), points.end());
    if (wall.faces.size() == 1) flat.push_back(std::move(points));
  }
  outline(plot::hull_of(std::move(all)));
  for (const auto& wall : flat) outline(wall);
  std::vector<std::pair<Vec3<double>, const MovingSphere*>> spheres;
  for (const auto& sphere : animation.spheres) spheres.emplace_back(sphere.place.at(0), &sphere);
  std::stable_sort(spheres.begin(), spheres.end(),
                   [](const auto& a, const auto& b) { return a.first[2] < b.first[2]; });
  for (const auto& [place, sphere] : spheres)
    add(svg, "circle",
        {{"class", "ball"},
         {"cx", fmt::format("{:.2f}", x(place[0]))},
         {"cy", fmt::format("{:.2f}", y(place[1]))},
         {"r", fmt::format("{:.2f}", percent * sphere->radius)},
         {"fill", sphere->colour}});
}

}  // namespace edmill::report
