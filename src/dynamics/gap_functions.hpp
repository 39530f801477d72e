// The gaps of a flying ball to the walls of the moving vessel, their rates, and how well a scalar knows them.
// Equations: (2.17'), (2.19'), (2.21'), (2.22') of docs/theory.md.
#pragma once

#include <array>

#include "dynamics/flight.hpp"
#include "model/case.hpp"

namespace edmill::dynamics {

/// Yes or no for each wall.
using WallSet = std::array<bool, model::wall_count>;

/// Whether any wall from this id on is in the set.
inline bool any_from(const WallSet& set, int wall) {
  bool any = false;
  for (; wall < model::wall_count; ++wall) any |= set[wall];
  return any;
}
inline constexpr WallSet every_wall() {
  WallSet set{};
  for (bool& wall : set) wall = true;
  return set;
}

/// Gaps at one time, as the vessel measures them.
template <class Real>
struct GapSample {
  Real offset;  ///< [s] from the start of the window's drive period
  std::array<Real, model::wall_count> gap;
  std::array<Real, model::wall_count> rate;
};

/// A sample with second derivatives, where a search begins.
template <class Real>
struct GapStart : GapSample<Real> {
  std::array<Real, model::wall_count> curvature;
};

/// A ball at one time.
template <class Real>
struct SeenBall {
  Vec3<Real> velocity;                  ///< inertial [m/s]
  model::VesselFrameState<Real> state;  ///< in the vessel
};

/// Bounds on the rounding errors of a sample.
template <class Real>
struct GapErrors {
  std::array<Real, model::wall_count> gap;
  std::array<Real, model::wall_count> rate;
  std::array<Real, model::wall_count> curvature;

  friend GapErrors operator+(GapErrors a, const GapErrors& b) {
    for (int wall = 0; wall < model::wall_count; ++wall) {
      a.gap[wall] += b.gap[wall];
      a.rate[wall] += b.rate[wall];
      a.curvature[wall] += b.curvature[wall];
    }
    return a;
  }
};

/// The gap functions of one flight, over offsets of one drive period.
template <class Real>
class GapFunctions {
 public:
  using Vessel = model::CylinderVessel<Real>;

  /// Constants of a mill, shared by all flights.
  struct Constants {
    explicit Constants(const model::Mill<Real>& m)
        : mill(m),
          clock(m.motion.period),
          angular_speed(m.motion.angular_speed()),
          frequency(1 / m.motion.period) {
      reach = m.motion.arm + m.vessel.reach();
      gravity = norm<Real>(m.gravity);
      amplitudes = m.motion.angles();
      wall_speed = m.motion.wall_speed(m.vessel.reach());
    }
    model::Mill<Real> mill;
    DriveClock<Real> clock;
    Real angular_speed, frequency;
    Real reach;       ///< largest distance of a ball from the fulcrum [m]
    Real gravity;     ///< [m/s^2]
    Real amplitudes;  ///< bound on the sum of both angles [rad]
    Real wall_speed;  ///< no point of the vessel is faster [m/s]
  };

  /// @param period  offsets count from the start of this drive period
  GapFunctions(const Constants& constants, const Flight<Real>& flight, const Real& radius,
               std::int64_t period)
      : c_(constants),
        flight_(flight),
        room_(constants.mill.vessel.room(radius)),
        lag_(period == flight.start.period
                 ? Real(0)
                 : Real(Real(period - flight.start.period) * constants.clock.period())) {}

  /// Time since the start of the flight [s].
  Real elapsed(const Real& offset) const { return lag_ + (offset - flight_.start.offset); }

  model::VesselPose<Real> pose(const Real& offset) const {
    return model::pose_at<Real>(c_.mill.motion, c_.angular_speed, c_.frequency, offset);
  }

  /// What the vessel leaves to the ball's centre.
  const typename Vessel::Room& room() const { return room_; }

  GapSample<Real> operator()(const Real& offset) const { return (*this)(offset, pose(offset)); }

  /// The same where the vessel is known to stand at `pose`.
  GapSample<Real> operator()(const Real& offset, const model::VesselPose<Real>& pose) const {
    const Real dt = elapsed(offset);
    return sample(offset, model::to_vessel_frame<Real>(pose, c_.mill.motion.arm,
                                                       position_after(flight_, c_.mill.gravity, dt),
                                                       velocity_after(flight_, c_.mill.gravity, dt)));
  }

  /// The gap to one wall, of which only the angles of the pose are needed.
  Real gap(int wall, const Real& offset, const model::VesselPose<Real>& pose) const {
    const auto p = model::position_in_vessel<Real>(pose, c_.mill.motion.arm,
                                                   position_after(flight_, c_.mill.gravity, elapsed(offset)));
    return Vessel::gap(room_, wall, p);
  }

  /// The ball at `offset`, where the vessel stands at `pose`.
  SeenBall<Real> seen(const Real& offset, const model::VesselPose<Real>& pose) const {
    const Real dt = elapsed(offset);
    const auto velocity = velocity_after(flight_, c_.mill.gravity, dt);
    return {velocity, model::to_vessel_frame<Real>(pose, c_.mill.motion.arm,
                                                   position_after(flight_, c_.mill.gravity, dt), velocity)};
  }

