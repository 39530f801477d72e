// Three-vectors whose sums have a fixed order, for the same bits in every build, and frames.
#pragma once

#include <Eigen/Core>

namespace edmill {

template <class Real> using Vec3 = Eigen::Matrix<Real, 3, 1>;

template <class Real> inline Real dot(const Vec3<Real>& a, const Vec3<Real>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class Real> inline Vec3<Real> cross(const Vec3<Real>& a, const Vec3<Real>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

template <class Real> inline Real squared_norm(const Vec3<Real>& a) { return dot(a, a); }

template <class Real> inline Real norm(const Vec3<Real>& a) {
  using std::sqrt;
  return sqrt(dot(a, a));
}

template <class To, class From> inline Vec3<To> vector_cast(const Vec3<From>& a) {
  return {static_cast<To>(a[0]), static_cast<To>(a[1]), static_cast<To>(a[2])};
}

/// A right-handed frame, given by its origin and axes in the coordinates of an outer frame.
template <class Real> struct Frame {
  Vec3<Real> origin;   ///< [m]
  Vec3<Real> x, y, z;  ///< unit

  /// Outer coordinates of a point of this frame.
  Vec3<Real> outside(const Vec3<Real>& p) const {
    return origin + (x * p[0] + y * p[1] + z * p[2]);
  }
  /// Coordinates in this frame of a point of the outer frame.
  Vec3<Real> inside(const Vec3<Real>& p) const {
    const Vec3<Real> d = p - origin;
    return {dot<Real>(d, x), dot<Real>(d, y), dot<Real>(d, z)};
  }

  void archive(auto& a) { a(origin, x, y, z); }
};

/// A frame with the axes of the outer frame.
template <class Real> Frame<Real> frame_at(const Vec3<Real>& origin) {
  return {origin, Vec3<Real>::UnitX(), Vec3<Real>::UnitY(), Vec3<Real>::UnitZ()};
}

}  // namespace edmill
