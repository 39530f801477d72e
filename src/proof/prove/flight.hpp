// Enclosures of the poses of the vessel and of bodies in it, of balls in flight and of their gaps,
// and proofs that they do not meet. docs/certificates.md, "Rules for the states", rules 4 and 5
#pragma once

#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "prove/enclosure.hpp"
#include "prove/exact_case.hpp"

namespace edmill::prove {

inline Vector turned(const Matrix& m, const Vector& v) {
  const auto row = [&](int k) { return m(k, 0) * v[0] + m(k, 1) * v[1] + m(k, 2) * v[2]; };
  return {row(0), row(1), row(2)};
}

/// Multiplies by the transposed matrix.
inline Vector turned_back(const Matrix& m, const Vector& v) {
  const auto column = [&](int k) { return m(0, k) * v[0] + m(1, k) * v[1] + m(2, k) * v[2]; };
  return {column(0), column(1), column(2)};
}

/// Place, velocity and acceleration of a ball in the frame of the vessel or of a body.
struct InFrame {
  Vector place, velocity, acceleration;
};

/// The pose of a frame at a time, or enclosed over a bracket of times.
struct Pose {
  Matrix axes = Matrix::Identity();       ///< R: its columns are the axes of the frame
  Vector centre, velocity, acceleration;  ///< of its origin [m], [m/s], [m/s^2]
  Vector omega, omega_rate;               ///< [rad/s], [rad/s^2]

  /// Rotates about an axis of the current frame, the unit vector e:
  /// E_kk = e_k^2 + cos (1 - e_k^2), E_kl = e_k e_l (1 - cos) -/+ e_m sin.
  /// @param turns, speed, second  the angle, [rad/s], [rad/s^2]
  void rotate(
      const Vector& e, const Enclosure& turns, const Enclosure& speed, const Enclosure& second) {
    const Vector axis = turned(axes, e), relative = axis * speed;
    omega_rate += axis * second + cross<Enclosure>(omega, relative);
    omega += relative;
    Matrix rotation;
    const auto angle = sin_cos_turns(turns);
    const Enclosure rest = 1 - angle.cos;
    for (int k = 0; k < 3; ++k) {
      const int l = (k + 1) % 3, m = (k + 2) % 3;
      const Enclosure square = e[k] * e[k], product = e[k] * e[l] * rest, along = e[m] * angle.sin;
      rotation(k, k) = square + angle.cos * (1 - square);
      rotation(k, l) = product - along;
      rotation(l, k) = product + along;
    }
    const Matrix a = axes;
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l)
        axes(k, l) = a(k, 0) * rotation(0, l) + a(k, 1) * rotation(1, l) + a(k, 2) * rotation(2, l);
  }

  /// Translates by a vector of the current frame, given with its derivatives in that frame.
  void shift(const Vector& by, const Vector& by_rate, const Vector& by_second) {
    const Vector d = turned(axes, by), rate = turned(axes, by_rate);
    const Vector carried = cross<Enclosure>(omega, d);
    acceleration += turned(axes, by_second) + cross<Enclosure>(omega, Vector(rate * Enclosure(2))) +
        cross<Enclosure>(omega_rate, d) + cross<Enclosure>(omega, carried);
    velocity += rate + carried;
    centre += d;
  }

  /// @param r, v, gravity  inertial position and velocity of a ball in flight
  InFrame seen(const Vector& r, const Vector& v, const Vector& gravity) const {
    const Vector d = r - centre, carried = cross<Enclosure>(omega, d);
    const Vector u = v - (velocity + carried);
    const Vector frame = acceleration + cross<Enclosure>(omega_rate, d) +
        cross<Enclosure>(omega, carried) + cross<Enclosure>(omega, Vector(u * Enclosure(2)));
    return {turned_back(axes, d), turned_back(axes, u), turned_back(axes, gravity - frame)};
  }
};

/// The joints of a case, in the precision at construction. Frame 0 is that of the vessel.
class Motion {
 public:
  explicit Motion(const ExactCase& exact) : start_(enclosure_of(exact.start)) {
    arb_const_pi(turn_.arb(), Precision::bits());
    turn_ = turn_ + turn_;
    add(exact.joints);
    for (const auto& wall : exact.walls) {
      frames_.push_back(wall.is_solid() ? chains_.size() : 0);
      if (wall.is_solid()) add(wall.joints);
    }
  }

  std::size_t frame_of(std::size_t wall) const { return frames_[wall]; }

