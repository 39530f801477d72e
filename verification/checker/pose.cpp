#include "pose.hpp"

namespace checker {
namespace {

/// R <- R E, where E rotates about the unit vector e.
void rotate(Pose& pose, const Vec& e, const Real& sine, const Real& cosine) {
  std::array<Vec, 3> E, product;
  for (Index k = 0; k < 3; ++k) {
    const Index l = (k + 1) % 3, m = (k + 2) % 3;  // (k, l, m) is an even permutation
    E[k][k] = e[k] * e[k] + cosine * (1 - e[k] * e[k]);
    E[k][l] = e[k] * e[l] * (1 - cosine) - e[m] * sine;
    E[l][k] = e[k] * e[l] * (1 - cosine) + e[m] * sine;
  }
  for (Index k = 0; k < 3; ++k)
    product[k] = E[0] * pose.rows[k][0] + E[1] * pose.rows[k][1] + E[2] * pose.rows[k][2];
  pose.rows = product;
}

/// Adds a joint that turns by this value [turns] or shifts by it [m], at this rate.
void add(Pose& pose, const Joint& joint, const Real& value, const Real& rate, const Real& two_pi) {
  if (joint.rotates) {
    pose.angular_velocity = pose.angular_velocity + pose.to_inertial(joint.axis) * (rate * two_pi);
    const auto [sine, cosine] = sine_and_cosine_of_pi(2 * value);
    rotate(pose, joint.axis, sine, cosine);
  } else {
    const Vec D = pose.to_inertial(joint.offset + joint.axis * value);
    pose.origin_velocity = pose.origin_velocity +
        (pose.to_inertial(joint.axis * rate) + cross(pose.angular_velocity, D));
    pose.origin = pose.origin + D;
  }
}

/// From the centre of a sphere, or from the axis of a cylinder, which is the y axis.
Vec from_axis(const Wall& wall, const Vec& p) {
  return {p[0], wall.kind == Wall::cylinder ? Real() : p[1], p[2]};
}

/// How far a coordinate is beyond -half to half, with its sign.
Real excess(const Real& p, const Real& half) {
  return half.zero() ? p : positive_part(p - half) - positive_part(-p - half);
}

/// How far p is beyond a solid's core along x, y and z, or across the axis of a cylinder, along it,
/// and 0.
Vec excesses(const Wall& wall, const Vec& p) {
  const Real up = excess(p[1], wall.half[1]);
  if (wall.kind == Wall::solid_box)
    return {excess(p[0], wall.half[0]), up, excess(p[2], wall.half[2])};
  return {positive_part(square_root(p[0] * p[0] + p[2] * p[2]) - wall.half[0]), up, 0};
}

/// From the nearest point of a solid's core to p.
Vec from_core(const Wall& wall, const Vec& p) {
  const Vec e = excesses(wall, p);
  if (wall.kind == Wall::solid_box) return e;
  const Real share = e[0] / (wall.half[0] + e[0]);  // 1 - a/r where r > a, else 0
  return {p[0] * share, e[1], p[2] * share};
}

Pose pose_of(const Mill& mill, const std::vector<Joint>& joints, const Real& time) {
  Pose pose;
  const Real clock = mill.start + time;
  for (const Joint& joint : joints) {
    Real value = joint.angle + joint.speed * clock;
    Real rate = joint.speed;
    for (const Swing& swing : joint.swings) {
      const auto [sine, cosine] =
          sine_and_cosine_of_pi(2 * (swing.frequency * clock + swing.phase));
      value = value + swing.amplitude * sine;
      rate = rate + swing.amplitude * (mill.two_pi * swing.frequency) * cosine;
    }
    add(pose, joint, value, rate, mill.two_pi);
  }
  return pose;
}

}  // namespace

Pose pose_of(const Mill& mill, const Real& time) { return pose_of(mill, mill.joints, time); }

Pose pose_of(const Mill& mill, const Wall& wall, const Real& time) {
  return pose_of(mill, wall.solid() ? wall.joints : mill.joints, time);
}

Real gap(const Wall& wall, const Ball& ball, const Vec& p) {
  if (wall.solid()) {
    const Vec e = excesses(wall, p);
    const Real reach = wall.size + ball.radius;
    return dot(e, e) - reach * reach;
  }
  const Real room = wall.size - ball.radius;
  if (wall.kind == Wall::plane)
    return length(wall.outward) * room + dot(wall.outward, wall.point) - dot(wall.outward, p);
  // A ball that does not fit has no positive gap: the square of a negative room would be one.
  return (room.positive() ? room * room : room) - dot(from_axis(wall, p), from_axis(wall, p));
}

Real gap_rate(const Wall& wall, const Vec& p, const Vec& u) {
  if (wall.kind == Wall::plane) return -dot(wall.outward, u);
  if (wall.solid()) return 2 * dot(from_core(wall, p), u);
  return -2 * dot(from_axis(wall, p), u);
}

Vec normal(const Wall& wall, const Ball& ball, const Vec& p) {
  if (wall.kind == Wall::plane) return -(wall.outward / length(wall.outward));
  if (wall.solid()) return from_core(wall, p) / (wall.size + ball.radius);
  return -(from_axis(wall, p) / (wall.size - ball.radius));
}

}  // namespace checker
