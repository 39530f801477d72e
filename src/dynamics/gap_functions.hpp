// The gaps of a flying ball to the walls of the moving vessel, their rates, and how well a scalar knows them.
// Equations: (2.17'), (2.19'), (2.21'), (2.22') of docs/theory.md.
#pragma once

#include <array>

#include "dynamics/flight.hpp"
#include "model/case.hpp"

namespace edmill::dynamics {

/// Gaps at one time. For the caps the gap is a length [m]; for the cylinder it is q = (R_v-R)^2 - x^2 - z^2
/// [m^2], smooth on the axis, with the sign of the gap.
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
  /// Constants of a mill, shared by all flights.
  struct Constants {
    explicit Constants(const model::Mill<Real>& m)
        : mill(m),
          clock(m.motion.period),
          angular_speed(m.motion.angular_speed()),
          frequency(1 / m.motion.period) {
      using std::sqrt;
      const Real& R = m.vessel.radius;
      const Real& h = m.vessel.half_height;
      reach = m.motion.arm + sqrt(R * R + h * h);
      gravity = norm<Real>(m.gravity);
      amplitudes = m.motion.theta_max + m.motion.gamma_max;
      wall_speed = angular_speed * (m.motion.theta_max * reach + m.motion.gamma_max * (reach - m.motion.arm));
    }
    model::Mill<Real> mill;
    DriveClock<Real> clock;
    Real angular_speed, frequency;
    Real reach;       ///< largest distance of a ball from the fulcrum [m]
    Real gravity;     ///< [m/s^2]
    Real amplitudes;  ///< theta_max + gamma_max [rad]
    Real wall_speed;  ///< no point of the vessel is faster [m/s]
  };

  /// @param period  offsets count from the start of this drive period
  GapFunctions(const Constants& constants, const Flight<Real>& flight, const Real& radius,
               std::int64_t period)
      : c_(constants),
        flight_(flight),
        cap_(constants.mill.vessel.half_height - radius),
        cylinder_(constants.mill.vessel.radius - radius),
        lag_(period == flight.start.period
                 ? Real(0)
                 : Real(Real(period - flight.start.period) * constants.clock.period())) {}

  /// Time since the start of the flight [s].
  Real elapsed(const Real& offset) const { return lag_ + (offset - flight_.start.offset); }

  model::VesselPose<Real> pose(const Real& offset) const {
    return model::pose_at<Real>(c_.mill.motion, c_.angular_speed, c_.frequency, offset);
  }

  Real cap() const { return cap_; }
  Real cylinder() const { return cylinder_; }

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
    if (wall == 2) return cylinder_ * cylinder_ - (p[0] * p[0] + p[2] * p[2]);
    return wall == 0 ? Real(cap_ + p[1]) : Real(cap_ - p[1]);
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
    const auto &p = ball.state.position, &u = ball.state.velocity;
    const Real q_second = -2 * ((u[0] * u[0] + p[0] * second[0]) + (u[2] * u[2] + p[2] * second[2]));
    return {sample(offset, ball.state), {second[1], -second[1], q_second}};
  }
  GapStart<Real> start(const Real& offset) const {
    const auto at = pose(offset);
    return start(offset, at, seen(offset, at));
  }

  /// The sample that a state in the vessel frame gives.
  GapSample<Real> sample(const Real& offset, const model::VesselFrameState<Real>& state) const {
    const auto& p = state.position;
    const auto& u = state.velocity;
    return {offset,
            {cap_ + p[1], cap_ - p[1], cylinder_ * cylinder_ - (p[0] * p[0] + p[2] * p[2])},
            {u[1], -u[1], -2 * (p[0] * u[0] + p[2] * u[2])}};
  }

  /// Rounding bounds for every sample up to `elapsed` [s] after the start of the flight with inertial speeds
  /// up to `speed` [m/s]. The constants are counted in docs/theory.md, section 4; a test compares them with
  /// measured errors.
  /// @param with_cylinder  whether those of the cylinder are asked for
  GapErrors<Real> errors(const Real& elapsed, const Real& speed, bool with_cylinder = true) const {
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
    if (!with_cylinder) return {{y, y, Real(0)}, {y_rate, y_rate, Real(0)}, {y_second, y_second, Real(0)}};
    return spread(u, {y, y_rate, y_second}, speed, elapsed);
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
    return spread(u, {y, y_rate, y_second}, speed, elapsed);
  }

 private:
  /// Bound on the second derivative of a vessel-frame coordinate, term by term, of a ball inside the vessel
  /// [m/s^2].
  Real largest_acceleration(const Real& speed) const {
    const Real turning = c_.amplitudes * c_.angular_speed;
    return c_.gravity + 4 * turning * speed + 2 * turning * (c_.angular_speed + 2 * turning) * c_.reach;
  }

  /// Bounds on the errors of a coordinate in the vessel frame and of its first two derivatives.
  struct CoordinateErrors {
    Real value, rate, second;
  };
  /// Bounds for every wall from those on a coordinate. A sample lies inside the vessel or as far outside as a
  /// flight gets that is searched beyond its contact, which is for an eighth of a period at most.
  GapErrors<Real> spread(const Real& u, const CoordinateErrors& y, const Real& speed,
                         const Real& elapsed) const {
    const Real turning = c_.amplitudes * c_.angular_speed;
    const Real frame_speed = speed + turning * c_.reach;
    const Real acceleration = largest_acceleration(speed);
    const Real eighth = c_.clock.period() / 8;
    const Real R = c_.mill.vessel.radius + frame_speed * (elapsed < eighth ? elapsed : eighth);
    const Real q = 3 * R * y.value + 4 * u * R * R;
    const Real q_rate = 3 * R * y.rate + 3 * frame_speed * y.value + 6 * u * R * frame_speed;
    const Real q_second = 6 * frame_speed * y.rate + 4 * R * y.second + 4 * acceleration * y.value +
                          12 * u * (frame_speed * frame_speed + R * acceleration);
    return {{y.value, y.value, q}, {y.rate, y.rate, q_rate}, {y.second, y.second, q_second}};
  }

  const Constants& c_;
  Flight<Real> flight_;
  Real cap_, cylinder_;
  Real lag_;
};

}  // namespace edmill::dynamics