  /// @param time  [s] after the start of the case
  Pose pose(const Enclosure& time, std::size_t frame = 0) const {
    Pose pose;
    const Enclosure clock = start_ + time;
    for (const auto& joint : chains_[frame]) {
      // [turns] or [m]
      Enclosure value = joint.angle + joint.speed * clock, rate = joint.speed, second;
      for (const auto& swing : joint.swings) {
        const auto phase = sin_cos_turns(swing.frequency * clock + swing.phase);
        const Enclosure speed = turn_ * swing.frequency, fastest = swing.amplitude * speed;
        value += swing.amplitude * phase.sin;
        rate += fastest * phase.cos;
        second -= fastest * speed * phase.sin;
      }
      if (joint.rotates)
        pose.rotate(joint.axis, value, rate * turn_, second * turn_);
      else
        pose.shift(joint.shift + joint.axis * value, joint.axis * rate, joint.axis * second);
    }
    return pose;
  }
 private:
  struct Joint {
    bool rotates;
    Vector axis, shift;
    Enclosure angle, speed;
    std::vector<model::Swing<Enclosure>> swings;
  };

  void add(const ExactJoints& joints) {
    auto& chain = chains_.emplace_back();
    for (const auto& given : joints) {
      const Vector axis = enclosure_of(given.axis);
      chain.push_back({.rotates = given.rotates,
          .axis = axis / norm<Enclosure>(axis),
          .shift = enclosure_of(given.shift),
          .angle = enclosure_of(given.angle),
          .speed = enclosure_of(given.speed),
          .swings = model::converted_swings<Enclosure>(
              given.swings, [](const Quantity& number) { return enclosure_of(number); })});
    }
  }

  Enclosure start_, turn_;  ///< [s], 2 pi
  std::vector<std::vector<Joint>> chains_;
  std::vector<std::size_t> frames_;  ///< by wall
};

/// Position and velocity at the exact time `reference`, and the constant spin. The ball follows the
/// parabola, which is defined for all times, between two impacts.
struct Flight {
  Enclosure reference;  ///< [s] after the start, exact
  Vector position, velocity, spin;

  Vector position_at(const Enclosure& time, const Vector& gravity) const {
    const Enclosure dt = time - reference;
    return position + (velocity + gravity * Enclosure(dt / 2)) * dt;
  }
  Vector velocity_at(const Enclosure& time, const Vector& gravity) const {
    return velocity + gravity * Enclosure(time - reference);
  }
  /// The ball in the frame whose pose at `time` is `pose`.
  InFrame seen(const Pose& pose, const Enclosure& time, const Vector& gravity) const {
    return pose.seen(position_at(time, gravity), velocity_at(time, gravity), gravity);
  }
  Flight with_each(const auto& change) const {
    return {reference, each(position, change), each(velocity, change), each(spin, change)};
  }
};

/// A gap function: positive inside, zero in contact. [m] or [m^2]
struct Gap {
  Enclosure value, rate, second;
};

/// The signed distance of a coordinate from the interval between -half and half, and whether it is
/// outside: 1 (yes), 0 (no), or [0, 1] if undecided.
struct Excess {
  Enclosure by, outside;

  Excess(const Enclosure& p, const Enclosure& half) {
    Enclosure below;
    arb_nonnegative_part(by.arb(), Enclosure(p - half).arb());
    arb_nonnegative_part(below.arb(), Enclosure(-p - half).arb());
    by -= below;
    const bool is_edge = half.is_zero();  // the core has no extent along this axis
    if (is_edge) by = p;
    if (is_edge || less(half, p) || less(p, -half))
      outside = 1;
    else if (!(less(p, half) && less(-half, p)))
      arb_unit_interval(outside.arb());
  }
};

/// The squared distance of a point from the core of a solid. Its second derivative, which jumps
/// where the nearest point of the core passes from a face to an edge, is enclosed with both of its
/// values there: Taylor's formula is valid for such functions. @param square  that of contact
inline Gap solid_gap(bool round, const Vector& half, const Enclosure& square, const InFrame& ball) {
  const auto& [p, v, a] = ball;
  Gap half_gap{-square / 2, {}, {}};
  for (const int axis : round ? std::vector{1} : std::vector{1, 0, 2}) {
    const Excess excess(p[axis], half[axis]);
    half_gap.value += excess.by * excess.by / 2;
    half_gap.rate += excess.by * v[axis];
    half_gap.second += excess.outside * (v[axis] * v[axis]) + excess.by * a[axis];
  }
  if (round) {  // the distance r from the axis beyond the core's radius: (r - a) r' = (1 - a/r)
                // (p.v)
    const Enclosure distance = sqrt(p[0] * p[0] + p[2] * p[2]), along = p[0] * v[0] + p[2] * v[2];
    const Excess excess(distance, half[0]);
    Enclosure far;
    arb_max(far.arb(), distance.arb(), half[0].arb(), Precision::bits());
    const Enclosure share = excess.by / far;
    half_gap.value += excess.by * excess.by / 2;
    half_gap.rate += share * along;
    half_gap.second += share * (v[0] * v[0] + v[2] * v[2] + p[0] * a[0] + p[2] * a[2]) +
        excess.outside * half[0] * (along * along) / (far * far * far);
  }
  return {2 * half_gap.value, 2 * half_gap.rate, 2 * half_gap.second};
}

