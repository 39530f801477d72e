// The motion of a vessel: the concept, and a type that can be any motion.
#pragma once

#include <concepts>
#include <utility>
#include <variant>

#include "model/motions/chain.hpp"
#include "model/motions/presets.hpp"

namespace edmill::model {

/// A rigid motion of the vessel frame, periodic or not, with bounds that are valid at all times. A
/// search computes the pose once for each instant and everything else from that pose.
///
/// - `pose(when)`; `pose_nearby(when, pose, known)`, the same from the pose at a nearby instant
/// `known`, at
///   less cost if the motion supports it; `position_nearby(when, pose, known, position)`, the
///   corresponding `position_in_vessel`
/// - `to_inertial`, `direction_to_inertial`, `position_in_vessel`, `to_vessel_frame` and
///   `vessel_frame_acceleration`: positions, velocities and accelerations of free bodies in the
///   other frame
/// - `wall_velocity`, `wall_acceleration`: inertial, of the vessel's material point at an inertial
/// position
/// - `middle()`: the point at which pictures are centred [m]
/// - `reach(r)` [m]: bound on the distance from the origin of all points within r of the vessel's
/// centre
/// - `wall_speed(r)`, `speed_within(d)`, `acceleration_within(d)`: bounds for the vessel's points
/// within r of
///   its centre, or within d of the origin
/// - `swept(sizes, r)`: the box that the vessel sweeps
/// - `coordinate_bounds`: majorants of a ball's coordinates in the vessel frame, by which contacts
/// are
///   excluded with proof, for windows up to `longest_window()` [s]
/// - `speed_in_vessel`, `acceleration_in_vessel`: bounds on a ball in the vessel frame, which are
/// stored in
///   the flight's bounds for `coordinate_errors` and `state_errors`, the bounds on the rounding of
///   its coordinates
template <class M, class Real = typename M::Scalar>
concept Motion = requires(const M& motion, const typename M::Pose& pose, const Instant<Real>& when,
    const Vec3<Real>& v, const Real& x, const VesselFrameState<Real>& state,
    const FlightBounds<Real>& flight) {
  { motion.period() } -> std::convertible_to<Real>;
  { motion.pose(when) } -> std::same_as<typename M::Pose>;
  { motion.pose_nearby(when, pose, when) } -> std::same_as<typename M::Pose>;
  { motion.position_nearby(when, pose, when, v) } -> std::same_as<Vec3<Real>>;
  { motion.to_inertial(pose, v) } -> std::same_as<Vec3<Real>>;
  { motion.direction_to_inertial(pose, v) } -> std::same_as<Vec3<Real>>;
  { motion.position_in_vessel(pose, v) } -> std::same_as<Vec3<Real>>;
  { motion.to_vessel_frame(pose, v, v) } -> std::same_as<VesselFrameState<Real>>;
  { motion.vessel_frame_acceleration(pose, state, v, v) } -> std::same_as<Vec3<Real>>;
  { motion.wall_velocity(pose, v) } -> std::same_as<Vec3<Real>>;
  { motion.wall_acceleration(pose, v) } -> std::same_as<Vec3<Real>>;
  { motion.middle() } -> std::same_as<Vec3<Real>>;
  { motion.reach(x) } -> std::same_as<Real>;
  { motion.wall_speed(x) } -> std::same_as<Real>;
  { motion.speed_within(x) } -> std::same_as<Real>;
  { motion.acceleration_within(x) } -> std::same_as<Real>;
  { motion.longest_window() } -> std::same_as<Real>;
  { motion.swept(v, x) } -> std::same_as<SweptBox<Real>>;
  { motion.coordinate_bounds(v, x, x, x, x) } -> std::same_as<CoordinateBounds<Real>>;
  { motion.speed_in_vessel(flight) } -> std::same_as<Real>;
  { motion.acceleration_in_vessel(flight) } -> std::same_as<Real>;
  { motion.coordinate_errors(x, flight) } -> std::same_as<ErrorBounds<Real>>;
  { motion.state_errors(x, flight) } -> std::same_as<ErrorBounds<Real>>;
};

/// The motions that a case file can name, the default first. A new one is a file in model/motions/
/// and a line here: it is read, described and passed to every scalar by its list of parameters, and
/// moves as the joints that it lists say. A motion that is no chain of joints is a class with a
/// line in MotionVariant too.
template <class Number>
using NamedMotions = std::variant<Spex8000<Number>,  //
    Spex2d<Number>,                                  //
    StillMill<Number>,                               //
    Vibratory<Number>,                               //
    Planetary<Number>,                               //
    Drum<Number>,                                    //
    Chain<Number>>;

template <class Real> using MotionVariant = std::variant<SpexMotion<Real>, ChainMotion<Real>>;

template <class... M> std::variant<typename M::Pose...> poses_of(const std::variant<M...>&);

/// The pose of any motion, in the order of MotionVariant.
template <class Real> using AnyPose = decltype(poses_of(std::declval<MotionVariant<Real>>()));

/// Any motion, chosen when the case is read.
template <class Real> class AnyMotion {
 public:
  using Scalar = Real;
  using Pose = AnyPose<Real>;

  AnyMotion() = default;
  template <class M>
  requires(!std::same_as<M, AnyMotion>) &&
      std::constructible_from<MotionVariant<Real>, M> AnyMotion(M motion)
      : motion_(std::move(motion)) {}
  template <class To> AnyMotion<To> cast() const {
    return visit([](const auto& m) { return AnyMotion<To>(m.template cast<To>()); });
  }

  /// The motion if it is an M, otherwise null.
  template <class M> const M* get_if() const { return std::get_if<M>(&motion_); }
  template <class F> decltype(auto) visit(F&& f) const {
    return std::visit(std::forward<F>(f), motion_);
  }

  const Real& period() const {
    return visit([](const auto& m) -> const Real& { return m.period(); });
  }
  Pose pose(const Instant<Real>& when) const {
    return visit([&](const auto& m) { return Pose(m.pose(when)); });
  }
  Pose pose_nearby(const Instant<Real>& when, const Pose& pose, const Instant<Real>& known) const {
    return at(pose,
        [&](const auto& m, const auto& own) { return Pose(m.pose_nearby(when, own, known)); });
  }
  Vec3<Real> position_nearby(const Instant<Real>& when, const Pose& pose,
      const Instant<Real>& known, const Vec3<Real>& position) const {
    return at(pose, [&](const auto& m, const auto& own) {
      return m.position_nearby(when, own, known, position);
    });
  }

// The concept documents the parameters. Return types are explicit: testing whether this is a Motion
// then needs no function bodies, which every source would instantiate again. First the functions of
// a pose, then those of the motion.
#define EDMILL_BY_POSE(Result, name)                                                    \
  Result name(const Pose& pose, const auto&... a) const {                               \
    return at(pose, [&](const auto& m, const auto& own) { return m.name(own, a...); }); \
  }
#define EDMILL_OF_MOTION(Result, name)                         \
  Result name(const auto&... a) const {                        \
    return visit([&](const auto& m) { return m.name(a...); }); \
  }
  EDMILL_BY_POSE(Vec3<Real>, axis_x)
  EDMILL_BY_POSE(Vec3<Real>, axis_y)
  EDMILL_BY_POSE(Vec3<Real>, axis_z)
  EDMILL_BY_POSE(Vec3<Real>, to_inertial)
  EDMILL_BY_POSE(Vec3<Real>, direction_to_inertial)
  EDMILL_BY_POSE(Vec3<Real>, position_in_vessel)
  EDMILL_BY_POSE(VesselFrameState<Real>, to_vessel_frame)
  EDMILL_BY_POSE(Vec3<Real>, vessel_frame_acceleration)
  EDMILL_BY_POSE(Vec3<Real>, angular_velocity)
  EDMILL_BY_POSE(Vec3<Real>, wall_velocity)
  EDMILL_BY_POSE(Vec3<Real>, wall_acceleration)
  EDMILL_OF_MOTION(Vec3<Real>, middle)
  EDMILL_OF_MOTION(Real, reach)
  EDMILL_OF_MOTION(Real, wall_speed)
  EDMILL_OF_MOTION(Real, speed_within)
  EDMILL_OF_MOTION(Real, acceleration_within)
  EDMILL_OF_MOTION(Real, longest_window)
  EDMILL_OF_MOTION(SweptBox<Real>, swept)
  EDMILL_OF_MOTION(CoordinateBounds<Real>, coordinate_bounds)
  EDMILL_OF_MOTION(Real, speed_in_vessel)
  EDMILL_OF_MOTION(Real, acceleration_in_vessel)
  EDMILL_OF_MOTION(ErrorBounds<Real>, coordinate_errors)
  EDMILL_OF_MOTION(ErrorBounds<Real>, state_errors)
  /// An inertial vector in components along the vessel's axes.
  Vec3<Real> in_axes(const Pose& pose, const Vec3<Real>& v) const {
    return {dot<Real>(axis_x(pose), v), dot<Real>(axis_y(pose), v), dot<Real>(axis_z(pose), v)};
  }
#undef EDMILL_BY_POSE
#undef EDMILL_OF_MOTION
 private:
  /// Calls f with the motion and its pose.
  template <class F> auto at(const Pose& pose, F&& f) const {
    return visit([&]<class M>(const M& m) { return f(m, *std::get_if<typename M::Pose>(&pose)); });
  }

  MotionVariant<Real> motion_;
};

static_assert(
    Motion<SpexMotion<double>> && Motion<ChainMotion<double>> && Motion<AnyMotion<double>>);

}  // namespace edmill::model
