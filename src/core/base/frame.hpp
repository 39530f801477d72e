// Rigid frames.
#pragma once

#include "base/archive.hpp"
#include "base/vector.hpp"

namespace edmill {

/// A right-handed frame: where its origin and its axes are, seen from outside.
template <class Real>
struct Frame {
  Vec3<Real> origin;   ///< [m]
  Vec3<Real> x, y, z;  ///< unit

  /// A point given in this frame, seen from outside.
  Vec3<Real> outside(const Vec3<Real>& p) const { return origin + (x * p[0] + y * p[1] + z * p[2]); }
  /// A point given outside, seen in this frame.
  Vec3<Real> inside(const Vec3<Real>& p) const {
    const Vec3<Real> d = p - origin;
    return {dot<Real>(d, x), dot<Real>(d, y), dot<Real>(d, z)};
  }

  void archive(Archive& a) { a(origin, x, y, z); }
};

/// With the axes of the frame outside.
template <class Real>
Frame<Real> frame_at(const Vec3<Real>& origin) {
  return {origin, Vec3<Real>::UnitX(), Vec3<Real>::UnitY(), Vec3<Real>::UnitZ()};
}

}  // namespace edmill
