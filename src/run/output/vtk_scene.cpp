#include <fmt/format.h>

#include <pugixml.hpp>
#include <sstream>

#include "base/clean_text.hpp"
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
  std::string points, walls;
  std::vector<std::vector<int>> faces;
  int count = 0;
  for (std::size_t wall = 0; wall < s.vessel.walls.size(); ++wall) {
    const auto& mesh = s.vessel.walls[wall];
    for (auto face : mesh.faces) {
      for (int& corner : face) corner += count;
      faces.push_back(std::move(face));
      walls += fmt::format("{} ", wall);
    }
    for (const auto& point : mesh.points) points += vector(s.vessel.frame.outside(point));
    count += static_cast<int>(mesh.points.size());
  }
  VtkFile file("PolyData");
  auto piece = add_piece(file, s.time, static_cast<std::size_t>(count), 0, faces.size());
  add_array(piece.append_child("CellData"), "wall", "Int32", 1, walls);
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
      set.append_attribute("file") = clean_text(parts[part]).c_str();
    }
  return file.text();
}

}  // namespace edmill::output
