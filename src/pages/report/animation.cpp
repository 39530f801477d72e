#include "report/animation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <sstream>

#include "base/errors.hpp"
#include "report/sections.hpp"

namespace edmill::report {

namespace {

using Json = nlohmann::json;

std::vector<double> numbers_of(const pugi::xml_attribute& attribute) {
  std::istringstream text(attribute.as_string());
  return {std::istream_iterator<double>(text), {}};
}

/// An attribute with `width` numbers; zeros if it is absent.
Eigen::VectorXd vector_of(const pugi::xml_node& node, const char* name, Eigen::Index width) {
  const auto numbers = numbers_of(node.attribute(name));
  if (numbers.empty()) return Eigen::VectorXd::Zero(width);
  if (static_cast<Eigen::Index>(numbers.size()) != width)
    throw InputError(fmt::format("found {} numbers, expected {} for '{}' of <{}>", numbers.size(),
        width, name, node.name()));
  return Eigen::Map<const Eigen::VectorXd>(numbers.data(), width);
}

/// The values of a field of a Transform during the playback: those of its interpolator, NAME_path
/// or NAME_turn, or a constant without one.
Track track_of(const pugi::xml_node& transform, const char* field, const char* interpolator,
    const char* ending, Eigen::Index width) {
  const std::string name = std::string(transform.attribute("DEF").as_string()) + ending;
  const auto scene = transform.root().child("X3D").child("Scene");
  const auto path = scene.find_child_by_attribute(interpolator, "DEF", name.c_str());
  if (!path) return {{0}, vector_of(transform, field, width)};
  auto keys = numbers_of(path.attribute("key"));
  const auto values = numbers_of(path.attribute("keyValue"));
  if (keys.empty() || values.size() != keys.size() * static_cast<std::size_t>(width))
    throw InputError(
        fmt::format("found {} keys and {} numbers in '{}', expected {} numbers for each key",
            keys.size(), values.size(), name, width));
  const auto count = static_cast<Eigen::Index>(keys.size());
  return {std::move(keys), Eigen::Map<const Eigen::MatrixXd>(values.data(), width, count)};
}

Track place_of(const pugi::xml_node& transform) {
  return track_of(transform, "translation", "PositionInterpolator", "_path", 3);
}

pugi::xml_node material_of(const pugi::xml_node& shape) {
  return shape.child("Appearance").child("Material");
}

std::string colour_of(const pugi::xml_node& shape) {
  const Eigen::VectorXd c = vector_of(material_of(shape), "diffuseColor", 3);
  const auto part = [&](Eigen::Index k) { return static_cast<int>(std::lround(255 * c[k])); };
  return fmt::format("#{:02x}{:02x}{:02x}", part(0), part(1), part(2));
}

model::Mesh mesh_of(const pugi::xml_node& faces) {
  model::Mesh mesh;
  const auto points = numbers_of(faces.child("Coordinate").attribute("point"));
  if (points.size() % 3 != 0)
    throw InputError(fmt::format(
        "found {} numbers in the points of a wall, expected 3 for each", points.size()));
  for (std::size_t k = 0; k < points.size(); k += 3)
    mesh.points.emplace_back(points[k], points[k + 1], points[k + 2]);
  mesh.faces.emplace_back();
  for (const double number : numbers_of(faces.attribute("coordIndex"))) {
    if (!(number < static_cast<double>(mesh.points.size())))
      throw InputError(fmt::format("found corner {} of a wall, expected less than its {} points",
          number, mesh.points.size()));
    if (number < 0)
      mesh.faces.emplace_back();
    else
      mesh.faces.back().push_back(static_cast<int>(number));
  }
  mesh.faces.pop_back();  // each face ends with -1
  return mesh;
}

MovingVessel vessel_of(const pugi::xml_node& transform) {
  const auto shape_of = [](const pugi::xml_node& wall) {
    return wall.child("Shape") ? wall.child("Shape") : wall;  // a piston has a Transform around it
  };
  const auto first = shape_of(transform.first_child());
  MovingVessel vessel{{}, {}, colour_of(first),
      1 - material_of(first).attribute("transparency").as_double(), place_of(transform),
      track_of(transform, "rotation", "OrientationInterpolator", "_turn", 4)};
  for (const auto& wall : transform.children()) {
    vessel.walls.push_back(mesh_of(shape_of(wall).child("IndexedFaceSet")));
    vessel.shifts.push_back(place_of(wall));
  }
  return vessel;
}

Animation animation_of(const pugi::xml_node& scene) {
  const auto vessel = scene.find_child_by_attribute("Transform", "DEF", "vessel");
  if (!scene.child("TimeSensor") || !vessel)
    throw InputError("found X3D without moving vessel, expected an animation");
  const auto view = scene.child("Viewpoint");
  Animation animation{scene.child("TimeSensor").attribute("cycleInterval").as_double(),
      vector_of(view, "position", 3), vector_of(view, "centerOfRotation", 3), vessel_of(vessel), {},
      {}};
  for (const auto& transform : scene.children("Transform")) {
    const auto shape = transform.child("Shape");
    if (std::string_view(transform.attribute("DEF").as_string()).starts_with("body_"))
      animation.bodies.push_back(vessel_of(transform));
    if (const auto sphere = shape.child("Sphere"))
      animation.spheres.push_back(
          {sphere.attribute("radius").as_double(), colour_of(shape), place_of(transform)});
  }
  return animation;
}

/// Largest number of sphere positions in all frames together; each takes about 20 bytes.
constexpr std::size_t most_places = 100000;

/// Adds numbers to a JSON array, rounded to multiples of 1 / steps.
template <class Vector> void append(Json& array, const Vector& numbers, double steps) {
  for (const double x : numbers) array.push_back(std::round(x * steps) / steps);
}

/// Steps per millimetre to which positions are rounded, so that a step is less than a pixel for the
/// viewer: 100 at distances from 100 mm to 1 m.
double steps_of(const Animation& animation) {
  const double distance = 1000 * norm<double>(Vec3<double>(animation.eye - animation.target));
  return std::pow(10, 4 - std::floor(std::log10(distance)));
}

Json millimetres(const Vec3<double>& place, double steps) {
  Json array = Json::array();
  append(array, 1000 * place, steps);
  return array;
}

/// The fraction of the playback at each frame.
std::vector<double> fractions_of(const Animation& animation) {
  const auto steps = std::clamp<std::size_t>(
      most_places / std::max<std::size_t>(1, animation.spheres.size()), 40, 640);
  std::vector<double> fractions;
  for (std::size_t frame = 0; frame <= steps; ++frame)
    fractions.push_back(static_cast<double>(frame) / static_cast<double>(steps));
  return fractions;
}

/// Each wall: its corners, and how it moves in the vessel in each frame, if it does.
Json walls_of(const MovingVessel& vessel, const std::vector<double>& fractions, double steps) {
  Json walls = Json::array();
  for (std::size_t k = 0; k < vessel.walls.size(); ++k) {
    Json points = Json::array(), shifts = Json::array();
    for (const auto& point : vessel.walls[k].points)
      points.push_back(millimetres(point, 10 * steps));
    walls.push_back({{"points", std::move(points)}, {"flat", vessel.walls[k].faces.size() == 1}});
    if (vessel.shifts[k].keys.size() < 2) continue;
    for (const double fraction : fractions)
      append(shifts, 1000 * vessel.shifts[k].at(fraction), 10 * steps);
    walls.back()["shifts"] = std::move(shifts);
  }
  return walls;
}

/// Adds <script type="application/json" id="frames">, which page.js plays. Lengths in millimetres:
///   {duration, eye, target,
///    vessel: {walls: [{points, flat, shifts}], colour, opacity, poses: [x, y, z, qx, qy, qz, qw of
///    each frame]}, bodies: [{points, colour, poses}], spheres: {radii, colours, places: [x, y, z
///    of each sphere, frame by frame]}}
/// Frames divide the playback into equal parts, from its beginning to its end.
void add_frames(pugi::xml_node parent, const Animation& animation) {
  const auto& vessel = animation.vessel;
  const auto fractions = fractions_of(animation);
  const double steps = steps_of(animation);
  Json poses = Json::array(), places = Json::array(), radii = Json::array(),
       colours = Json::array();
  for (const auto& sphere : animation.spheres) {
    radii.push_back(1000 * sphere.radius);
    colours.push_back(sphere.colour);
  }
  const auto append_pose = [&](Json& list, const Eigen::Isometry3d& pose) {
    append(list, 1000 * pose.translation(), steps);
    append(list, Eigen::Quaterniond(pose.rotation()).coeffs(), 1e6);
  };
  Json bodies = Json::array();
  for (const auto& body : animation.bodies) {
    Json own = Json::array();
    for (const double fraction : fractions) append_pose(own, body.pose(fraction));
    bodies.push_back({{"points", walls_of(body, fractions, steps)[0]["points"]},
        {"colour", body.colour}, {"poses", own}});
  }
  for (const double fraction : fractions) {
    append_pose(poses, vessel.pose(fraction));
    for (const auto& sphere : animation.spheres)
      append(places, 1000 * sphere.place.at(fraction), steps);
  }
  const Json scene = {{"duration", animation.duration}, {"eye", millimetres(animation.eye, steps)},
      {"target", millimetres(animation.target, steps)},
      {"vessel",
          {{"walls", walls_of(vessel, fractions, steps)}, {"colour", vessel.colour},
              {"opacity", vessel.opacity}, {"poses", poses}}},
      {"bodies", bodies},
      {"spheres", {{"radii", radii}, {"colours", colours}, {"places", places}}}};
  add(parent, "script", {{"type", "application/json"}, {"id", "frames"}}, scene.dump());
}

/// The speed of the playback in words; 1 is real time.
std::string pace(double speed) {
  const double factor = std::max(speed, 1 / speed);
  if (factor < 1.05) return "In real time";
  return fmt::format("{} {} times", speed > 1 ? "Sped up" : "Slowed down", readable(factor, 2));
}

/// The controls. The slider counts milliseconds in the mill.
void add_player(pugi::xml_node section, const Animation& animation, double speed) {
  auto player = add(section, "div", {{"id", "player"}});
  auto controls = add(player, "div", {{"class", "controls"}});
  add(controls, "button", {{"type", "button"}, {"id", "play"}}, "Play");
  add(controls, "input",
      {{"type", "range"}, {"id", "time"}, {"min", "0"},
          {"max", fmt::format("{}", 1000 * animation.duration * speed)}, {"step", "any"},
          {"autocomplete", "off"}, {"value", "0"},
          {"aria-label", "Time from the beginning of the animation"}});
  add(controls, "span", {{"id", "clock"}, {"aria-hidden", "true"}}, "0.0 ms");
  auto ride = add(player, "label");
  add(ride, "input", {{"type", "checkbox"}, {"id", "ride"}, {"autocomplete", "off"}});
  add(ride, "span", {}, " ride with the jar");
  add_note(player,
      pace(speed) +
          ". The mark on the jar shows how it turns, the dashed line the way of its middle. "
          "Drag to rotate, scroll to zoom; by keyboard the arrows, + and -.");
}

}  // namespace

Track::Between Track::between(double fraction) const {
  const auto next = std::upper_bound(keys.begin(), keys.end(), fraction);
  const auto after = static_cast<Eigen::Index>(next - keys.begin());
  if (next == keys.begin()) return {0, 0, 0};
  if (next == keys.end()) return {after - 1, after - 1, 0};
  return {after - 1, after, (fraction - *(next - 1)) / (*next - *(next - 1))};
}

Eigen::VectorXd Track::at(double fraction) const {
  const auto [before, after, share] = between(fraction);
  return (1 - share) * values.col(before) + share * values.col(after);
}

Eigen::Isometry3d MovingVessel::pose(double fraction) const {
  const auto [before, after, share] = turn.between(fraction);
  const auto turned = [&](Eigen::Index key) {
    return Eigen::Quaterniond(
        Eigen::AngleAxisd(turn.values(3, key), turn.values.col(key).head<3>()));
  };
  const Vec3<double> origin = place.at(fraction);
  return Eigen::Translation3d(origin) * turned(before).slerp(share, turned(after));
}

Animation read_animation(const std::filesystem::path& file) {
  pugi::xml_document document;
  const auto result = document.load_file(file.c_str());
  if (!result)
    throw InputError(fmt::format("{}: invalid XML at byte {} ({}), expected an animation",
        file.string(), result.offset, result.description()));
  try {
    return animation_of(document.child("X3D").child("Scene"));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file.string(), error.what()));
  }
}

void add_animation(pugi::xml_node main, const RunFolder& run) {
  auto section = add_section(main, "animation", "The mill in motion");
  const auto* output = run.output("animation", [](const auto&) { return true; });
  if (!output) return add_missing(section, "animation", "type = \"animation\"");
  const auto animation = read_animation(run.file_of(*output));
  add(section, "div", {{"class", "stage"}});
  add_frames(section, animation);
  add_player(section, animation, output->animation.speed.to<double>());
}

}  // namespace edmill::report
