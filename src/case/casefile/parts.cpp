#include "casefile/parts.hpp"

#include <fmt/format.h>

#include <set>

#include "casefile/case_parts.hpp"
#include "casefile/key_reader.hpp"
#include "casefile/rational.hpp"
#include "casefile/tables.hpp"

namespace edmill::casefile {

namespace {

using model::Face;
using model::Range;

/// What the ranges of single parameters do not say.
void require_shape(Section&, const auto&) {}
void require_shape(Section& vessel, const model::Capsule<Quantity>& capsule) {
  vessel.require(capsule.height >= capsule.diameter, "height", "the diameter or more");
}
void require_shape(Section& vessel, const model::RoundedCylinder<Quantity>& cylinder) {
  const Quantity width = Quantity(2) * cylinder.edge;
  vessel.require(width <= cylinder.diameter && width <= cylinder.height, "edge_radius",
                 "at most half of the diameter and of the height");
}

using Point = std::array<Rational, 3>;

Point difference(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Point product(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Rational along(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

QuantityVector quantities(const Point& p) {
  return {quantity_of(p[0]), quantity_of(p[1]), quantity_of(p[2])};
}

/// The planes through three vertices and more that have all others on one side, in exact numbers.
class Hull {
 public:
  explicit Hull(std::vector<Point> vertices) : vertices_(std::move(vertices)) {
    const std::size_t n = vertices_.size();
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 1; j < n; ++j)
        for (std::size_t k = j + 1; k < n; ++k) add(i, j, k);
  }

  const std::vector<Face<Quantity>>& faces() const { return faces_; }
  /// A vertex that is no corner of the hull.
  std::optional<std::size_t> inner_vertex() const {
    for (std::size_t v = 0; v < vertices_.size(); ++v) {
      std::size_t count = 0;
      for (const auto& of_face : corners_) count += of_face.count(v);
      if (count < 3) return v;
    }
    return std::nullopt;
  }

 private:
  void add(std::size_t i, std::size_t j, std::size_t k) {
    Point normal = product(difference(vertices_[j], vertices_[i]), difference(vertices_[k], vertices_[i]));
    if (along(normal, normal) == 0) return;
    std::set<std::size_t> on;
    bool below = false, above = false;
    for (std::size_t v = 0; v < vertices_.size(); ++v) {
      const Rational side = along(normal, difference(vertices_[v], vertices_[i]));
      below = below || side < 0;
      above = above || side > 0;
      if (side == 0) on.insert(v);
    }
    if (below == above || !corners_.insert(on).second) return;
    if (above)
      for (auto& x : normal) x = -x;
    faces_.push_back({quantities(normal), quantities(vertices_[i]), Quantity{0}});
  }

  std::vector<Point> vertices_;
  std::set<std::set<std::size_t>> corners_;
  std::vector<Face<Quantity>> faces_;
};

std::vector<Face<Quantity>> read_planes(Entries<PlaneTable>& planes) {
  std::vector<Face<Quantity>> faces;
  for (auto& plane : read_entries(planes))
    faces.push_back({.normal = plane.normal, .point = {}, .distance = plane.distance});
  return faces;
}

std::vector<Face<Quantity>> read_vertices(Section& vessel, Entries<VertexTable>& entries) {
  std::vector<Point> vertices;
  for (const auto& vertex : read_entries(entries))
    vertices.push_back({rational(vertex.at[0]), rational(vertex.at[1]), rational(vertex.at[2])});
  if (vertices.size() < 4 || vertices.size() > 60) {
    vessel.problem("vertex", std::to_string(vertices.size()) + " vertices", "4 to 60");
    return {};
  }
  const Hull hull(vertices);
  if (const auto inner = hull.inner_vertex()) {
    vessel.problem("vertex", "a vertex " + std::to_string(*inner) + " that is no corner of the hull of all",
                   "the corners of a convex vessel");
    return {};
  }
  return hull.faces();
}

model::Polyhedron<Quantity> read_polyhedron(Section& vessel) {
  PolyhedronTable table;
  read_keys(vessel, table);
  const std::string key = vessel.has("vertex") ? "vertex" : "plane";
  if (vessel.has("vertex") == vessel.has("plane")) {
    vessel.problem("plane", vessel.has("plane") ? "planes and vertices" : "neither planes nor vertices",
                   "[[vessel.plane]] or [[vessel.vertex]]");
    return {};
  }
  model::Polyhedron<Quantity> vessel_of{key == "vertex" ? read_vertices(vessel, table.vertices)
                                                        : read_planes(table.planes)};
  if (vessel_of.faces.empty()) return vessel_of;
  const auto planes = model::converted<model::Polyhedron, double>(
      vessel_of, [](const Quantity& q) { return q.to<double>(); });
  if (const auto problem = model::PolyhedronVessel<double>::problem_of(planes.planes()))
    vessel.problem(key, problem->found, problem->expected);
  return vessel_of;
}

template <class Variant>
Variant read_part(Section& given, const char* key) {
  Variant chosen;
  const auto name = given.kind(key, names_of_kinds<Variant>());
  // Where the type is unknown, nothing else can be judged.
  Document ignored;
  Section nothing(ignored, nullptr, given.path());
  Section& section = given.of_unknown_kind() ? nothing : given;
  for_each_kind<Variant>([&]<class Part>(Part part) {
    if (name != Part::name) return;
    KeyReader read_key(section);
    if constexpr (requires { part.given; })
      part.given = read_joints(section);
    else if constexpr (requires { part.faces; })
      part = read_polyhedron(section);
    else
      Part::parameters(part, read_key);
    if (read_key.complete()) require_shape(section, part);
    chosen = part;
  });
  return chosen;
}

std::string described(const auto& part) {
  std::string text;
  for_each_parameter(part, [&](const model::Parameter& p, const std::vector<Quantity>& values) {
    if (!p.key) return;
    const bool drive = p.range == Range::drive;
    text += fmt::format("{}{}", text.empty() ? ": " : ", ", drive ? "period" : p.key);
    for (const auto& value : values) text += fmt::format(" {:g}", value.to<double>());
    text += drive ? " s" : si_unit(p.dimension);
  });
  return name_of(part) + text;
}

}  // namespace

std::string describe(const MotionSpec& motion) {
  if (const auto* chain = std::get_if<model::Chain<Quantity>>(&motion))
    return std::string(chain->name) + ": " + equation_of(chain->given);
  return described(motion);
}
std::string describe(const VesselSpec& vessel) {
  if (const auto* polyhedron = std::get_if<model::Polyhedron<Quantity>>(&vessel))
    return fmt::format("{} of {} walls", polyhedron->name, polyhedron->faces.size());
  return described(vessel);
}

void check(Section mill, const MotionSpec& motion) {
  std::visit(
      [&](const auto& m) {
        if constexpr (requires { m.given; })
          for (const auto& joint : m.given.list) check_swings(mill, joint.swings);
        else
          m.parameters(m, KeyChecker{mill});
      },
      motion);
}
void check(Section vessel, const VesselSpec& shape) {
  std::visit(
      [&](const auto& v) {
        if constexpr (!requires { v.faces; }) v.parameters(v, KeyChecker{vessel});
        require_shape(vessel, v);
      },
      shape);
}

MotionSpec read_motion(Section& mill, const char* key) { return read_part<MotionSpec>(mill, key); }
VesselSpec read_vessel(Section& vessel, const char* key) { return read_part<VesselSpec>(vessel, key); }

}  // namespace edmill::casefile