/// The vector from the nearest point of a solid's core to p.
inline Vector from_core(bool is_round, const Vector& half, const Vector& p) {
  const Enclosure up = Excess(p[1], half[1]).by;
  if (!is_round) return {Excess(p[0], half[0]).by, up, Excess(p[2], half[2]).by};
  // (r - a)/r where r > a, also where the enclosure of r contains 0.
  const Enclosure beyond = Excess(sqrt(p[0] * p[0] + p[2] * p[2]), half[0]).by;
  const Enclosure share = beyond / (half[0] + beyond);
  return {p[0] * share, up, p[2] * share};
}

/// The walls of a case for one ball, whose radius is subtracted from the gaps.
class Walls {
 public:
  /// Computes in the current precision.
  Walls(const ExactCase& exact, const ExactBall& ball) {
    const Enclosure radius = enclosure_of(ball.radius);
    for (const auto& given : exact.walls) {
      Wall& wall = walls_.emplace_back(
          Wall{given.kind, enclosure_of(given.normal), enclosure_of(given.half), {}, {}, {}});
      const Enclosure size = enclosure_of(given.size);
      if (given.kind == ExactWall::plane) {
        const Vector point = enclosure_of(given.point);
        wall.length = norm<Enclosure>(wall.outward);
        wall.offset = wall.length * (size - radius) + dot<Enclosure>(wall.outward, point);
      } else {
        wall.room = given.is_solid() ? size + radius : size - radius;
        wall.offset = wall.room * wall.room;
      }
    }
  }

  Gap gap(std::size_t wall, const InFrame& ball) const {
    const Wall& w = walls_[wall];
    if (w.is_solid()) return solid_gap(w.kind == ExactWall::solid_cylinder, w.half, w.offset, ball);
    const auto& [place, velocity, acceleration] = ball;
    if (w.kind == ExactWall::plane)
      return {w.offset - dot<Enclosure>(w.outward, place), -dot<Enclosure>(w.outward, velocity),
          -dot<Enclosure>(w.outward, acceleration)};
    const Vector p = w.across(place), u = w.across(velocity), a = w.across(acceleration);
    return {w.offset - squared_norm<Enclosure>(p), -2 * dot<Enclosure>(p, u),
        -2 * (squared_norm<Enclosure>(u) + dot<Enclosure>(p, a))};
  }
  /// Unit normal, from the wall to a ball that touches it with its centre at `place`.
  Vector normal(std::size_t wall, const Vector& place) const {
    const Wall& w = walls_[wall];
    if (w.kind == ExactWall::plane) return -w.outward / w.length;
    if (w.is_solid()) return from_core(w.kind == ExactWall::solid_cylinder, w.half, place) / w.room;
    return -w.across(place) / w.room;
  }
 private:
  struct Wall {
    ExactWall::Kind kind;
    Vector outward;    ///< n of a plane
    Vector half;       ///< of a solid's core
    Enclosure length;  ///< |n|
    Enclosure offset;  ///< |n| (distance - R) + n.point; otherwise the square of `room`
    Enclosure room;    ///< R_v - R of round walls, rounding + R of solids

    bool is_solid() const { return kind >= ExactWall::solid_box; }

    /// Removes the component that a round wall does not depend on: that along a cylinder's axis, y.
    Vector across(Vector v) const {
      if (kind == ExactWall::cylinder) v[1] = Enclosure();
      return v;
    }
  };
  std::vector<Wall> walls_;
};

/// A flight between two impacts.
struct Span {
  const Flight& flight;
  Enclosure begin, end;                ///< [s], exact: the flight lies within these
  int begin_wall = -1, end_wall = -1;  ///< the wall of the impact at either end; -1 for none
};

