// Gaps of a ball in flight to moving walls, their rates, rounding errors, and bounds on
// derivatives, which exclude contacts. docs/theory.md: (2.17'), (2.19'), (2.21'), (2.22'), section
// 3
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <vector>

#include "dynamics/flight.hpp"
#include "model/motion.hpp"
#include "model/vessel.hpp"

namespace edmill::dynamics {

using model::Motion, model::Vessel;

/// Yes or no for each wall.
template <class V> using WallSet = typename V::template PerWall<bool>;

/// True if the set contains a wall with this id or a higher one.
template <class Set> bool any_from(const Set& set, std::size_t wall) {
  bool any = false;
  for (; wall < set.size(); ++wall) any |= set[wall];
  return any;
}

/// Gaps at one time, as the vessel measures them.
template <class V> struct GapSample {
  using Real = typename V::Scalar;
  Real offset;  ///< [s] from the start of the window's drive period
  typename V::template PerWall<Real> gap, rate;
};

/// A sample with second derivatives, where a search begins.
template <class V> struct GapStart : GapSample<V> {
  typename V::template PerWall<typename V::Scalar> curvature;
};

template <class Real> struct SeenBall {
  Vec3<Real> velocity;                  ///< inertial [m/s]
  model::VesselFrameState<Real> state;  ///< in the vessel
};

template <class V> struct GapErrors {
  typename V::template PerWall<typename V::Scalar> gap, rate, curvature;

  friend GapErrors operator+(GapErrors a, const GapErrors& b) {
    for (std::size_t wall = 0; wall < a.gap.size(); ++wall) {
      a.gap[wall] += b.gap[wall];
      a.rate[wall] += b.rate[wall];
      a.curvature[wall] += b.curvature[wall];
    }
    return a;
  }
};

/// A vessel with its motion, and constants that all flights in it share.
template <Motion M, Vessel V> struct MovingVessel {
  using Real = typename M::Scalar;

  MovingVessel(const M& its_motion, const V& its_vessel, const Vec3<Real>& acceleration)
      : motion(its_motion), vessel(its_vessel), gravity(acceleration), clock(its_motion.period()),
        vessel_reach(its_vessel.reach()), reach(its_motion.reach(vessel_reach)),
        gravity_size(norm<Real>(acceleration)), wall_speed(its_motion.wall_speed(vessel_reach)) {
    if (const auto* pistons = model::pistons_of(vessel)) wall_speed += pistons->bound(1);
  }

  M motion;
  V vessel;
  Vec3<Real> gravity;  ///< [m/s^2]
  DriveClock<Real> clock;
  Real vessel_reach;  ///< of the vessel from its centre [m]
  Real reach;         ///< largest distance of a ball from the origin [m]
  Real gravity_size;  ///< [m/s^2]
  Real wall_speed;    ///< no point of the vessel is faster [m/s]
};

/// The gap functions of one flight, over offsets of one drive period.
template <Motion M, Vessel V> class GapFunctions {
 public:
  using Real = typename M::Scalar;
  using Pose = typename M::Pose;
  using Sample = GapSample<V>;
  using Start = GapStart<V>;
  using Errors = GapErrors<V>;
  using Walls = WallSet<V>;

  /// @param period  offsets count from the start of this drive period
  GapFunctions(const MovingVessel<M, V>& mill, const Flight<Real>& flight, const Real& radius,
      std::int64_t period)
      : mill_(mill), flight_(flight), room_(mill.vessel.inset(radius)), period_(period),
        lag_(Real(period - flight.start.period) * mill.clock.period()) {}

  /// Chooses the functions that are valid around a position seen from a body. @return their number
  int enter(const Vec3<Real>& position) {
    if constexpr (requires { room_.enter(position); })
      return room_.enter(position);
    else
      return 0;
  }

  /// Time since the start of the flight [s].
  Real elapsed(const Real& offset) const { return lag_ + (offset - flight_.start.offset); }

  Instant<Real> instant(const Real& offset) const { return {period_, offset}; }
  Pose pose(const Real& offset) const { return mill_.motion.pose(instant(offset)); }
  /// The pose at `offset`, from the pose at a nearby offset `known`.
  Pose pose_nearby(const Real& offset, const Pose& pose, const Real& known) const {
    return mill_.motion.pose_nearby(instant(offset), pose, instant(known));
  }

  /// The region that the ball's centre can reach.
  const V& room() const { return room_; }

  Sample operator()(const Real& offset) const { return (*this)(offset, pose(offset)); }

  /// The gaps and their rates at `offset`, where the vessel has this pose.
  Sample operator()(const Real& offset, const Pose& pose) const {
    return sample(offset, seen(offset, pose).state);
  }

  /// The gap to one wall at `offset`, from the pose at a nearby offset `known`.
  Real gap_nearby(int wall, const Real& offset, const Pose& pose, const Real& known) const {
    const auto position = position_after(flight_, mill_.gravity, elapsed(offset));
    const auto seen = mill_.motion.position_nearby(instant(offset), pose, instant(known), position);
    const Real own = room_.gap(wall, seen);
    if (const auto* pistons = model::pistons_of(mill_.vessel))
      return own - pistons->of_wall(wall, instant(offset)).value;
    return own;
  }

  SeenBall<Real> seen(const Real& offset, const Pose& pose) const {
    const Real dt = elapsed(offset);
    const auto place = position_after(flight_, mill_.gravity, dt);
    const auto velocity = velocity_after(flight_, mill_.gravity, dt);
    return {velocity, mill_.motion.to_vessel_frame(pose, place, velocity)};
  }

  /// The start of a search at `offset`, from the vessel's pose and the ball's state in it.
  Start start(const Real& offset, const Pose& pose, const SeenBall<Real>& ball) const {
    const auto& [v, state] = ball;
    const auto second = mill_.motion.vessel_frame_acceleration(pose, state, v, mill_.gravity);
    Start start{
        plain_sample(offset, state), room_.curvatures(state.position, state.velocity, second)};
    for_each_piston(offset, [&](int wall, const auto& moved) {
      start.gap[wall] -= moved.value;
      start.rate[wall] -= moved.rate;
      start.curvature[wall] -= moved.second;
    });
    return start;
  }
  Start start(const Real& offset) const {
    const auto at = pose(offset);
    return start(offset, at, seen(offset, at));
  }

  Sample sample(const Real& offset, const model::VesselFrameState<Real>& state) const {
    auto sample = plain_sample(offset, state);
    for_each_piston(offset, [&](int wall, const auto& moved) {
      sample.gap[wall] -= moved.value;
      sample.rate[wall] -= moved.rate;
    });
    return sample;
  }

  /// Rounding bounds for samples up to `elapsed` [s] after the start of a flight at up to `speed`
  /// [m/s].
  /// @param walls  those whose bounds are needed; the other bounds are unspecified
  Errors errors(const Real& elapsed, const Real& speed, const Walls& walls) const {
    const Real u = epsilon<Real>() / 2;
    const auto flight = bounds(elapsed, speed);
    return spread(u, mill_.motion.coordinate_errors(u, flight), flight, walls);
  }
  Errors errors(const Real& elapsed, const Real& speed) const {
    return errors(elapsed, speed, model::per_wall(mill_.vessel, true));
  }

  /// Further errors from rounding a wider flight, radius and mill, but no offset, to this scalar.
  Errors state_errors(const Real& elapsed, const Real& speed) const {
    const Real u = epsilon<Real>() / 2;
    const auto flight = bounds(elapsed, speed);
    const auto all = model::per_wall(mill_.vessel, true);
    return spread(u, mill_.motion.state_errors(u, flight), flight, all);
  }
 private:
  /// The sample without the displacement of pistons.
  Sample plain_sample(const Real& offset, const model::VesselFrameState<Real>& state) const {
    return {offset, room_.gaps(state.position), room_.rates(state.position, state.velocity)};
  }
  /// Calls f(wall, moved) for the walls that move in the vessel.
  template <class F> void for_each_piston(const Real& offset, F&& f) const {
    if (const auto* pistons = model::pistons_of(mill_.vessel))
      for (std::size_t k = 0; k < pistons->count(); ++k)
        f(pistons->wall(k), pistons->at(k, instant(offset)));
  }

  model::FlightBounds<Real> bounds(const Real& elapsed, const Real& speed) const {
    model::FlightBounds<Real> flight{
        mill_.reach, mill_.gravity_size, speed, elapsed, magnitude(lag_)};
    flight.vessel_speed = mill_.motion.speed_in_vessel(flight);
    flight.vessel_acceleration = mill_.motion.acceleration_in_vessel(flight);
    return flight;
  }

  /// Converts bounds on a coordinate in the vessel frame to bounds for each wall. A sample is
  /// inside the vessel, or outside as far as a flight goes in an eighth of a period at most.
  Errors spread(const Real& u, const model::ErrorBounds<Real>& coordinate,
      const model::FlightBounds<Real>& flight, const Walls& walls) const {
    const auto none = model::per_wall(mill_.vessel, Real(0));
    Errors errors{none, none, none};
    for (int wall = 0; wall < model::function_count(mill_.vessel); ++wall) {
      if (!walls[wall]) continue;
      auto bounds = coordinate;
      if (!mill_.vessel.is_flat(wall)) {
        const Real& speed = flight.vessel_speed;
        const Real eighth = mill_.clock.period() / 8;
        const Real &bend = flight.vessel_acceleration, &time = flight.elapsed;
        const Real outside = speed * (time < eighth ? time : eighth);
        bounds = mill_.vessel.curved_errors(wall, coordinate, u, speed, bend, outside);
      }
      errors.gap[wall] = bounds.value;
      errors.rate[wall] = bounds.rate;
      errors.curvature[wall] = bounds.second;
    }
    if (const auto* pistons = model::pistons_of(mill_.vessel))
      for (std::size_t k = 0; k < pistons->count(); ++k) {
        const auto own = pistons->errors(k, u, mill_.vessel.extent());
        const int wall = pistons->wall(k);
        errors.gap[wall] += own.value;
        errors.rate[wall] += own.rate;
        errors.curvature[wall] += own.second;
      }
    return errors;
  }

  const MovingVessel<M, V>& mill_;
  Flight<Real> flight_;
  V room_;
  std::int64_t period_;
  Real lag_;
};

/// Suprema over a window of the 2nd, 3rd and 4th time derivatives of the gaps, by kind of wall.
template <class V>
using DerivativeBounds = typename V::template PerKind<std::array<typename V::Scalar, 3>>;

/// Bounds for a ball with at most `speed` [m/s] in a window of `length` [s], inside when it begins.
template <class M, class V, class Real = typename M::Scalar>
DerivativeBounds<V> derivative_bounds(
    const MovingVessel<M, V>& mill, const Real& speed, const Real& length) {
  Real reach = mill.vessel_reach;
  // A body is searched where the ball is near.
  if constexpr (requires { mill.vessel.reach_near(length); }) {
    const Real way = (speed + mill.wall_speed) * length * (1 + rounding_margin<Real>());
    if (const Real near = mill.vessel.reach_near(way); near < reach) reach = near;
  }
  const auto coordinates = mill.motion.coordinate_bounds(
      mill.vessel.half_sizes(), reach, mill.gravity_size, speed, length);
  const Real margin = Real(1) + Real(1) / 65536;  // over the rounding of all this
  DerivativeBounds<V> bounds{};
  for (int k = 2; k <= 4; ++k) {
    const auto of_kinds = mill.vessel.derivative_bounds(coordinates, k);
    if constexpr (requires { bounds.resize(of_kinds.size()); }) bounds.resize(of_kinds.size());
    Real of_pistons(0);
    if (const auto* pistons = model::pistons_of(mill.vessel)) of_pistons = pistons->bound(k);
    for (std::size_t kind = 0; kind < of_kinds.size(); ++kind)
      bounds[kind][k - 2] = margin * (of_kinds[kind] + of_pistons);
  }
  return bounds;
}

/// The bounds tabulated over speed and window length, rounded up.
template <class M, class V> class BoundsTable {
 public:
  using Real = typename M::Scalar;
  using Bounds = DerivativeBounds<V>;
  using Row = std::conditional_t<std::is_same_v<Real, double>, Bounds, std::optional<Bounds>>;

  explicit BoundsTable(const MovingVessel<M, V>& mill)
      : mill_(mill), longest_(mill.motion.longest_window()) {
    if (const auto* pistons = model::pistons_of(mill.vessel))
      if (const Real longest = pistons->longest_window(); longest < longest_) longest_ = longest;
    const Real wall_speed = mill.motion.speed_within(mill.motion.reach(mill.vessel.extent()));
    speed_step_ = wall_speed > 0 ? Real(wall_speed / 16) : Real(1) / 4;
    per_speed_ = 1 / speed_step_;
    rows_.resize(speeds * lengths);
    if constexpr (std::is_same_v<Real, double>)
      for (int row = 0; row < speeds * lengths; ++row) rows_[row] = made(row);
  }

  const Real& longest_window() const { return longest_; }

  Bounds at(const Real& speed, const Real& length) const {
    const Real place = speed * per_speed_;
    if (!(place < speeds - 1)) return derivative_bounds(mill_, speed, length);
    const int row = static_cast<int>(place);
    int column = 0;  // counted without branches: windows are of any length
    for (int j = 1; j < lengths; ++j) column += length <= longest_ / (1 << j);
    auto& bounds = rows_[row * lengths + column];
    if constexpr (std::is_same_v<Real, double>) {
      return bounds;
    } else {  // wide scalars decide seldom and compute rows on demand
      if (!bounds) bounds = made(row * lengths + column);
      return *bounds;
    }
  }
 private:
  static constexpr int speeds = 64, lengths = 5;

  Bounds made(int row) const {
    const Real speed = (row / lengths + 1) * speed_step_, length = longest_ / (1 << row % lengths);
    return derivative_bounds(mill_, speed, length);
  }

  MovingVessel<M, V> mill_;
  Real longest_, speed_step_, per_speed_;
  mutable std::vector<Row> rows_;
};

}  // namespace edmill::dynamics
