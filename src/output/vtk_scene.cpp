#include <fmt/format.h>

#include <cmath>
#include <pugixml.hpp>
#include <sstream>

#include "output/scene.hpp"

namespace edmill::output {

namespace {

/// A file of the XML formats of VTK with one element of its type.
struct VtkFile {
  pugi::xml_document document;
  pugi::xml_node body;

  explicit VtkFile(const char* type) {
    auto declaration = document.append_child(pugi::node_declaration);
    declaration.append_attribute("version") = "1.0";
    auto root = document.append_child("VTKFile");
    root.append_attribute("type") = type;
    root.append_attribute("version") = "0.1";
    root.append_attribute("byte_order") = "LittleEndian";
    body = root.append_child(type);
  }
  std::string text() const {
    std::ostringstream out;
    document.save(out, " ", pugi::format_indent);
    return out.str();
  }
};

void add_array(pugi::xml_node parent, const char* name, const char* type, int components,
               const std::string& values) {
  auto array = parent.append_child("DataArray");
  array.append_attribute("type") = type;
  if (*name) array.append_attribute("Name") = name;
  array.append_attribute("NumberOfComponents") = components;
  array.append_attribute("format") = "ascii";
  array.text() = values.c_str();
}

std::string vector(const Vec3<double>& v) { return fmt::format("{} {} {} ", v[0], v[1], v[2]); }

/// Cells by their points, one after the other.
void add_cells(pugi::xml_node piece, const char* name, const std::vector<std::vector<int>>& cells) {
  std::string connectivity, offsets;
  std::size_t end = 0;
  for (const auto& cell : cells) {
    for (const int point : cell) connectivity += fmt::format("{} ", point);
    offsets += fmt::format("{} ", end += cell.size());
  }
  auto node = piece.append_child(name);
  add_array(node, "connectivity", "Int32", 1, connectivity);
  add_array(node, "offsets", "Int32", 1, offsets);
}

pugi::xml_node add_piece(VtkFile& file, double time, std::size_t points, std::size_t vertices,
                         std::size_t polygons) {
  auto field = file.body.append_child("FieldData");
  auto array = field.append_child("DataArray");
  array.append_attribute("type") = "Float64";
  array.append_attribute("Name") = "TimeValue";
  array.append_attribute("NumberOfTuples") = 1;
  array.append_attribute("format") = "ascii";
  array.text() = fmt::format("{}", time).c_str();
  auto piece = file.body.append_child("Piece");
  piece.append_attribute("NumberOfPoints") = points;
  piece.append_attribute("NumberOfVerts") = vertices;
  piece.append_attribute("NumberOfLines") = 0;
  piece.append_attribute("NumberOfStrips") = 0;
  piece.append_attribute("NumberOfPolys") = polygons;
  return piece;
}

}  // namespace

std::string vtp_balls(const Scene& s) {
  VtkFile file("PolyData");
  auto piece = add_piece(file, s.time, s.balls.size(), s.balls.size(), 0);
  std::string diameters, velocities, spins, doses, ids, places;
  std::vector<std::vector<int>> cells;
  for (std::size_t i = 0; i < s.balls.size(); ++i) {
    const auto& ball = s.balls[i];
    diameters += fmt::format("{} ", 2 * ball.radius);
    velocities += vector(ball.velocity);
    spins += vector(ball.spin);
    doses += fmt::format("{} ", ball.milling_dose);
    ids += fmt::format("{} ", i);
    places += vector(ball.position);
    cells.push_back({static_cast<int>(i)});
  }
  auto data = piece.append_child("PointData");
  add_array(data, "diameter [m]", "Float64", 1, diameters);
  add_array(data, "velocity [m/s]", "Float64", 3, velocities);
  add_array(data, "spin [rad/s]", "Float64", 3, spins);
  add_array(data, "milling_dose [J]", "Float64", 1, doses);
  add_array(data, "ball", "Int32", 1, ids);
  add_array(piece.append_child("Points"), "", "Float64", 3, places);
  add_cells(piece, "Verts", cells);
  return file.text();
}

std::string vtp_vessel(const Scene& s) {
  constexpr int sides = 48;
  const double st = std::sin(s.angles.theta), ct = std::cos(s.angles.theta), sg = std::sin(s.angles.gamma),
               cg = std::cos(s.angles.gamma);
  // P = R_z(theta) [(l, 0, 0) + R_x(gamma) p]
  const auto place = [&](double x, double y, double z) {
    const double a = s.arm + x, b = y * cg - z * sg;
    return Vec3<double>{a * ct - b * st, a * st + b * ct, y * sg + z * cg};
  };
  std::string points;
  std::vector<std::vector<int>> faces(2);
  for (int k = 0; k < sides; ++k) {
    const double angle = 2 * 3.141592653589793 * k / sides;
    for (const double y : {-s.half_height, s.half_height})
      points += vector(place(s.vessel_radius * std::cos(angle), y, s.vessel_radius * std::sin(angle)));
    const int next = (k + 1) % sides;
    faces.push_back({2 * k, 2 * k + 1, 2 * next + 1, 2 * next});
    faces[0].push_back(2 * k);
    faces[1].push_back(2 * k + 1);
  }
  VtkFile file("PolyData");
  auto piece = add_piece(file, s.time, 2 * sides, 0, faces.size());
  auto data = piece.append_child("CellData");
  std::string walls = "0 1";
  for (int k = 0; k < sides; ++k) walls += " 2";
  add_array(data, "wall", "Int32", 1, walls);
  add_array(piece.append_child("Points"), "", "Float64", 3, points);
  add_cells(piece, "Polys", faces);
  return file.text();
}

std::string pvd_text(const std::vector<std::pair<double, std::vector<std::string>>>& frames) {
  VtkFile file("Collection");
  for (const auto& [time, parts] : frames)
    for (std::size_t part = 0; part < parts.size(); ++part) {
      auto set = file.body.append_child("DataSet");
      set.append_attribute("timestep") = fmt::format("{}", time).c_str();
      set.append_attribute("part") = part;
      set.append_attribute("file") = parts[part].c_str();
    }
  return file.text();
}

}  // namespace edmill::output
