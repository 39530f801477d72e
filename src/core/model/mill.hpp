// The physical model without the balls: the vessel and its motion, gravity, and contact laws.
#pragma once

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/vector.hpp"
#include "model/ball.hpp"
#include "model/bodies/rounded_body.hpp"
#include "model/contact_law.hpp"
#include "model/motion.hpp"
#include "model/vessel.hpp"

namespace edmill::model {

/// The stall rule: when impacts are frictionless. (docs/theory.md, section 6)
///
/// The least separation speed v_s bounds the number of impacts of a pair that nothing else touches.
/// In a wedge of several bodies friction can pass the energy that v_s supplies from pair to pair
/// without end, at one instant. Therefore, after `impacts` consecutive impacts of a ball that each
/// came without time to move, the following ones are frictionless until the ball moves again.
///
/// A ball has had no time to move if its flight was shorter than v_s / `acceleration`. Bodies that
/// are pressed together by less than that acceleration separate for longer, for 2 v_s / a.
struct StallRule {
  int impacts = 32;
  int acceleration = 30000;  ///< far above that of any mill [m/s^2]

  /// @param least_separation  v_s of the law of the impact [m/s]; if it is zero, no flight is too
  /// short
  template <class Real>
  bool has_moved(const Real& flight_time, const Real& least_separation) const {
    return !(flight_time * acceleration < least_separation);
  }
};

/// Contact laws by material. Empty if the case defines no pairs of materials.
template <class Real> struct PairLaws {
  std::vector<ContactLaw<Real>> laws;
  std::size_t materials = 1;  ///< with the unnamed one, 0
  std::vector<int> of_balls;  ///< law by material x material; -1 for the mill's ball_ball
  std::vector<int> of_walls;  ///< law by material x wall; -1 for the mill's ball_wall

  bool empty() const { return laws.empty(); }
};

/// A body inside the vessel, on a chain of joints of its own whose clock is that of the mill. To a
/// ball it is one more wall, after those of the vessel.
template <class Real> struct Body {
  ChainMotion<Real> motion;
  RoundedBody<Real> shape;
  WallInfo name;
  bool on_vessel = false;  ///< it is moved by the vessel, whose load includes its own
};

template <class Real> struct Mill {
  AnyMotion<Real> motion;
  AnyVessel<Real> vessel;
  Vec3<Real> gravity;  ///< [m/s^2]
  ContactLaw<Real> ball_ball;
  ContactLaw<Real> ball_wall;
  PairLaws<Real> pairs{};
  StallRule stall{};
  std::vector<Body<Real>> bodies{};

  /// Those of the vessel, then the bodies.
  int wall_count() const { return vessel.wall_count() + static_cast<int>(bodies.size()); }
  std::vector<WallInfo> walls() const {
    auto all = vessel.walls();
    for (const auto& body : bodies) all.push_back(body.name);
    return all;
  }
  /// The body with the id of a wall; null for walls of the vessel.
  const Body<Real>* body_of(int wall) const {
    if (bodies.empty()) [[likely]]
      return nullptr;
    const int k = wall - vessel.wall_count();
    return k < 0 ? nullptr : &bodies[k];
  }

  const ContactLaw<Real>& law_between(
      const BallProperties<Real>& one, const BallProperties<Real>& other) const {
    if (pairs.empty()) [[likely]]
      return ball_ball;
    const int law = pairs.of_balls[static_cast<std::size_t>(one.material) * pairs.materials +
        static_cast<std::size_t>(other.material)];
    return law < 0 ? ball_ball : pairs.laws[law];
  }
  const ContactLaw<Real>& law_with_wall(const BallProperties<Real>& ball, int wall) const {
    if (pairs.empty()) [[likely]]
      return ball_wall;
    const std::size_t walls = pairs.of_walls.size() / pairs.materials;
    const int law = pairs.of_walls[static_cast<std::size_t>(ball.material) * walls +
        static_cast<std::size_t>(wall)];
    return law < 0 ? ball_wall : pairs.laws[law];
  }
  /// The smallest and the largest least separation speed of all laws [m/s].
  std::pair<Real, Real> least_separations() const {
    std::pair<Real, Real> range =
        std::minmax(ball_ball.least_separation, ball_wall.least_separation);
    for (const auto& law : pairs.laws)
      range = {std::min(range.first, law.least_separation),
          std::max(range.second, law.least_separation)};
    return range;
  }
};

/// The mill in another scalar: exact when that is wider, rounded otherwise.
template <class To, class From> Mill<To> mill_cast(const Mill<From>& m) {
  const auto law = [](const ContactLaw<From>& l) {
    return convert_law<To>(l, [](const From& x) { return static_cast<To>(x); });
  };
  PairLaws<To> pairs{{}, m.pairs.materials, m.pairs.of_balls, m.pairs.of_walls};
  for (const auto& own : m.pairs.laws) pairs.laws.push_back(law(own));
  std::vector<Body<To>> bodies;
  for (const auto& body : m.bodies)
    bodies.push_back({body.motion.template cast<To>(), body.shape.template cast<To>(), body.name,
        body.on_vessel});
  return {.motion = m.motion.template cast<To>(),
      .vessel = m.vessel.template cast<To>(),
      .gravity = vector_cast<To>(m.gravity),
      .ball_ball = law(m.ball_ball),
      .ball_wall = law(m.ball_wall),
      .pairs = std::move(pairs),
      .stall = m.stall,
      .bodies = std::move(bodies)};
}

/// Calls f(motion, room, number) with what a wall belongs to and its number there, the vessel or a
/// body, where the room is that of the centre of a ball.
template <class Real, class F>
decltype(auto) at_wall(const Mill<Real>& mill, int wall, const Real& radius, F&& f) {
  if (const auto* body = mill.body_of(wall)) return f(body->motion, body->shape.inset(radius), 0);
  return f(mill.motion, mill.vessel.inset(radius), wall);
}

/// A ball at a wall, inertial.
template <class Real> struct WallTouch {
  Vec3<Real> normal;         ///< unit, from the wall to the ball
  Vec3<Real> wall_velocity;  ///< at the point of contact [m/s]
  Real overlap;              ///< [m]; negative for a gap
};
/// @param position  of the ball's centre
template <class Real>
WallTouch<Real> touch_of(const Mill<Real>& mill, int wall, const Real& radius,
    const Instant<Real>& time, const Vec3<Real>& position) {
  return at_wall(mill, wall, radius, [&](const auto& motion, const auto& room, int number) {
    const auto pose = motion.pose(time);
    const auto place = motion.position_in_vessel(pose, position);
    const Vec3<Real> normal = motion.direction_to_inertial(pose, room.normal(number, place));
    WallTouch<Real> touch{normal,
        motion.wall_velocity(pose, Vec3<Real>(position - normal * radius)),
        room.overlap(number, place)};
    if (const auto* pistons = mill.vessel.pistons(); pistons && !mill.body_of(wall)) {
      const auto moved = pistons->of_wall(number, time);
      touch.overlap += moved.value;
      touch.wall_velocity += normal * moved.rate;
    }
    return touch;
  });
}

/// Calls f(motion, vessel). In double, a SPEX with a cylinder is passed with its concrete types, so
/// that f is compiled for them; everything else is passed as it is given.
template <class Real, class F>
[[gnu::always_inline]] inline decltype(auto) with_parts(
    const AnyMotion<Real>& motion, const AnyVessel<Real>& vessel, F&& f) {
  if constexpr (std::is_same_v<Real, double>) {
    const auto* spex = motion.template get_if<SpexMotion<Real>>();
    const auto* cylinder = vessel.template get_if<CylinderVessel<Real>>();
    if (spex && cylinder && !vessel.pistons()) [[likely]]
      return f(*spex, *cylinder);
  }
  return f(motion, vessel);
}

/// The pose as the type that motion M uses.
template <class M> const typename M::Pose& pose_of(const AnyPose<typename M::Scalar>& pose) {
  if constexpr (std::is_same_v<typename M::Pose, AnyPose<typename M::Scalar>>)
    return pose;
  else
    return *std::get_if<typename M::Pose>(&pose);
}

}  // namespace edmill::model
