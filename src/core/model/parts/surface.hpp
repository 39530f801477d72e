// The walls of a vessel as surfaces with coordinates, for maps and pictures.
#pragma once

#include <array>
#include <numeric>
#include <variant>
#include <vector>

#include "base/archive.hpp"
#include "base/trigonometry.hpp"
#include "model/parts/vessel_frame.hpp"

namespace edmill::model {

/// The quantities that coordinates on walls measure, in the order of columns in tables.
enum class Coordinate { angle, height, radius, u, v };

struct CoordinateInfo {
  const char *name, *unit, *meaning;
};
inline constexpr std::array<CoordinateInfo, 5> coordinate_infos = {{
    {"angle", "rad", "about the vessel's axis from x, the arm, to z"},
    {"height", "m", "along y from the vessel's centre"},
    {"radius", "m", "from the vessel's axis"},
    {"u", "m", "along the wall's first edge from its centre"},
    {"v", "m", "along the wall's second edge from its centre"},
}};
constexpr const CoordinateInfo& info_of(Coordinate c) { return coordinate_infos[int(c)]; }

/// A position on a wall in coordinates from 0 to 1, equal parts of which have equal areas.
template <class Real> struct WallPlace { Real u, v; };

/// Number of sides of the polygon that approximates a circle in pictures.
inline constexpr int picture_sides = 48;

/// Flat faces with corners among `points`, for pictures.
struct Mesh {
  std::vector<Vec3<double>> points;     ///< [m]
  std::vector<std::vector<int>> faces;  ///< indices of the corners of each

