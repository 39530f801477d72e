// Real numbers as enclosures, a midpoint and a radius each, and vectors of them.
#pragma once

#include <array>

#ifdef CHECKER_WITHOUT_ARB
#include "integer_balls.hpp"
#else
#include "arb_balls.hpp"
#endif

namespace checker {

using Vec = std::array<Real, 3>;

inline Vec operator+(const Vec& a, const Vec& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Vec operator-(const Vec& a, const Vec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Vec operator*(const Vec& a, const Real& s) { return {a[0] * s, a[1] * s, a[2] * s}; }
inline Vec operator/(const Vec& a, const Real& s) { return {a[0] / s, a[1] / s, a[2] / s}; }
inline Vec operator-(const Vec& a) { return Vec{} - a; }

/// The number if it is positive, else zero.
inline Real positive_part(const Real& a) {
  if (a >= 0) return a;
  return 0 >= a ? Real() : interval(0, upper_end(a));
}

inline Real dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

inline Real length(const Vec& a) { return square_root(dot(a, a)); }

inline Vec cross(const Vec& a, const Vec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace checker
