// A convex polyhedron about the origin of the vessel frame.
#pragma once

#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <optional>

#include "base/errors.hpp"
#include "model/parts/parameter.hpp"
#include "model/parts/partners.hpp"
#include "model/parts/surface.hpp"

namespace edmill::model {

/// Each wall is a plane with its unit normal n outwards. The gap is the length d - n.p [m].
template <class Real> class PolyhedronVessel {
 public:
  using Scalar = Real;
  static constexpr std::size_t most_walls = 32;
  template <class Value> using PerWall = boost::container::static_vector<Value, most_walls>;
  template <class Value> using PerKind = PerWall<Value>;
  struct Plane {
    Vec3<Real> normal;  ///< outwards; made a unit vector
    Real distance;      ///< d > 0, of the plane from the origin [m]
  };

  /// Why planes do not form a vessel: what was found, and what was expected.
  struct Problem {
    std::string found, expected;
  };

  /// @throws InputError when the planes do not close a vessel about the origin, or one is not a
  /// wall of it
  explicit PolyhedronVessel(const std::vector<Plane>& planes) {
    if (const auto problem = fill(planes))
      throw InputError("vessel: found " + problem->found + ", expected " + problem->expected);
  }
  static std::optional<Problem> problem_of(const std::vector<Plane>& planes) {
    return PolyhedronVessel().fill(planes);
  }
  template <class To> PolyhedronVessel<To> cast() const {
    PolyhedronVessel<To> other;
    for (const auto& p : planes_)
      other.planes_.push_back({vector_cast<To>(p.normal), static_cast<To>(p.distance)});
    other.half_sizes_ = vector_cast<To>(half_sizes_);
    other.reach_ = static_cast<To>(reach_);
    other.volume_ = static_cast<To>(volume_);
    return other;
  }

  const boost::container::static_vector<Plane, most_walls>& planes() const { return planes_; }
  int wall_count() const { return static_cast<int>(planes_.size()); }
  std::vector<WallInfo> walls() const { return numbered_walls(wall_count(), "the plane "); }
  std::vector<WallSurface<Real>> surfaces() const {
    std::vector<WallSurface<Real>> list;
    for (const auto& face : make_faces()) list.push_back(polygon_of<Real>(face));
    return list;
  }

  Real reach() const { return reach_; }
  Real extent() const { return reach_; }
  Vec3<Real> half_sizes() const { return half_sizes_; }
  Real volume() const { return volume_; }
  Real widest_ball() const { return 2 * half_sizes_.minCoeff(); }

  PolyhedronVessel inset(const Real& by) const {
    PolyhedronVessel smaller(*this);
    for (auto& plane : smaller.planes_) plane.distance -= by;
    return smaller;
  }
  /// True if there are no corners: a closed, non-empty vessel has some. Testing the origin would
  /// not suffice, since it may be outside after an inset.
  bool is_empty() const {
    const auto faces = make_faces();
    return std::all_of(
        faces.begin(), faces.end(), [](const Polygon& face) { return face.empty(); });
  }
  bool contains(const Vec3<Real>& p) const {
    bool inside = true;
    for (int wall = 0; wall < wall_count(); ++wall) inside &= gap(wall, p) >= 0;
    return inside;
  }

  PerWall<Real> gaps(const Vec3<Real>& p) const {
    PerWall<Real> gaps;
    for (const auto& plane : planes_) gaps.push_back(plane.distance - dot<Real>(plane.normal, p));
    return gaps;
  }
  Real gap(int wall, const Vec3<Real>& p) const {
    return planes_[wall].distance - dot<Real>(planes_[wall].normal, p);
  }
  PerWall<Real> rates(const Vec3<Real>&, const Vec3<Real>& u) const {
    PerWall<Real> rates;
    for (const auto& plane : planes_) rates.push_back(-dot<Real>(plane.normal, u));
    return rates;
  }
  PerWall<Real> curvatures(const Vec3<Real>& p, const Vec3<Real>&, const Vec3<Real>& a) const {
    return rates(p, a);
  }
  PerWall<bool> within(const Vec3<Real>& p, const Real& way) const {
    PerWall<bool> near;
    for (int wall = 0; wall < wall_count(); ++wall) near.push_back(!(gap(wall, p) > way));
    return near;
  }

  static int kind_of(int wall) { return wall; }
  PerKind<Real> derivative_bounds(const CoordinateBounds<Real>& c, int k) const {
    PerKind<Real> bounds;
    for (const auto& plane : planes_) {
      const Vec3<Real> n = plane.normal.cwiseAbs();
      bounds.push_back(n[0] * c.x[k] + n[1] * c.y[k] + n[2] * c.z[k]);
    }
    return bounds;
  }
  static bool is_flat(int) { return false; }
  /// Errors of the three coordinates, a rounding for each product and sum, and that of the unit
  /// normal.
  ErrorBounds<Real> curved_errors(int wall, const ErrorBounds<Real>& y, const Real& u,
      const Real& v, const Real& a, const Real& beyond) const {
    const Real n = planes_[wall].normal.cwiseAbs().sum();
    return {n * y.value + 16 * u * (reach_ + beyond), n * y.rate + 16 * u * v,
        n * y.second + 16 * u * a};
  }

  Vec3<Real> normal(int wall, const Vec3<Real>&) const { return -planes_[wall].normal; }
  Real overlap(int wall, const Vec3<Real>& p) const { return -gap(wall, p); }
 private:
  template <class> friend class PolyhedronVessel;
  PolyhedronVessel() = default;

  using Polygon = std::vector<Vec3<Real>>;

  std::optional<Problem> fill(const std::vector<Plane>& planes) {
    if (planes.size() < 4 || planes.size() > most_walls)
      return Problem{std::to_string(planes.size()) + " planes", "4 to 32"};
    for (const auto& plane : planes) {
      const Real size = norm<Real>(plane.normal);
      if (!(size > 0) || !(plane.distance > 0))
        return Problem{"a plane without a normal, or with the origin outside",
            "a normal, and the origin inside"};
      planes_.push_back({plane.normal / size, plane.distance});
    }
    for (std::size_t i = 0; i < planes_.size(); ++i)
      for (std::size_t j = i + 1; j < planes_.size(); ++j)
        if (norm<Real>(planes_[i].normal - planes_[j].normal) < rounding_margin<Real>())
          return Problem{
              "planes " + std::to_string(i) + " and " + std::to_string(j) + " with the same normal",
              "a plane for each wall"};
    if (is_open()) return Problem{"planes that leave it open", "a closed vessel"};
    const auto faces = make_faces();
    Real reach(0);
    for (std::size_t wall = 0; wall < faces.size(); ++wall) {
      if (faces[wall].size() < 3)
        return Problem{
            "a plane " + std::to_string(wall) + " that forms no wall", "planes that form walls"};
      for (const auto& corner : faces[wall]) {
        const Real size = norm<Real>(corner);
        reach = size > reach ? size : reach;
        for (int axis = 0; axis < 3; ++axis) {
          const Real far = magnitude(corner[axis]);
          half_sizes_[axis] = far > half_sizes_[axis] ? far : half_sizes_[axis];
        }
      }
      volume_ += planes_[wall].distance * area_of(faces[wall]) / 3;
    }
    const Real up = 1 + rounding_margin<Real>();
    reach_ = reach * up;
    half_sizes_ = half_sizes_ * up;
    return std::nullopt;
  }

  /// The corners of each wall, in turn.
  std::vector<Polygon> make_faces() const {
    std::vector<Polygon> faces(planes_.size());
    const std::size_t n = planes_.size();
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 1; j < n; ++j)
        for (std::size_t k = j + 1; k < n; ++k)
          if (const auto corner = corner_of(planes_[i], planes_[j], planes_[k]))
            for (const std::size_t wall : {i, j, k}) add_corner(faces[wall], *corner);
    for (std::size_t wall = 0; wall < n; ++wall) sort_around(faces[wall], planes_[wall].normal);
    return faces;
  }
  std::optional<Vec3<Real>> corner_of(const Plane& a, const Plane& b, const Plane& c) const {
    const Vec3<Real> bc = cross<Real>(b.normal, c.normal), ca = cross<Real>(c.normal, a.normal),
                     ab = cross<Real>(a.normal, b.normal);
    const Real det = dot<Real>(a.normal, bc);
    if (det * det * 1000000000000 < 1) return std::nullopt;  // nearly parallel to a line
    const Vec3<Real> p = (bc * a.distance + ca * b.distance + ab * c.distance) / det;
    const Real slack = size() / 1000000000;
    for (const auto& plane : planes_)
      if (dot<Real>(plane.normal, p) > plane.distance + slack) return std::nullopt;
    return p;
  }
  /// The largest distance of a plane from the origin, to compare lengths with.
  Real size() const {
    Real largest(0);
    for (const auto& plane : planes_) largest = plane.distance > largest ? plane.distance : largest;
    return largest;
  }
  /// Adds a corner unless it is known already, as where more than three planes meet.
  void add_corner(Polygon& face, const Vec3<Real>& p) const {
    for (const auto& known : face)
      if (norm<Real>(Vec3<Real>(known - p)) * 100000000 < size()) return;
    face.push_back(p);
  }
  static void sort_around(Polygon& face, const Vec3<Real>& normal) {
    if (face.empty()) return;
    Vec3<Real> middle = Vec3<Real>::Zero();
    for (const auto& p : face) middle += p / Real(static_cast<int>(face.size()));
    const Vec3<Real> x = face[0] - middle, y = cross<Real>(normal, x);
    const auto angle = [&](const Vec3<Real>& p) {
      const Vec3<Real> d = p - middle;
      return turns<Real>(dot<Real>(d, x), dot<Real>(d, y));
    };
    std::sort(face.begin(), face.end(),
        [&](const auto& p, const auto& q) { return angle(p) < angle(q); });
  }
  static Real area_of(const Polygon& face) {
    Vec3<Real> sum = Vec3<Real>::Zero();
    for (std::size_t k = 0; k + 1 < face.size(); ++k)
      sum += cross<Real>(Vec3<Real>(face[k] - face[0]), Vec3<Real>(face[k + 1] - face[0]));
    return norm<Real>(sum) / 2;
  }
  /// True if there is a direction that meets no plane; the directions of the edges suffice for the
  /// test.
  bool is_open() const {
    for (const auto& a : planes_)
      for (const auto& b : planes_) {
        const Vec3<Real> along = cross<Real>(a.normal, b.normal);
        if (!(squared_norm<Real>(along) * 1000000000000 > 1)) continue;
        bool leads_out = true;
        for (const auto& plane : planes_)
          leads_out &= dot<Real>(plane.normal, along) < Real(1) / 1000000000;
        if (leads_out) return true;
      }
    return false;
  }