/// Proves that one flight meets no wall between its ends.
class WallExclusion {
 public:
  /// @param motion, walls  for the ball
  WallExclusion(const Motion& motion, const Walls& walls, const Vector& gravity, Span span)
      : motion_(motion), walls_(walls), gravity_(gravity), span_(std::move(span)) {}

  /// The windows of the proof as text: "r2p2p1". Empty if bisection to the end does not prove it.
  std::string windows(std::size_t wall, slong bits) {
    const Precision scope(bits);
    std::string text;
    return bisect(wall, 0, 0, text) ? text : "";
  }
 private:
  static constexpr int deepest = 14;
  /// The ball in a window: at its middle, and enclosed over all of it.
  struct Window {
    Enclosure length_from_middle;
    InFrame middle, all;
  };

  const Window& window(std::size_t frame, int depth, long index) {
    const auto [found, is_new] = windows_.try_emplace({frame, depth, index});
    if (!is_new) return found->second;
    const auto at = [&](long k) {
      Enclosure share(static_cast<double>(k));
      arb_mul_2exp_si(share.arb(), share.arb(), -depth);
      return span_.begin + (span_.end - span_.begin) * share;
    };
    const Enclosure from = at(index), to = at(index + 1), middle = (from + to) / 2;
    Enclosure all;
    arb_union(all.arb(), from.arb(), to.arb(), Precision::bits());
    const auto seen = [&](const Enclosure& time) {
      return span_.flight.seen(motion_.pose(time, frame), time, gravity_);
    };
    return found->second = {all - middle, seen(middle), seen(all)};
  }

  bool bisect(std::size_t wall, int depth, long index, std::string& text) {
    const Window& w = window(motion_.frame_of(wall), depth, index);
    const Gap middle = walls_.gap(wall, w.middle);
    const Enclosure second = walls_.gap(wall, w.all).second, &s = w.length_from_middle;
    Enclosure square;
    arb_sqr(square.arb(), s.arb(), Precision::bits());
    const Enclosure value = middle.value + middle.rate * s + second * square / 2;
    const Enclosure rate = middle.rate + second * s;
    const bool first = index == 0, last = index + 1 == 1L << depth;
    const auto leaf = [&](char kind) {
      text += kind + std::to_string(depth);
      return true;
    };
    if (value.is_positive()) return leaf('p');
    if (first && span_.begin_wall == static_cast<int>(wall) && rate.is_positive()) return leaf('r');
    if (last && span_.end_wall == static_cast<int>(wall) && rate.is_negative()) return leaf('f');
    if (depth == deepest) return false;
    return bisect(wall, depth + 1, 2 * index, text) && bisect(wall, depth + 1, 2 * index + 1, text);
  }

  const Motion& motion_;
  const Walls& walls_;
  const Vector& gravity_;
  Span span_;
  std::map<std::tuple<std::size_t, int, long>, Window> windows_;  ///< by frame, depth, index
};

/// |r_i - r_j|^2 - (R_i + R_j)^2 of two balls in flight: a convex parabola, since both fall alike.
struct PairGap {
  Vector between, relative;  ///< r_i - r_j at a time, v_i - v_j
  Enclosure square;          ///< (R_i + R_j)^2

  /// @param reach  R_i + R_j
  PairGap(const Flight& one, const Flight& two, const Enclosure& reach, const Vector& gravity,
      const Enclosure& time)
      : between(one.position_at(time, gravity) - two.position_at(time, gravity)),
        relative(one.velocity_at(time, gravity) - two.velocity_at(time, gravity)),
        square(reach * reach) {}
  Enclosure value() const { return squared_norm<Enclosure>(between) - square; }
  Enclosure half_rate() const { return dot<Enclosure>(between, relative); }
};

/// Whether two flights are proven not to touch from `begin` to `end`.
inline bool apart(const Flight& one, const Flight& two, const Enclosure& reach,
    const Vector& gravity, const Enclosure& begin, const Enclosure& end) {
  const PairGap at_begin(one, two, reach, gravity, begin), at_end(one, two, reach, gravity, end);
  const Enclosure value = at_begin.value(), half_rate = at_begin.half_rate();
  if (value.is_positive() && half_rate.is_not_negative()) return true;
  if (at_end.value().is_positive() && at_end.half_rate().is_not_positive()) return true;
  // The tangent of a convex function lies below it.
  if (value.is_positive() && (value + 2 * half_rate * (end - begin)).is_positive()) return true;
  return less(half_rate * half_rate, squared_norm<Enclosure>(at_begin.relative) * value);
}

}  // namespace edmill::prove
