// The pose of a vessel, for decks that call Python.
#include <fmt/format.h>

#include <cmath>

#include "dem/deck.hpp"

namespace edmill::dem {

std::string pose_in_python(const DeckCase& c) {
  const double turn = 2 * numerics::pi<double>();
  std::string joints;
  for (const auto& j : c.joints.list) {
    const double length = std::hypot(j.axis[0], j.axis[1], j.axis[2]), unit = length > 0 ? length : 1;
    std::string swings;
    for (const auto& s : j.swings)
      swings += fmt::format("({}, {}, {}), ", j.rotates ? turn * s.amplitude : s.amplitude,
                            turn * s.frequency, turn * s.phase);
    joints += fmt::format("    ({}, np.array([{}, {}, {}]), np.array([{}, {}, {}]), {}, {}, [{}]),\n",
                          j.rotates ? "True" : "False", j.axis[0] / unit, j.axis[1] / unit, j.axis[2] / unit,
                          j.shift[0], j.shift[1], j.shift[2], turn * j.angle,
                          j.rotates ? turn * j.speed : j.speed, swings);
  }
  return fmt::format(
      R"(from math import cos, sin
# rotates, axis, shift, angle, speed, swings (amplitude, angular speed, phase): from the ground to the vessel
JOINTS = [
{}]
def cross(a, b):
    a, b = a.tolist(), b.tolist()  # sooner than np.cross
    return np.array((a[1]*b[2]-a[2]*b[1], a[2]*b[0]-a[0]*b[2], a[0]*b[1]-a[1]*b[0]))
def skew(n):
    x, y, z = n.tolist()
    return np.array(((0, -z, y), (z, 0, -x), (-y, x, 0)))
def turned(n, q):
    K = skew(n)
    return np.eye(3)+sin(q)*K+(1-cos(q))*(K @ K)
def pose(t):
    R, C, w, dw, V, A = np.eye(3), np.zeros(3), np.zeros(3), np.zeros(3), np.zeros(3), np.zeros(3)
    for rotates, axis, shift, angle, speed, swings in JOINTS:
        q, q1, q2 = angle+speed*t, speed, 0.0
        for a, f, p in swings:
            q, q1, q2 = q+a*sin(f*t+p), q1+a*f*cos(f*t+p), q2-a*f*f*sin(f*t+p)
        if rotates:
            n = R @ axis
            dw = dw+q2*n+q1*cross(w, n)
            w = w+q1*n
            R = R @ turned(axis, q)
        else:
            d, v, a = R @ (shift+axis*q), R @ (axis*q1), R @ (axis*q2)
            A = A+a+2*cross(w, v)+cross(dw, d)+cross(w, cross(w, d))
            V = V+v+cross(w, d)
            C = C+d
    return R, C, w, dw, V, A)",
      joints);
}

}  // namespace edmill::dem
