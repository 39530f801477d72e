#include "report/animation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <pugixml.hpp>
#include <sstream>

#include "base/errors.hpp"

namespace edmill::report {

namespace {

std::vector<double> numbers_of(const pugi::xml_attribute& attribute) {
  std::istringstream text(attribute.as_string());
  std::vector<double> numbers;
  for (double x = 0; text >> x;) numbers.push_back(x);
  return numbers;
}

/// As many numbers as `width`, or nothing where the node has none.
Eigen::VectorXd vector_of(const pugi::xml_node& node, const char* name, Eigen::Index width) {
  const auto numbers = numbers_of(node.attribute(name));
  if (numbers.empty()) return Eigen::VectorXd::Zero(width);
  if (static_cast<Eigen::Index>(numbers.size()) != width)
    throw InputError(fmt::format("found {} numbers, expected {} for '{}' of <{}>", numbers.size(), width,
                                 name, node.name()));
  return Eigen::Map<const Eigen::VectorXd>(numbers.data(), width);
}

/// How a field of a Transform moves: by the interpolator NAME_path of its type, else not at all.
Track track_of(const pugi::xml_node& transform, const char* field, const char* interpolator,
               Eigen::Index width) {
  const std::string name = std::string(transform.attribute("DEF").as_string()) + "_path";
  const auto scene = transform.root().child("X3D").child("Scene");
  const auto path = scene.find_child_by_attribute(interpolator, "DEF", name.c_str());
  if (!path) return {{0}, vector_of(transform, field, width)};
  auto keys = numbers_of(path.attribute("key"));
  const auto values = numbers_of(path.attribute("keyValue"));
  if (keys.empty() || values.size() != keys.size() * static_cast<std::size_t>(width))
    throw InputError(fmt::format("found {} keys and {} numbers in '{}', expected {} numbers for each key",
                                 keys.size(), values.size(), name, width));
  const auto count = static_cast<Eigen::Index>(keys.size());
  return {std::move(keys), Eigen::Map<const Eigen::MatrixXd>(values.data(), width, count)};
}

Track place_of(const pugi::xml_node& transform) {
  return track_of(transform, "translation", "PositionInterpolator", 3);
}

Joint joint_of(const pugi::xml_node& transform) {
  return {place_of(transform), track_of(transform, "rotation", "OrientationInterpolator", 4)};
}

pugi::xml_node material_of(const pugi::xml_node& shape) {
  return shape.child("Appearance").child("Material");
}

std::string colour_of(const pugi::xml_node& shape) {
  const Eigen::VectorXd c = vector_of(material_of(shape), "diffuseColor", 3);
  const auto part = [&](Eigen::Index k) { return static_cast<int>(std::lround(255 * c[k])); };
  return fmt::format("#{:02x}{:02x}{:02x}", part(0), part(1), part(2));
}

MovingVessel vessel_of(const pugi::xml_node& outermost) {
  MovingVessel vessel{};
  pugi::xml_node innermost;
  for (auto transform = outermost; transform; transform = transform.child("Transform")) {
    vessel.joints.push_back(joint_of(transform));
    innermost = transform;
  }
  const auto shape = innermost.child("Shape");
  vessel.radius = shape.child("Cylinder").attribute("radius").as_double();
  vessel.height = shape.child("Cylinder").attribute("height").as_double();
  vessel.colour = colour_of(shape);
  vessel.opacity = 1 - material_of(shape).attribute("transparency").as_double();
  return vessel;
}

Animation animation_of(const pugi::xml_node& scene) {
  const auto vessel = scene.find_child_by_attribute("Transform", "DEF", "theta");
  if (!scene.child("TimeSensor") || !vessel)
    throw InputError("found X3D without moving vessel, expected an animation");
  const auto view = scene.child("Viewpoint");
  Animation animation{scene.child("TimeSensor").attribute("cycleInterval").as_double(),
                      vector_of(view, "position", 3),
                      vector_of(view, "centerOfRotation", 3),
                      vessel_of(vessel),
                      {}};
  for (const auto& transform : scene.children("Transform")) {
    const auto shape = transform.child("Shape");
    if (const auto sphere = shape.child("Sphere"))
      animation.spheres.push_back(
          {sphere.attribute("radius").as_double(), colour_of(shape), place_of(transform)});
  }
  return animation;
}

}  // namespace

Eigen::VectorXd Track::at(double fraction) const {
  const auto after = std::upper_bound(keys.begin(), keys.end(), fraction);
  if (after == keys.begin()) return values.col(0);
  const auto k = static_cast<Eigen::Index>(after - keys.begin()) - 1;
  if (after == keys.end()) return values.col(k);
  const double begin = *(after - 1), share = (fraction - begin) / (*after - begin);
  return (1 - share) * values.col(k) + share * values.col(k + 1);
}

Eigen::Isometry3d Joint::pose(double fraction) const {
  const Vec3<double> place = translation.at(fraction);
  const Eigen::Vector4d turn = rotation.at(fraction);
  return Eigen::Translation3d(place) * Eigen::AngleAxisd(turn[3], turn.head<3>());
}

Eigen::Isometry3d MovingVessel::pose(double fraction) const {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (const auto& joint : joints) pose = pose * joint.pose(fraction);
  return pose;
}

Animation read_animation(const std::filesystem::path& file) {
  pugi::xml_document document;
  const auto result = document.load_file(file.c_str());
  if (!result)
    throw InputError(fmt::format("{}: found no valid XML at byte {} ({}), expected an animation",
                                 file.string(), result.offset, result.description()));
  try {
    return animation_of(document.child("X3D").child("Scene"));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file.string(), error.what()));
  }
}

}  // namespace edmill::report