  boost::container::static_vector<Plane, most_walls> planes_;
  Vec3<Real> half_sizes_{Real(0), Real(0), Real(0)};
  Real reach_{0}, volume_{0};
};

/// A plane by its outward normal, of any length, a point of it and how far it is moved outwards.
template <class Number> struct Face {
  std::array<Number, 3> normal{}, point{};
  Number distance{};
};

/// [vessel] type = "polyhedron": convex, by planes or by the hull of its vertices.
template <class Number> struct Polyhedron {
  static constexpr const char* name = "polyhedron";
  std::vector<Face<Number>> faces;

  void take_shape(const auto& other) { faces.resize(other.faces.size()); }
  static void parameters(auto& part, auto&& visit) {
    for (auto& face : part.faces) {
      visit(Parameter{"normal", Dimension::none, ""}, face.normal);
      visit(Parameter{"point", Dimension::length, ""}, face.point);
      visit(Parameter{"distance", Dimension::length, ""}, face.distance);
    }
  }
  std::vector<typename PolyhedronVessel<Number>::Plane> planes() const {
    std::vector<typename PolyhedronVessel<Number>::Plane> planes;
    for (const auto& face : faces) {
      const Vec3<Number> n(face.normal.data()), p(face.point.data());
      planes.push_back({n, face.distance + dot<Number>(n, p) / norm<Number>(n)});
    }
    return planes;
  }
  PolyhedronVessel<Number> vessel() const { return PolyhedronVessel<Number>(planes()); }
};

}  // namespace edmill::model
