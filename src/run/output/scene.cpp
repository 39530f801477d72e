#include "output/scene.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <pugixml.hpp>
#include <sstream>

#include "base/clean_text.hpp"

namespace edmill::output {

namespace {

// Field of view of the pictures in the report: 0.6 rad high, 4 to 3. X3D browsers show more.
const double height_at_1 = std::tan(0.3), width_at_1 = 4.0 / 3 * height_at_1;
constexpr double margin = 1.05;

}  // namespace

void look_at(
    const std::vector<model::Mesh>& walls, const std::vector<Frame<double>>& frames, Scene& scene) {
  std::vector<Vec3<double>> places;
  for (const auto& frame : frames)
    for (const auto& wall : walls)
      for (const auto& point : wall.points) places.push_back(frame.outside(point));
  Vec3<double> low = places.front(), high = low;
  for (const auto& place : places) {
    low = low.cwiseMin(place);
    high = high.cwiseMax(place);
  }
  scene.target = (low + high) / 2;
  // The view is along -Z: the arm of a SPEX points up. A nearer point must be nearer to the centre.
  double distance = 0;
  for (const auto& place : places) {
    const Vec3<double> off = margin * (place - scene.target).cwiseAbs();
    const double in_front = place[2] - scene.target[2];
    distance = std::max(distance, in_front + std::max(off[0] / width_at_1, off[1] / height_at_1));
  }
  scene.eye = scene.target + Vec3<double>(0, 0, distance);
}

namespace {

pugi::xml_node add(pugi::xml_node parent, const char* name,
    std::initializer_list<std::pair<const char*, std::string>> attributes = {}) {
  auto node = parent.append_child(name);
  for (const auto& [key, value] : attributes) node.append_attribute(key) = value.c_str();
  return node;
}

std::string text_of(const pugi::xml_document& document) {
  std::ostringstream out;
  document.save(out, " ", pugi::format_indent);
  return out.str();
}

std::string numbers(std::initializer_list<double> list) {
  return fmt::format("{}", fmt::join(list, " "));
}
std::string triple(const Vec3<double>& v) { return numbers({v[0], v[1], v[2]}); }
/// The texts of all items, each with a space behind it.
std::string list_of(const auto& items, auto&& text_of) {
  std::string list;
  for (const auto& item : items) list += text_of(item) + " ";
  return list;
}

void add_look(pugi::xml_node shape, const casefile::Colour& c, double transparency = 0) {
  auto material =
      add(add(shape, "Appearance"), "Material", {{"diffuseColor", numbers({c[0], c[1], c[2]})}});
  if (transparency > 0) material.append_attribute("transparency") = numbers({transparency}).c_str();
}

void add_ball(pugi::xml_node parent, const SceneBall& ball, const std::string& name = "") {
  auto place = add(parent, "Transform", {{"translation", triple(ball.position)}});
  if (!name.empty()) place.append_attribute("DEF") = name.c_str();
  auto shape = add(place, "Shape");
  add_look(shape, ball.colour);
  add(shape, "Sphere", {{"radius", numbers({ball.radius})}});
}

/// The rotation of a frame as axis and angle.
std::string rotation(const Frame<double>& frame) {
  Eigen::Matrix3d axes;
  axes << frame.x, frame.y, frame.z;
  const Eigen::AngleAxisd turn(axes);
  return triple(turn.axis()) + " " + numbers({turn.angle()});
}

void add_wall(pugi::xml_node parent, const model::Mesh& wall, const casefile::Colour& colour,
    double transparency = 0.7) {
  auto shape = add(parent, "Shape");
  add_look(shape, colour, transparency);
  const auto corners = list_of(
      wall.faces, [](const auto& face) { return fmt::format("{} -1", fmt::join(face, " ")); });
  // Faces of one curved wall meet at less than the crease angle and look smooth.
  auto faces = add(shape, "IndexedFaceSet",
      {{"solid", "false"}, {"creaseAngle", "0.5"}, {"coordIndex", corners}});
  add(faces, "Coordinate", {{"point", list_of(wall.points, triple)}});
}

std::string name_of_wall(std::size_t wall) { return fmt::format("wall_{}", wall); }

/// A Transform at the place of a frame.
pugi::xml_node add_frame(
    pugi::xml_node parent, const std::string& name, const Frame<double>& frame) {
  const auto turn = rotation(frame);
  return add(parent, "Transform",
      {{"DEF", name}, {"translation", triple(frame.origin)}, {"rotation", turn}});
}

/// A wall that moves in the vessel has a Transform of its own.
void add_vessel(pugi::xml_node parent, const SceneVessel& vessel, const SceneMotion* motion) {
  auto place = add_frame(parent, "vessel", vessel.frame);
  for (std::size_t id = 0; id < vessel.walls.size(); ++id) {
    const bool moves = motion &&
        std::any_of(motion->pistons.begin(), motion->pistons.end(),
            [&](const auto& piston) { return piston.first == id; });
    add_wall(moves ? add(place, "Transform", {{"DEF", name_of_wall(id)}}) : place, vessel.walls[id],
        vessel.colour);
  }
}

std::string name_of_body(std::size_t body) { return fmt::format("body_{}", body); }

/// Drives one field of the node `target` by texts of the values at keys.
void add_interpolator(pugi::xml_node scene, const char* type, const std::string& name,
    const std::string& target, const char* field, const auto& values, auto&& text_of) {
  add(scene, type,
      {{"DEF", name}, {"key", list_of(values, [](const auto& at) { return numbers({at.first}); })},
          {"keyValue", list_of(values, [&](const auto& at) { return text_of(at.second); })}});
  add(scene, "ROUTE",
      {{"fromNode", "clock"}, {"fromField", "fraction_changed"}, {"toNode", name},
          {"toField", "set_fraction"}});
  add(scene, "ROUTE",
      {{"fromNode", name}, {"fromField", "value_changed"}, {"toNode", target}, {"toField", field}});
}

void add_motion(pugi::xml_node scene, const SceneMotion& motion) {
  add(scene, "TimeSensor",
      {{"DEF", "clock"}, {"cycleInterval", numbers({motion.duration})}, {"loop", "true"}});
  const auto add_path = [&](const std::string& target, const auto& path, auto&& text_of) {
    add_interpolator(
        scene, "PositionInterpolator", target + "_path", target, "set_translation", path, text_of);
  };
  const auto add_frames = [&](const std::string& target, const SceneMotion::Frames& frames) {
    add_path(target, frames, [](const Frame<double>& frame) { return triple(frame.origin); });
    add_interpolator(scene, "OrientationInterpolator", target + "_turn", target, "set_rotation",
        frames, rotation);
  };
  add_frames("vessel", motion.vessel);
  for (std::size_t k = 0; k < motion.bodies.size(); ++k)
    add_frames(name_of_body(k), motion.bodies[k]);
  for (const auto& [wall, path] : motion.pistons) add_path(name_of_wall(wall), path, triple);
  for (std::size_t i = 0; i < motion.balls.size(); ++i)
    add_path(fmt::format("ball_{}", i), motion.balls[i], triple);
  if (!motion.contact.empty()) add_path("contact_point", motion.contact, triple);
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
      {{"name", "description"},
          {"content", fmt::format("Ball mill at {} s; lengths in metres", s.time)}});
  auto scene = add(x3d, "Scene");
  add(scene, "Background", {{"skyColor", "1 1 1"}});
  add(scene, "Viewpoint",
      {{"description", "mill"}, {"position", triple(s.eye)},
          {"centerOfRotation", triple(s.target)}});
  add_vessel(scene, s.vessel, motion);
  for (std::size_t k = 0; const auto& body : s.bodies)
    add_wall(add_frame(scene, name_of_body(k++), body.frame), body.walls[0], body.colour, 0);
  for (std::size_t i = 0; i < s.balls.size(); ++i)
    add_ball(scene, s.balls[i], fmt::format("ball_{}", i));
  if (s.contact) add_ball(scene, *s.contact, "contact_point");
  if (motion) add_motion(scene, *motion);
  return text_of(document);
}

namespace {

/// A file of the XML formats of VTK with one element of its type.
struct VtkFile {
  pugi::xml_document document;
  pugi::xml_node body;