  /// The start of a search at `offset`, where the vessel stands at `pose` and the ball is seen as `ball`.
  GapStart<Real> start(const Real& offset, const model::VesselPose<Real>& pose,
                       const SeenBall<Real>& ball) const {
    const auto second = model::vessel_frame_acceleration<Real>(pose, c_.mill.motion.arm, ball.state,
                                                               ball.velocity, c_.mill.gravity);
    return {sample(offset, ball.state), Vessel::curvatures(ball.state.position, ball.state.velocity, second)};
  }
  GapStart<Real> start(const Real& offset) const {
    const auto at = pose(offset);
    return start(offset, at, seen(offset, at));
  }

  /// The sample that a state in the vessel frame gives.
  GapSample<Real> sample(const Real& offset, const model::VesselFrameState<Real>& state) const {
    return {offset, Vessel::gaps(room_, state.position), Vessel::rates(state.position, state.velocity)};
  }

  /// Rounding bounds for every sample up to `elapsed` [s] after the start of the flight with inertial speeds
  /// up to `speed` [m/s]. The constants are counted in docs/theory.md, section 4; a test compares them with
  /// measured errors.
  /// @param walls  those whose bounds are asked for; the others' may be anything
  GapErrors<Real> errors(const Real& elapsed, const Real& speed, const WallSet& walls) const {
    const Real u = epsilon<Real>() / 2;
    const Real angle = 10 + 16 * c_.amplitudes;  // ulps of 1 that the pose and the products leave
    const Real time = elapsed + 3 * (lag_ < 0 ? Real(-lag_) : lag_);
    const Real position = 6 * c_.reach + 4 * (c_.gravity * elapsed * elapsed) + speed * time;
    const Real turning = c_.amplitudes * c_.angular_speed;
    const Real y = u * (angle * c_.reach + 2 * position);
    const Real y_rate = u * ((angle + 4) * speed + 28 * turning * c_.reach + 2 * turning * position +
                             4 * c_.gravity * elapsed);
    const Real y_second = u * (32 + 16 * c_.amplitudes) * largest_acceleration(speed) + 4 * turning * y_rate +
                          2 * turning * (c_.angular_speed + turning) * y;
    return spread(u, {y, y_rate, y_second}, speed, elapsed, walls);
  }
  GapErrors<Real> errors(const Real& elapsed, const Real& speed) const {
    return errors(elapsed, speed, every_wall());
  }

  /// What rounding a wider flight, radius and mill to this scalar adds to these bounds, at offsets that stand
  /// for themselves in both. Derivation: docs/theory.md, section 4.
  GapErrors<Real> state_errors(const Real& elapsed, const Real& speed) const {
    const Real u = epsilon<Real>() / 2;
    const Real angle = 9 * c_.amplitudes;
    const Real lag = lag_ < 0 ? Real(-lag_) : lag_;
    const Real time = c_.clock.period() + lag;  // ulps of 1 s that the start and the whole periods leave
    const Real turning = c_.amplitudes * c_.angular_speed;
    const Real y =
        u * ((angle + 3) * c_.reach + speed * (elapsed + time) + 2 * (c_.gravity * elapsed * elapsed));
    const Real y_rate =
        u * ((angle + 2) * speed + (angle + 10) * turning * c_.reach + c_.gravity * (2 * elapsed + time)) +
        turning * y;
    const Real y_second = u * (32 + 9 * c_.amplitudes) * largest_acceleration(speed) + 4 * turning * y_rate +
                          2 * turning * (c_.angular_speed + turning) * y;
    return spread(u, {y, y_rate, y_second}, speed, elapsed, every_wall());
  }

 private:
  /// Bound on the second derivative of a vessel-frame coordinate, term by term, of a ball inside the vessel
  /// [m/s^2].
  Real largest_acceleration(const Real& speed) const {
    const Real turning = c_.amplitudes * c_.angular_speed;
    return c_.gravity + 4 * turning * speed + 2 * turning * (c_.angular_speed + 2 * turning) * c_.reach;
  }

  /// Bounds for walls from those on a coordinate in the vessel frame. A sample lies inside the vessel or as
  /// far outside as a flight gets that is searched beyond its contact, which is for an eighth of a period at
  /// most.
  GapErrors<Real> spread(const Real& u, const model::ErrorBounds<Real>& coordinate, const Real& speed,
                         const Real& elapsed, const WallSet& walls) const {
    GapErrors<Real> errors{};
    for (int wall = 0; wall < model::wall_count; ++wall) {
      if (!walls[wall]) continue;
      auto bounds = coordinate;
      if (!Vessel::is_flat(wall)) {
        const Real turning = c_.amplitudes * c_.angular_speed;
        const Real frame_speed = speed + turning * c_.reach;
        const Real eighth = c_.clock.period() / 8;
        bounds = c_.mill.vessel.curved_errors(coordinate, u, frame_speed, largest_acceleration(speed),
                                              Real(frame_speed * (elapsed < eighth ? elapsed : eighth)));
      }
      errors.gap[wall] = bounds.value, errors.rate[wall] = bounds.rate,
      errors.curvature[wall] = bounds.second;
    }
    return errors;
  }

  const Constants& c_;
  Flight<Real> flight_;
  typename Vessel::Room room_;
  Real lag_;
};

}  // namespace edmill::dynamics
