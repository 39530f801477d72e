#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <pugixml.hpp>
#include <sstream>

#include "output/scene.hpp"

namespace edmill::output {

namespace {

std::string numbers(std::initializer_list<double> list) {
  std::string text;
  for (const double x : list) text += fmt::format("{}{}", text.empty() ? "" : " ", x);
  return text;
}
std::string triple(const Vec3<double>& v) { return numbers({v[0], v[1], v[2]}); }

pugi::xml_node add(pugi::xml_node parent, const char* name,
                   std::initializer_list<std::pair<const char*, std::string>> attributes = {}) {
  auto node = parent.append_child(name);
  for (const auto& [key, value] : attributes) node.append_attribute(key) = value.c_str();
  return node;
}

void add_look(pugi::xml_node shape, const casefile::Colour& c, double transparency = 0) {
  auto material = add(add(shape, "Appearance"), "Material", {{"diffuseColor", numbers({c[0], c[1], c[2]})}});
  if (transparency > 0) material.append_attribute("transparency") = numbers({transparency}).c_str();
}

void add_ball(pugi::xml_node parent, const SceneBall& ball, const std::string& name = "") {
  auto place = add(parent, "Transform", {{"translation", triple(ball.position)}});
  if (!name.empty()) place.append_attribute("DEF") = name.c_str();
  auto shape = add(place, "Shape");
  add_look(shape, ball.colour);
  add(shape, "Sphere", {{"radius", numbers({ball.radius})}});
}

/// Axis and angle.
std::string rotation(const Frame<double>& frame) {
  Eigen::Matrix3d axes;
  axes << frame.x, frame.y, frame.z;
  const Eigen::AngleAxisd turn(axes);
  return triple(turn.axis()) + " " + numbers({turn.angle()});
}

void add_wall(pugi::xml_node parent, const model::Mesh& wall, const casefile::Colour& colour) {
  auto shape = add(parent, "Shape");
  add_look(shape, colour, 0.7);
  std::string corners, points;
  for (const auto& face : wall.faces) {
    for (const int corner : face) corners += fmt::format("{} ", corner);
    corners += "-1 ";
  }
  for (const auto& point : wall.points) points += triple(point) + " ";
  // Faces of one curved wall meet at less than the crease angle and look smooth.
  auto faces =
      add(shape, "IndexedFaceSet", {{"solid", "false"}, {"creaseAngle", "0.5"}, {"coordIndex", corners}});
  add(faces, "Coordinate", {{"point", points}});
}

std::string name_of_wall(std::size_t wall) { return fmt::format("wall_{}", wall); }

/// A wall that moves in the vessel has a Transform of its own.
void add_vessel(pugi::xml_node parent, const SceneVessel& vessel, const SceneMotion* motion) {
  auto place = add(parent, "Transform",
                   {{"DEF", "vessel"},
                    {"translation", triple(vessel.frame.origin)},
                    {"rotation", rotation(vessel.frame)}});
  for (std::size_t id = 0; id < vessel.walls.size(); ++id) {
    const bool moves = motion && std::any_of(motion->pistons.begin(), motion->pistons.end(),
                                             [&](const auto& piston) { return piston.first == id; });
    add_wall(moves ? add(place, "Transform", {{"DEF", name_of_wall(id)}}) : place, vessel.walls[id],
             vessel.colour);
  }
}

void add_route(pugi::xml_node scene, const std::string& from, const char* from_field, const std::string& to,
               const char* to_field) {
  add(scene, "ROUTE", {{"fromNode", from}, {"fromField", from_field}, {"toNode", to}, {"toField", to_field}});
}

/// `keys` and `values` of an interpolator that drives one field of the node `target`.
void add_interpolator(pugi::xml_node scene, const char* type, const std::string& name,
                      const std::string& target, const char* field, const std::string& keys,
                      const std::string& values) {
  add(scene, type, {{"DEF", name}, {"key", keys}, {"keyValue", values}});
  add_route(scene, "clock", "fraction_changed", name, "set_fraction");
  add_route(scene, name, "value_changed", target, field);
}

void add_path(pugi::xml_node scene, const SceneMotion::Path& path, const std::string& target) {
  std::string keys, places;
  for (const auto& [key, place] : path) {
    keys += fmt::format("{} ", key);
    places += triple(place) + " ";
  }
  add_interpolator(scene, "PositionInterpolator", target + "_path", target, "set_translation", keys, places);
}

void add_motion(pugi::xml_node scene, const SceneMotion& motion) {
  add(scene, "TimeSensor",
      {{"DEF", "clock"}, {"cycleInterval", numbers({motion.duration})}, {"loop", "true"}});
  SceneMotion::Path places;
  std::string keys, turns;
  for (const auto& [key, frame] : motion.vessel) {
    places.emplace_back(key, frame.origin);
    keys += fmt::format("{} ", key);
    turns += rotation(frame) + " ";
  }
  add_path(scene, places, "vessel");
  add_interpolator(scene, "OrientationInterpolator", "vessel_turn", "vessel", "set_rotation", keys, turns);
  for (const auto& [wall, path] : motion.pistons) add_path(scene, path, name_of_wall(wall));
  for (std::size_t i = 0; i < motion.balls.size(); ++i)
    add_path(scene, motion.balls[i], fmt::format("ball_{}", i));
  if (!motion.contact.empty()) add_path(scene, motion.contact, "contact_point");
}

std::string text_of(const pugi::xml_document& document) {
  std::ostringstream out;
  document.save(out, " ", pugi::format_indent);
  return out.str();
}

}  // namespace

std::string x3d_text(const Scene& s, const SceneMotion* motion) {
  pugi::xml_document document;
  auto declaration = document.append_child(pugi::node_declaration);
  declaration.append_attribute("version") = "1.0";
  declaration.append_attribute("encoding") = "UTF-8";
  document.append_child(pugi::node_doctype)
      .set_value(
          "X3D PUBLIC \"ISO//Web3D//DTD X3D 3.3//EN\" "
          "\"http://www.web3d.org/specifications/x3d-3.3.dtd\"");
  auto x3d = add(document, "X3D", {{"profile", "Interchange"}, {"version", "3.3"}});
  auto head = add(x3d, "head");
  add(head, "meta", {{"name", "generator"}, {"content", "edmill"}});
  add(head, "meta",
      {{"name", "description"}, {"content", fmt::format("Ball mill at {} s; lengths in metres", s.time)}});
  auto scene = add(x3d, "Scene");
  add(scene, "Background", {{"skyColor", "1 1 1"}});
  add(scene, "Viewpoint",
      {{"description", "mill"}, {"position", triple(s.eye)}, {"centerOfRotation", triple(s.target)}});
  add_vessel(scene, s.vessel, motion);
  for (std::size_t i = 0; i < s.balls.size(); ++i) add_ball(scene, s.balls[i], fmt::format("ball_{}", i));
  if (s.contact) add_ball(scene, *s.contact, "contact_point");
  if (motion) add_motion(scene, *motion);
  return text_of(document);
}

}  // namespace edmill::output