  explicit VtkFile(const char* type) {
    document.append_child(pugi::node_declaration).append_attribute("version") = "1.0";
    body = add(add(document, "VTKFile",
                   {{"type", type}, {"version", "0.1"}, {"byte_order", "LittleEndian"}}),
        type);
  }
};

void add_array(pugi::xml_node parent, const std::string& name, const char* type, int components,
    const std::string& values) {
  auto array = add(parent, "DataArray", {{"type", type}});
  if (!name.empty()) array.append_attribute("Name") = name.c_str();
  array.append_attribute("NumberOfComponents") = components;
  array.append_attribute("format") = "ascii";
  array.text() = values.c_str();
}

/// Adds cells, each given by the indices of its points.
void add_cells(pugi::xml_node piece, const char* name, const std::vector<std::vector<int>>& cells) {
  std::string offsets;
  std::size_t end = 0;
  for (const auto& cell : cells) offsets += fmt::format("{} ", end += cell.size());
  auto node = piece.append_child(name);
  add_array(node, "connectivity", "Int32", 1,
      list_of(cells, [](const auto& cell) { return fmt::format("{}", fmt::join(cell, " ")); }));
  add_array(node, "offsets", "Int32", 1, offsets);
}

pugi::xml_node add_piece(
    VtkFile& file, double time, std::size_t points, std::size_t vertices, std::size_t polygons) {
  add(add(file.body, "FieldData"), "DataArray",
      {{"type", "Float64"}, {"Name", "TimeValue"}, {"NumberOfTuples", "1"}, {"format", "ascii"}})
      .text() = fmt::format("{}", time).c_str();
  return add(file.body, "Piece",
      {{"NumberOfPoints", std::to_string(points)}, {"NumberOfVerts", std::to_string(vertices)},
          {"NumberOfLines", "0"}, {"NumberOfStrips", "0"},
          {"NumberOfPolys", std::to_string(polygons)}});
}

}  // namespace

std::string vtp_balls(const Scene& s) {
  VtkFile file("PolyData");
  auto piece = add_piece(file, s.time, s.balls.size(), s.balls.size(), 0);
  std::vector<std::vector<int>> cells;
  for (int i = 0; i < static_cast<int>(s.balls.size()); ++i) cells.push_back({i});
  const auto add_each = [&](pugi::xml_node parent, const char* name, int components,
                            auto&& text_of) {
    add_array(parent, name, "Float64", components, list_of(s.balls, text_of));
  };
  auto data = piece.append_child("PointData");
  add_each(data, "diameter [m]", 1, [](auto& ball) { return numbers({2 * ball.radius}); });
  add_each(data, "velocity [m/s]", 3, [](auto& ball) { return triple(ball.velocity); });
  add_each(data, "spin [rad/s]", 3, [](auto& ball) { return triple(ball.spin); });
  add_each(data, "milling_dose [J]", 1, [](auto& ball) { return numbers({ball.milling_dose}); });
  add_array(
      data, "ball", "Int32", 1, list_of(cells, [](auto& cell) { return std::to_string(cell[0]); }));
  add_each(piece.append_child("Points"), "", 3, [](auto& ball) { return triple(ball.position); });
  add_cells(piece, "Verts", cells);
  return text_of(file.document);
}

std::string vtp_vessel(const Scene& s) {
  std::string points, walls;
  std::vector<std::vector<int>> faces;
  int count = 0;
  std::size_t wall = 0;
  const auto add_mesh = [&](const model::Mesh& mesh, const Frame<double>& frame) {
    for (auto face : mesh.faces) {
      for (int& corner : face) corner += count;
      faces.push_back(std::move(face));
      walls += fmt::format("{} ", wall);
    }
    for (const auto& point : mesh.points) points += triple(frame.outside(point)) + " ";
    count += static_cast<int>(mesh.points.size());
    ++wall;
  };
  for (const auto& mesh : s.vessel.walls) add_mesh(mesh, s.vessel.frame);
  for (const auto& body : s.bodies) add_mesh(body.walls[0], body.frame);
  VtkFile file("PolyData");
  auto piece = add_piece(file, s.time, static_cast<std::size_t>(count), 0, faces.size());
  add_array(piece.append_child("CellData"), "wall", "Int32", 1, walls);
  add_array(piece.append_child("Points"), "", "Float64", 3, points);
  add_cells(piece, "Polys", faces);
  return text_of(file.document);
}

std::string pvd_text(const std::vector<std::pair<double, std::vector<std::string>>>& frames) {
  VtkFile file("Collection");
  for (const auto& [time, parts] : frames)
    for (std::size_t part = 0; part < parts.size(); ++part)
      add(file.body, "DataSet",
          {{"timestep", fmt::format("{}", time)}, {"part", std::to_string(part)},
              {"file", clean_text(parts[part])}});
  return text_of(file.document);
}

}  // namespace edmill::output