  void archive(Archive& a) { a(points, faces); }
};

/// Closed polygons: a wall is drawn between them, or inside of a single one.
template <class Real> using Rings = std::vector<std::vector<Vec3<Real>>>;

/// The angle from x to z in turns, from 0 to 1, with the same bits everywhere: the C library's arc
/// tangent is not the same on every machine.
template <class Real> Real turns(const Real& x, const Real& z) {
  using std::sqrt;
  const Real size = sqrt(x * x + z * z);
  if (!(size > 0)) return Real(0);
  const Real a = magnitude(x), b = magnitude(z);
  const double q = static_cast<double>(a < b ? Real(a / b) : Real(b / a));
  double guess = q * (0.125 + 0.0434 * (1 - q));  // within 0.0006 turns
  if (a < b) guess = 0.25 - guess;
  if (x < 0) guess = 0.5 - guess;
  if (z < 0) guess = 1 - guess;
  Real turn(guess);
  for (int step = 0; step < 6; ++step) {  // each step leaves the cube of the error
    const auto at = numerics::sin_cos_turns<Real>(turn);
    const Real off = (at.cos * z - at.sin * x) / size;
    turn += off / (2 * numerics::pi<Real>());
    if (off * off * off < epsilon<Real>() && -off * off * off < epsilon<Real>()) break;
  }
  return turn < 0 ? Real(turn + 1) : turn;
}

/// A surface of revolution about the y axis of its frame: u along the angle from x to z, v along
/// its profile. Own provides `ring(v)` and its inverse, `share(d)`, for a position d in the frame.
template <class Real, class Own> struct Revolved {
  static constexpr std::array coordinates{Coordinate::angle, Coordinate::height};

  Frame<Real> frame;

  WallPlace<Real> map(const Vec3<Real>& p) const {
    const Vec3<Real> d = frame.inside(p);
    return {turns<Real>(d[0], d[2]), own().share(d)};
  }
  Vec3<Real> point(const Real& u, const Real& v) const {
    const auto angle = numerics::sin_cos_turns<Real>(u);
    const auto [radius, height] = own().ring(v);
    return frame.outside({radius * angle.cos, height, radius * angle.sin});
  }
  Real edge(int axis, std::size_t k, std::size_t n) const {
    if (axis == 0) return 2 * numerics::pi<Real>() * Real(k) / Real(n);
    const auto [radius, height] = own().ring(Real(k) / Real(n));
    return Own::coordinates[1] == Coordinate::radius ? radius
                                                     : frame.outside({Real(0), height, Real(0)})[1];
  }
  /// Rings at equal steps of v.
  Rings<Real> rings() const {
    Rings<Real> rings;
    for (int part = 0; part <= Own::parts; ++part)
      rings.push_back(circle(Real(part) / Real(Own::parts)));
    return rings;
  }
 protected:
  struct Ring {
    Real radius, height;  ///< in the frame [m]
  };
  std::vector<Vec3<Real>> circle(const Real& v) const {
    std::vector<Vec3<Real>> points;
    for (int k = 0; k < picture_sides; ++k)
      points.push_back(point(Real(k) / Real(picture_sides), v));
    return points;
  }
 private:
  const Own& own() const { return static_cast<const Own&>(*this); }
};

/// A flat disc: v along the squared radius.
template <class Real> struct Disc : Revolved<Real, Disc<Real>> {
  static constexpr const char* name = "caps";
  static constexpr std::array coordinates{Coordinate::angle, Coordinate::radius};

  Real radius;  ///< [m]

  Real share(const Vec3<Real>& d) const { return squared_across(d) / (radius * radius); }
  auto ring(const Real& v) const {
    using std::sqrt;
    return typename Disc::Ring{radius * sqrt(v), Real(0)};
  }
  Real area() const { return numerics::pi<Real>() * (radius * radius); }
  Rings<Real> rings() const { return {this->circle(Real(1))}; }
};

/// A cylinder: v along y.
template <class Real> struct Tube : Revolved<Real, Tube<Real>> {
  static constexpr const char* name = "the cylinder";
  static constexpr int parts = 1;

  Real radius, half_height;  ///< [m]

  Real share(const Vec3<Real>& d) const { return (d[1] / half_height + 1) / 2; }
  auto ring(const Real& v) const { return typename Tube::Ring{radius, half_height * (2 * v - 1)}; }
  Real area() const { return 2 * numerics::pi<Real>() * radius * 2 * half_height; }
};

/// A zone of a sphere about the origin of its frame: v along y, which by Archimedes shares the area
/// evenly.
template <class Real> struct Zone : Revolved<Real, Zone<Real>> {
  static constexpr const char* name = "spheres";
  static constexpr int parts = 12;

  Real radius, low, high;  ///< the zone is between these heights [m]

  Real share(const Vec3<Real>& d) const { return (d[1] - low) / (high - low); }
  auto ring(const Real& v) const {
    using std::sqrt;
    const Real y = low + (high - low) * v, square = radius * radius - y * y;
    return typename Zone::Ring{square > 0 ? Real(sqrt(square)) : Real(0), y};
  }
  Real area() const { return 2 * numerics::pi<Real>() * radius * (high - low); }
};

/// The quarter of a torus about y that rounds the upper edge of a cylinder: v by area from the cap,
/// where r = core, down to the cylinder, where r = core + rounding.
template <class Real> struct Edge : Revolved<Real, Edge<Real>> {
  static constexpr const char* name = "edges";
  static constexpr int parts = 6;

  // The origin of the frame is in the plane of the circle of the torus.
  Real core, rounding;  ///< radii of that circle and of the tube [m]

  Real share(const Vec3<Real>& d) const {
    return share_to(turns<Real>(d[1], Real(across(d) - core)));
  }
  auto ring(const Real& v) const {
    const auto tilt = numerics::sin_cos_turns<Real>(tilt_at(v));
    return typename Edge::Ring{core + rounding * tilt.sin, rounding * tilt.cos};
  }
  Real area() const {
    const Real pi = numerics::pi<Real>();
    return 2 * pi * rounding * (core * pi / 2 + rounding);
  }
 private:
  /// Share of the area from the cap to the tilt [turns] from y.
  Real share_to(const Real& tilt) const {
    const Real quarter = numerics::pi<Real>() / 2;
    const auto at = numerics::sin_cos_turns<Real>(tilt);
    return (core * (4 * quarter * tilt) + rounding * (1 - at.cos)) / (core * quarter + rounding);
  }
  /// The inverse, by Newton's iteration between 0 and a quarter: the share grows throughout.
  Real tilt_at(const Real& v) const {
    if (!(v > 0)) return Real(0);
    Real low(0), high = Real(1) / 4, tilt = v / 4;
    const Real quarter = numerics::pi<Real>() / 2, whole = core * quarter + rounding;
    for (int step = 0; step < 100; ++step) {
      const Real off = share_to(tilt) - v;
      (off > 0 ? high : low) = tilt;
      const auto at = numerics::sin_cos_turns<Real>(tilt);
      const Real slope = 4 * quarter * (core + rounding * at.sin) / whole;
      Real next = tilt - off / slope;
      if (!(next > low && next < high)) next = (low + high) / 2;
      const Real moved = next - tilt;
      tilt = next;
      if (moved < epsilon<Real>() && -moved < epsilon<Real>()) break;
    }
    return tilt;
  }
};

/// A flat rectangle: u and v along its edges.
template <class Real> struct Rectangle {
  static constexpr const char* name = "rectangles";
  static constexpr std::array coordinates{Coordinate::u, Coordinate::v};

  Vec3<Real> centre;                 ///< [m]
  std::array<Vec3<Real>, 2> halves;  ///< of the edges along u and along v [m]

  WallPlace<Real> map(const Vec3<Real>& p) const {
    const Vec3<Real> d = p - centre;
    const auto share = [&](const Vec3<Real>& half) {
      return Real((dot<Real>(d, half) / squared_norm<Real>(half) + 1) / 2);
    };
    return {share(halves[0]), share(halves[1])};
  }
  Vec3<Real> point(const Real& u, const Real& v) const {
    return centre + (halves[0] * Real(2 * u - 1) + halves[1] * Real(2 * v - 1));
  }
  Real area() const { return 4 * norm<Real>(halves[0]) * norm<Real>(halves[1]); }
  Real edge(int axis, std::size_t k, std::size_t n) const {
    return norm<Real>(halves[axis]) * (2 * Real(k) / Real(n) - 1);
  }
  Rings<Real> rings() const {
    const Real low(0), high(1);
    return {{point(low, low), point(high, low), point(high, high), point(low, high)}};
  }
};

/// A surface with an area but no coordinates, such as the rounded edges of a box.
template <class Real> struct Patch {
  static constexpr const char* name = "patches";
  static constexpr std::array coordinates{Coordinate::u, Coordinate::v};

  Real size;  ///< [m2]

  WallPlace<Real> map(const Vec3<Real>&) const { return {Real(1) / 2, Real(1) / 2}; }
  Vec3<Real> point(const Real&, const Real&) const { return Vec3<Real>::Zero(); }
  Real area() const { return size; }
  Real edge(int, std::size_t, std::size_t) const { return Real(0); }
  Rings<Real> rings() const { return {{}}; }
};

/// A flat polygon: u and v along the edges of a rectangle around it.
template <class Real> struct Polygon : Rectangle<Real> {
  static constexpr const char* name = "polygons";
  std::vector<Vec3<Real>> corners;  ///< in turn [m]

  Rings<Real> rings() const { return {corners}; }
};
template <class Real> Polygon<Real> polygon_of(const std::vector<Vec3<Real>>& corners) {
  const Vec3<Real> edge = corners[1] - corners[0], x = edge / norm<Real>(edge);
  const Vec3<Real> side = corners[2] - corners[0];
  const Vec3<Real> across = side - x * dot<Real>(side, x), y = across / norm<Real>(across);
  std::array<Real, 2> low{Real(0), Real(0)}, high = low;
  for (const auto& p : corners) {
    const Vec3<Real> d = p - corners[0];
    const std::array<Real, 2> at{dot<Real>(d, x), dot<Real>(d, y)};
    for (std::size_t k = 0; k < 2; ++k) {
      low[k] = at[k] < low[k] ? at[k] : low[k];
      high[k] = at[k] > high[k] ? at[k] : high[k];
    }
  }
  const Vec3<Real> centre =
      corners[0] + x * Real((low[0] + high[0]) / 2) + y * Real((low[1] + high[1]) / 2);
  return {{centre, {x * Real((high[0] - low[0]) / 2), y * Real((high[1] - low[1]) / 2)}}, corners};
}

/// The surface of one wall, of one of these kinds.
template <class Real> class WallSurface {
 public:
  using Kind = std::variant<Disc<Real>, Tube<Real>, Zone<Real>, Edge<Real>, Rectangle<Real>,
      Polygon<Real>, Patch<Real>>;

  template <class Surface> WallSurface(const Surface& surface) : kind_(surface) {}

  const Kind& kind() const { return kind_; }
  /// Name of this kind of walls, for readers.
  const char* name() const {
    return visit([](const auto& s) { return s.name; });
  }
  bool has_coordinates() const { return !std::holds_alternative<Patch<Real>>(kind_); }
  /// Names and units of u and v.
  std::array<Coordinate, 2> coordinates() const {
    return visit([](const auto& s) { return s.coordinates; });
  }
  /// The coordinates of a point p [m] of the wall; by rounding a little outside of 0 to 1.
  WallPlace<Real> map(const Vec3<Real>& p) const {
    return visit([&](const auto& s) { return s.map(p); });
  }
  /// The inverse of `map` [m].
  Vec3<Real> point(const Real& u, const Real& v) const {
    return visit([&](const auto& s) { return s.point(u, v); });
  }
  /// [m^2]
  Real area() const {
    return visit([](const auto& s) { return s.area(); });
  }
  /// Begin of the k-th of n equal parts along u (axis 0) or v (1), in the unit of the coordinate.
  Real edge(int axis, std::size_t k, std::size_t n) const {
    return visit([&](const auto& s) { return s.edge(axis, k, n); });
  }
  Rings<Real> rings() const {
    return visit([](const auto& s) { return s.rings(); });
  }
 private:
  auto visit(const auto& function) const { return std::visit(function, kind_); }

  Kind kind_;
};

template <class Real> Mesh mesh_of(const WallSurface<Real>& surface) {
  Mesh mesh;
  const auto rings = surface.rings();
  for (const auto& ring : rings)
    for (const auto& point : ring) mesh.points.push_back(vector_cast<double>(point));
  const int corners = static_cast<int>(rings.front().size()),
            count = static_cast<int>(rings.size());
  if (count == 1) {
    mesh.faces.emplace_back(corners);
    std::iota(mesh.faces[0].begin(), mesh.faces[0].end(), 0);
  }
  for (int ring = 0; ring + 1 < count; ++ring)
    for (int k = 0; k < corners; ++k) {
      const int here = ring * corners, there = here + corners, next = (k + 1) % corners;
      mesh.faces.push_back({here + k, there + k, there + next, here + next});
    }
  return mesh;
}

/// Walls of a box about the origin, by wall id: x-, x+, y-, y+, z-, z+.
/// @param half_sizes  half of its edges along the axes [m]
template <class Real> std::vector<WallSurface<Real>> box_surfaces(const Vec3<Real>& half_sizes) {
  std::vector<WallSurface<Real>> walls;
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {-1, 1}) {
      const auto half = [&](int k) {
        return Vec3<Real>(Vec3<Real>::Unit(k % 3) * half_sizes[k % 3]);
      };
      walls.push_back(Rectangle<Real>{half(axis) * Real(side), {half(axis + 1), half(axis + 2)}});
    }
  return walls;
}

}  // namespace edmill::model
