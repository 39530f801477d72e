// The motion of the SPEX 8000: the nested roto-translational model.
// Source: Barahona 2011, section 2.2.2 and (2.2)-(2.16), as corrected in docs/theory.md, section 1.
#pragma once

#include "base/instant.hpp"
#include "base/trigonometry.hpp"
#include "model/parts/vessel_frame.hpp"

namespace edmill::model {

/// Where the vessel is at one instant. `alpha` is theta - pi/2, so sin(theta) = cos(alpha).
template <class Real> struct SpexPose {
  Real sin_alpha, cos_alpha;
  Real sin_gamma, cos_gamma;
  Real theta_rate, gamma_rate;                  ///< [rad/s]
  Real theta_acceleration, gamma_acceleration;  ///< [rad/s^2]

  void archive(Archive& a) {
    a(sin_alpha, cos_alpha, sin_gamma, cos_gamma, theta_rate, gamma_rate, theta_acceleration,
        gamma_acceleration);
  }
};

/// theta = theta_max cos(phase) + pi/2 about Z, then arm along x', then gamma = gamma_max
/// sin(phase) about x'. A still vessel has zero amplitudes; its period is a unit of the clock only.
template <class Real> class SpexMotion {
 public:
  using Scalar = Real;
  using Pose = SpexPose<Real>;

  SpexMotion() = default;
  /// @param arm  l, fulcrum to vessel centre [m]  @param theta_max, gamma_max  [rad]  @param period
  /// [s]
  SpexMotion(const Real& arm, const Real& theta_max, const Real& gamma_max, const Real& period)
      : arm_(arm), theta_max_(theta_max), gamma_max_(gamma_max), period_(period),
        angular_speed_(2 * numerics::pi<Real>() / period), frequency_(1 / period),
        theta_speed_(theta_max * angular_speed_), gamma_speed_(gamma_max * angular_speed_),
        speed_squared_(angular_speed_ * angular_speed_),
        turning_((theta_max + gamma_max) * angular_speed_) {}
  template <class To> SpexMotion<To> cast() const {
    return {To(arm_), To(theta_max_), To(gamma_max_), To(period_)};
  }

  const Real& arm() const { return arm_; }
  const Real& theta_max() const { return theta_max_; }
  const Real& gamma_max() const { return gamma_max_; }
  const Real& period() const { return period_; }
  const Real& angular_speed() const { return angular_speed_; }

  /// (2.2), (2.5)
  Pose pose(const Instant<Real>& when) const {
    const auto phase = numerics::sin_cos_turns<Real>(when.offset * frequency_);
    const Real alpha = theta_max_ * phase.cos;
    const Real gamma = gamma_max_ * phase.sin;
    const auto a = numerics::sin_cos<Real>(alpha), g = numerics::sin_cos<Real>(gamma);
    return {.sin_alpha = a.sin,
        .cos_alpha = a.cos,
        .sin_gamma = g.sin,
        .cos_gamma = g.cos,
        .theta_rate = -theta_speed_ * phase.sin,
        .gamma_rate = gamma_speed_ * phase.cos,
        .theta_acceleration = -speed_squared_ * alpha,
        .gamma_acceleration = -speed_squared_ * gamma};
  }
  /// In the period of `known`. Both angles swing harmonically, alpha'' = -w^2 alpha, so with x = w
  /// dt they grow by alpha' sin(x) / w + alpha'' (1 - cos(x)) / w^2. Error: two roundings more than
  /// `pose`.
  template <bool with_rates = true>
  Pose pose_nearby(
      const Instant<Real>& when, const Pose& pose_known, const Instant<Real>& known) const {
    const Real dt = when.offset - known.offset;
    const double short_dt = static_cast<double>(dt),
                 x = static_cast<double>(angular_speed_) * short_dt;
    if (!numerics::is_short_turn<Real>(angular_speed_, dt, x)) [[unlikely]]
      return pose(when);
    const Real first = dt - Real(short_dt * (x * x) / 6);  // sin(x) / w
    const Real second =
        dt * dt / 2 - Real(short_dt * short_dt * (x * x) / 24);  // (1 - cos(x)) / w^2
    Pose next = pose_known;
    const auto swing = [&](Real& sine, Real& cosine, Real& rate, Real& acceleration) {
      const Real grown = rate * first + acceleration * second;
      numerics::turn<Real>(sine, cosine, grown);
      if constexpr (with_rates) {
        rate += acceleration * first - speed_squared_ * (rate * second);
        acceleration -= speed_squared_ * grown;
      }
    };
    swing(next.sin_alpha, next.cos_alpha, next.theta_rate, next.theta_acceleration);
    swing(next.sin_gamma, next.cos_gamma, next.gamma_rate, next.gamma_acceleration);
    return next;
  }
  Vec3<Real> position_nearby(const Instant<Real>& when, const Pose& pose,
      const Instant<Real>& known, const Vec3<Real>& position) const {
    return position_in_vessel(pose_nearby<false>(when, pose, known), position);
  }

  /// Axes of the vessel frame x (along the arm), y (vessel axis), z in inertial coordinates.
  static Vec3<Real> axis_x(const Pose& p) { return {-p.sin_alpha, p.cos_alpha, Real(0)}; }
  static Vec3<Real> axis_y(const Pose& p) {
    return {-p.cos_alpha * p.cos_gamma, -p.sin_alpha * p.cos_gamma, p.sin_gamma};
  }
  static Vec3<Real> axis_z(const Pose& p) {
    return {p.cos_alpha * p.sin_gamma, p.sin_alpha * p.sin_gamma, p.cos_gamma};
  }
  /// A direction in the vessel frame, seen in the inertial one.
  static Vec3<Real> direction_to_inertial(const Pose& pose, const Vec3<Real>& n) {
    const Vec3<Real> x = axis_x(pose), y = axis_y(pose), z = axis_z(pose);
    const auto along = [&](int k) { return Real(x[k] * n[0] + y[k] * n[1] + z[k] * n[2]); };
    return {along(0), along(1), along(2)};
  }
  /// Inertial position of a point of the vessel frame: P = R_z(theta) [ (l,0,0) + R_x(gamma) p ].
  /// (2.7')
  Vec3<Real> to_inertial(const Pose& pose, const Vec3<Real>& p) const {
    const Real along_arm = arm_ + p[0];
    const Real b = p[1] * pose.cos_gamma - p[2] * pose.sin_gamma;
    const Real height = p[1] * pose.sin_gamma + p[2] * pose.cos_gamma;
    return {-pose.sin_alpha * along_arm - pose.cos_alpha * b,
        pose.cos_alpha * along_arm - pose.sin_alpha * b, height};
  }
  /// (2.16'): where a body is in the vessel.
  Vec3<Real> position_in_vessel(const Pose& pose, const Vec3<Real>& position) const {
    const auto [a, b] = in_plane(pose, position);
    return {a - arm_, b * pose.cos_gamma + position[2] * pose.sin_gamma,
        position[2] * pose.cos_gamma - b * pose.sin_gamma};
  }
  /// (2.16') and its time derivative for a body at `position` moving with `velocity`.
  VesselFrameState<Real> to_vessel_frame(
      const Pose& pose, const Vec3<Real>& position, const Vec3<Real>& velocity) const {
    const auto [a, b] = in_plane(pose, position);
    const auto [velocity_a, velocity_b] = in_plane(pose, velocity);
    const Real a_rate = velocity_a + pose.theta_rate * b, b_rate = velocity_b - pose.theta_rate * a;
    const Real y = b * pose.cos_gamma + position[2] * pose.sin_gamma;
    const Real z = position[2] * pose.cos_gamma - b * pose.sin_gamma;
    const Real y_rate =
        (b_rate * pose.cos_gamma + velocity[2] * pose.sin_gamma) + pose.gamma_rate * z;
    const Real z_rate =
        (velocity[2] * pose.cos_gamma - b_rate * pose.sin_gamma) - pose.gamma_rate * y;
    return {{a - arm_, y, z}, {a_rate, y_rate, z_rate}};
  }
  /// Second time derivative of a body's vessel-frame position while it falls freely.
  /// @param state  of to_vessel_frame for the same body and pose
  Vec3<Real> vessel_frame_acceleration(const Pose& pose, const VesselFrameState<Real>& state,
      const Vec3<Real>& velocity, const Vec3<Real>& gravity) const {
    const auto &p = state.position, &u = state.velocity;
    const Real &sg = pose.sin_gamma, &cg = pose.cos_gamma;
    const Real &turn = pose.theta_rate, &turn_rate = pose.theta_acceleration;
    const Real &tilt = pose.gamma_rate, &tilt_rate = pose.gamma_acceleration;
    const Real a = p[0] + arm_, b = p[1] * cg - p[2] * sg;
    const auto [velocity_a, velocity_b] = in_plane(pose, velocity);
    const auto [gravity_a, gravity_b] = in_plane(pose, gravity);
    const Real b_rate = velocity_b - turn * a;
    const Real a_second = gravity_a + turn * velocity_b + (turn_rate * b + turn * b_rate);
    const Real b_second = gravity_b - turn * velocity_a - (turn_rate * a + turn * u[0]);
    // y' = b' cos + V_Z sin + gamma' z and z' = V_Z cos - b' sin - gamma' y, once more.
    const Real turned = velocity[2] * cg - b_rate * sg, raised = b_rate * cg + velocity[2] * sg;
    return {a_second,
        (b_second * cg + gravity[2] * sg) + tilt * turned + (tilt_rate * p[2] + tilt * u[2]),
        (gravity[2] * cg - b_second * sg) - tilt * raised - (tilt_rate * p[1] + tilt * u[1])};
  }
  /// Inertial angular velocity of the vessel: theta' about Z plus gamma' about x'.
  static Vec3<Real> angular_velocity(const Pose& pose) {
    return {-pose.sin_alpha * pose.gamma_rate, pose.cos_alpha * pose.gamma_rate, pose.theta_rate};
  }
  /// Inertial velocity of the vessel's material point at `point`: V = W_Z x P + (R_z W_x') x (P -
  /// C).
  Vec3<Real> wall_velocity(const Pose& pose, const Vec3<Real>& point) const {
    const Vec3<Real> centre{-pose.sin_alpha * arm_, pose.cos_alpha * arm_, Real(0)};
    const Vec3<Real> about_z{Real(0), Real(0), pose.theta_rate};
    const Vec3<Real> about_arm{
        -pose.sin_alpha * pose.gamma_rate, pose.cos_alpha * pose.gamma_rate, Real(0)};
    return cross<Real>(about_z, point) + cross<Real>(about_arm, point - centre);
  }
  Vec3<Real> wall_acceleration(const Pose& pose, const Vec3<Real>& point) const {
    const Vec3<Real> centre{-pose.sin_alpha * arm_, pose.cos_alpha * arm_, Real(0)};
    const Vec3<Real> about_z{Real(0), Real(0), pose.theta_rate};
    const Vec3<Real> about_z_rate{Real(0), Real(0), pose.theta_acceleration};
    const Vec3<Real> omega = angular_velocity(pose), axis = axis_x(pose);
    // d/dt omega: the arm axis itself turns about Z.
    const Vec3<Real> about_arm = axis * pose.gamma_rate,
                     speeding_up = axis * pose.gamma_acceleration;
    const Vec3<Real> omega_rate = about_z_rate + speeding_up + cross<Real>(about_z, about_arm);
    const Vec3<Real> centre_acceleration =
        cross<Real>(about_z_rate, centre) + cross<Real>(about_z, cross<Real>(about_z, centre));
    const Vec3<Real> d = point - centre, turning = cross<Real>(omega, d);
    return centre_acceleration + cross<Real>(omega_rate, d) + cross<Real>(omega, turning);
  }

  /// Upper bound on the sum of both angles [rad].
  Real angles() const { return theta_max_ + gamma_max_; }
  /// Bound on the vessel's angular speed [rad/s].
  const Real& turning() const { return turning_; }
  Vec3<Real> middle() const { return {Real(0), arm_, Real(0)}; }
  Real reach(const Real& vessel_reach) const { return arm_ + vessel_reach; }
  Real wall_speed(const Real& vessel_reach) const {
    const Real from_fulcrum = arm_ + vessel_reach;
    return angular_speed_ * (theta_max_ * from_fulcrum + gamma_max_ * (from_fulcrum - arm_));
  }
  Real speed_within(const Real& distance) const { return turning() * distance; }
  Real acceleration_within(const Real& distance) const {
    return turning() * angular_speed_ * distance;
  }
  Real longest_window() const { return window_of(period_, turning()); }
  SweptBox<Real> swept(const Vec3<Real>& sizes, const Real& vessel_reach) const {
    const Real swing = theta_max_ < 1 ? theta_max_ : Real(1),
               tilt = gamma_max_ < 1 ? gamma_max_ : Real(1);
    const Real sideways = arm_ * swing + vessel_reach, upright = sizes[2] + sizes[1] * tilt;
    const Real along = sizes[0] + (sizes[1] + sizes[2] * tilt) * swing;
    const Real nearest = arm_ * (1 - swing * swing) - along;
    return {{-sideways, nearest, Real(-upright)}, {sideways, Real(arm_ + along), upright}};
  }
  /// Bounds for a ball whose speed stays below `speed` [m/s] over a window of `length` [s] that it
  /// enters inside a vessel of these sizes. Derivation: docs/theory.md, section 3.
  CoordinateBounds<Real> coordinate_bounds(const Vec3<Real>& sizes, const Real& vessel_reach,
      const Real& gravity, const Real& speed, const Real& length) const {
    const Real& w = angular_speed_;
    Majorant<Real> alpha, gamma, sine, cosine;
    Real power{1};
    for (int k = 0; k < 5; ++k, power *= w) {
      alpha[k] = theta_max_ * power;
      gamma[k] = gamma_max_ * power;
    }
    fill_sin_cos(gamma, sine, cosine);

    // How far outside the vessel the path may get within the window: |p'| <= U.
    const Real shrink = 1 - (alpha[1] + gamma[1]) * length;
    const Real frame_speed =
        (speed + alpha[1] * (arm_ + vessel_reach) + gamma[1] * vessel_reach) / shrink;
    const Real excursion = frame_speed * length;

    // Gravity and velocity in the frame that turns with theta: G' = alpha' G, V' = G + alpha' V.
    Majorant<Real> g{gravity}, v{speed};
    const Majorant<Real> v_z{speed, gravity};
    Majorant<Real> x{sizes[0] + excursion}, y{sizes[1] + excursion}, z{sizes[2] + excursion};
    Majorant<Real> a{arm_ + x[0]}, b{y[0] + sine[0] * z[0]};
    for (int k = 0; k < 4; ++k) {
      g[k + 1] = product_bound(alpha, 1, g, k);
      v[k + 1] = g[k] + product_bound(alpha, 1, v, k);
      a[k + 1] = v[k] + product_bound(alpha, 1, b, k);
      b[k + 1] = v[k] + product_bound(alpha, 1, a, k);
      x[k + 1] = a[k + 1];
      // The bounds on b' enter through b shifted by one derivative.
      y[k + 1] = product_bound(v_z, 0, sine, k) + product_bound(gamma, 1, z, k);
      z[k + 1] = product_bound(v_z, 0, cosine, k) + product_bound(gamma, 1, y, k);
      for (int j = 0; j <= k; ++j) {
        y[k + 1] += binomial[k][j] * b[j + 1] * cosine[k - j];
        z[k + 1] += binomial[k][j] * b[j + 1] * sine[k - j];
      }
    }
    return {x, y, z};
  }

  Real speed_in_vessel(const FlightBounds<Real>& f) const { return f.speed + turning() * f.reach; }
  Real acceleration_in_vessel(const FlightBounds<Real>& f) const {
    return f.gravity + 4 * turning() * f.speed +
        2 * turning() * (angular_speed_ + 2 * turning()) * f.reach;
  }
  /// The constants are derived in docs/theory.md, section 4; a test compares them with measured
  /// errors.
  ErrorBounds<Real> coordinate_errors(const Real& u, const FlightBounds<Real>& f) const {
    const Real angle = 10 + 16 * angles();  // error of the pose and the products, in ulps of 1
    const Real time = f.elapsed + 3 * f.lag;
    const Real position = 6 * f.reach + 4 * (f.gravity * f.elapsed * f.elapsed) + f.speed * time;
    const Real y = u * (angle * f.reach + 2 * position);
    const Real y_rate = u *
        ((angle + 4) * f.speed + 28 * turning() * f.reach + 2 * turning() * position +
            4 * f.gravity * f.elapsed);
    return {y, y_rate, second_error(u * (32 + 16 * angles()), f, y, y_rate)};
  }
  /// Additional errors from rounding a wider flight and motion to this scalar, at offsets that are
  /// the same numbers in both.
  ErrorBounds<Real> state_errors(const Real& u, const FlightBounds<Real>& f) const {
    const Real angle = 9 * angles();
    const Real time = period_ + f.lag;  // ulps of 1 s that the start and the whole periods leave
    const Real y = u *
        ((angle + 3) * f.reach + f.speed * (f.elapsed + time) +
            2 * (f.gravity * f.elapsed * f.elapsed));
    const Real y_rate = u *
            ((angle + 2) * f.speed + (angle + 10) * turning() * f.reach +
                f.gravity * (2 * f.elapsed + time)) +
        turning() * y;
    return {y, y_rate, second_error(u * (32 + 9 * angles()), f, y, y_rate)};
  }
 private:
  /// Components of an inertial vector in the plane of the arm's swing: along the arm, and across
  /// it.
  struct InPlane {
    Real a, b;
  };
  static InPlane in_plane(const Pose& pose, const Vec3<Real>& v) {
    return {v[1] * pose.cos_alpha - v[0] * pose.sin_alpha,
        -(v[0] * pose.cos_alpha + v[1] * pose.sin_alpha)};
  }
  Real second_error(
      const Real& relative, const FlightBounds<Real>& f, const Real& y, const Real& y_rate) const {
    return relative * f.vessel_acceleration + 4 * turning() * y_rate +
        2 * turning() * (angular_speed_ + turning()) * y;
  }

  Real arm_{0}, theta_max_{0}, gamma_max_{0};
  Real period_{0}, angular_speed_{0}, frequency_{0};
  Real theta_speed_{0}, gamma_speed_{0};  ///< largest theta' and gamma' [rad/s]
  Real speed_squared_{0};                 ///< [rad^2/s^2]
  Real turning_{0};
};

}  // namespace edmill::model
