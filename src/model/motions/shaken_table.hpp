// A table that shakes harmonically along a line. docs/theory.md, section 1.
#pragma once

#include <array>

#include "base/archive.hpp"
#include "base/instant.hpp"
#include "base/scalar.hpp"
#include "base/small_turn.hpp"
#include "base/trigonometry.hpp"
#include "model/parts/parameter.hpp"
#include "model/parts/vessel_frame.hpp"

namespace edmill::model {

/// The phase of the drive.
template <class Real>
struct TablePose {
  Real sine, cosine;

  void archive(Archive& a) { a(sine, cosine); }
};

/// The vessel's centre is at C = A sin(phase), phase = 2 pi t / period; its axes stay those of the inertial
/// frame.
template <class Real>
class ShakenTable {
 public:
  using Scalar = Real;
  using Pose = TablePose<Real>;

  ShakenTable() = default;
  /// @param shift         A, the amplitude and its direction [m]
  /// @param drive_period  [s]
  ShakenTable(const Vec3<Real>& shift, const Real& drive_period)
      : amplitude_(shift),
        period_(drive_period),
        angular_speed_(2 * numerics::pi<Real>() / drive_period),
        frequency_(1 / drive_period),
        size_(norm<Real>(shift) * (1 + 8 * epsilon<Real>())) {}
  template <class To>
  ShakenTable<To> cast() const {
    return {vector_cast<To>(amplitude_), static_cast<To>(period_)};
  }

  const Vec3<Real>& amplitude() const { return amplitude_; }    ///< A [m]
  const Real& period() const { return period_; }                ///< [s]
  const Real& angular_speed() const { return angular_speed_; }  ///< w = 2 pi / period [rad/s]

  Pose pose(const Instant<Real>& when) const {
    const auto phase = numerics::sin_cos_turns<Real>(when.offset * frequency_);
    return {phase.sin, phase.cos};
  }
  /// Error: two roundings more than `pose`.
  template <bool with_rates = true>
  Pose pose_nearby(const Instant<Real>& when, const Pose& pose_known, const Instant<Real>& known) const {
    const Real turned = angular_speed_ * (when.offset - known.offset);
    if (!(turned <= numerics::longest_turn<Real> && turned >= -numerics::longest_turn<Real>)) [[unlikely]]
      return pose(when);
    Pose next = pose_known;
    numerics::turn<Real>(next.sine, next.cosine, turned);
    return next;
  }

  static Vec3<Real> axis_x(const Pose&) { return {Real(1), Real(0), Real(0)}; }
  static Vec3<Real> axis_y(const Pose&) { return {Real(0), Real(1), Real(0)}; }
  static Vec3<Real> axis_z(const Pose&) { return {Real(0), Real(0), Real(1)}; }
  static Vec3<Real> direction_to_inertial(const Pose&, const Vec3<Real>& n) { return n; }
  Vec3<Real> to_inertial(const Pose& pose, const Vec3<Real>& p) const { return p + amplitude_ * pose.sine; }
  Vec3<Real> position_in_vessel(const Pose& pose, const Vec3<Real>& position) const {
    return position - amplitude_ * pose.sine;
  }
  VesselFrameState<Real> to_vessel_frame(const Pose& pose, const Vec3<Real>& position,
                                         const Vec3<Real>& velocity) const {
    return {position_in_vessel(pose, position), velocity - wall_velocity(pose, position)};
  }
  Vec3<Real> vessel_frame_acceleration(const Pose& pose, const VesselFrameState<Real>& state,
                                       const Vec3<Real>&, const Vec3<Real>& gravity) const {
    return gravity - wall_acceleration(pose, state.position);
  }
  static Vec3<Real> angular_velocity(const Pose&) { return {Real(0), Real(0), Real(0)}; }
  Vec3<Real> wall_velocity(const Pose& pose, const Vec3<Real>&) const {
    return amplitude_ * Real(angular_speed_ * pose.cosine);
  }
  Vec3<Real> wall_acceleration(const Pose& pose, const Vec3<Real>&) const {
    return amplitude_ * Real(-(angular_speed_ * angular_speed_) * pose.sine);
  }

  static Vec3<Real> middle() { return {Real(0), Real(0), Real(0)}; }
  Real reach(const Real& vessel_reach) const { return size_ + vessel_reach; }
  Real wall_speed(const Real&) const { return size_ * angular_speed_; }
  Real speed_within(const Real&) const { return size_ * angular_speed_; }
  Real acceleration_within(const Real&) const { return size_ * angular_speed_ * angular_speed_; }
  Real longest_window() const { return period_ / 8; }

  SweptBox<Real> swept(const Vec3<Real>& sizes, const Real&) const {
    const Vec3<Real> far = sizes + amplitude_.cwiseAbs();
    return {-far, far};
  }
  CoordinateBounds<Real> coordinate_bounds(const Vec3<Real>& sizes, const Real&, const Real& gravity,
                                           const Real& speed, const Real& length) const {
    using std::abs;
    const auto along = [&](int axis) {
      const Real size = abs(amplitude_[axis]);
      const Real wall = size * angular_speed_, bend = wall * angular_speed_;
      return numerics::Majorant<Real>{sizes[axis] + (speed + wall) * length, speed + wall, gravity + bend,
                                      bend * angular_speed_, bend * angular_speed_ * angular_speed_};
    };
    return {along(0), along(1), along(2)};
  }

  Real speed_in_vessel(const FlightBounds<Real>& f) const { return f.speed + size_ * angular_speed_; }
  Real acceleration_in_vessel(const FlightBounds<Real>& f) const {
    return f.gravity + acceleration_within(f.reach);
  }
  /// Counted as for the SPEX: the flight's position and velocity, the phase, and what is left of both.
  ErrorBounds<Real> coordinate_errors(const Real& u, const FlightBounds<Real>& f) const {
    const Real wall = size_ * angular_speed_, fallen = f.gravity * f.elapsed;
    const Real position = 6 * f.reach + 4 * (fallen * f.elapsed) + f.speed * (f.elapsed + 3 * f.lag);
    return {u * (4 * f.reach + 16 * size_ + 2 * position), u * (8 * f.speed + 20 * wall + 4 * fallen),
            u * 32 * f.vessel_acceleration};
  }
  ErrorBounds<Real> state_errors(const Real& u, const FlightBounds<Real>& f) const {
    const Real time = period_ + f.lag, wall = size_ * angular_speed_;
    return {u * (3 * f.reach + 12 * size_ + f.speed * (f.elapsed + time) +
                 2 * (f.gravity * f.elapsed * f.elapsed)),
            u * (2 * f.speed + 12 * wall + f.gravity * (2 * f.elapsed + time)),
            u * 32 * f.vessel_acceleration};
  }

 private:
  Vec3<Real> amplitude_{Real(0), Real(0), Real(0)};
  Real period_{0}, angular_speed_{0}, frequency_{0};
  Real size_{0};  ///< of the amplitude, rounded up [m]
};

/// [mill] type = "table".
template <class Number>
struct Table {
  static constexpr const char* name = "table";
  std::array<Number, 3> amplitude;
  Number period;

  template <class Part, class Visit>
  static void parameters(Part& part, Visit&& visit) {
    visit(PartParameter{"amplitude", Dimension::length}, part.amplitude);
    visit(PartParameter{"speed", Dimension::angular_speed, Range::drive}, part.period);
  }
  ShakenTable<Number> motion() const { return {{amplitude[0], amplitude[1], amplitude[2]}, period}; }
};

}  // namespace edmill::model
