// Soft spheres in the moving vessel, written from docs/theory.md alone and integrated by GSL:
// nothing of edmill.
#pragma once

#include <array>
#include <vector>

namespace edmill::verification {

using Triple = std::array<double, 3>;

struct SoftBall {
  Triple position, velocity, spin;  ///< in the inertial frame [m, m/s, rad/s]
};

struct SoftSetting {
  double arm, amplitude, period,
      gravity;  ///< of theta and of gamma alike; gravity along -Y [m, rad, s, m/s2]
  double vessel_radius, vessel_half_height, ball_radius;  ///< [m]
  double restitution, friction;
  double contact_time;  ///< how long a ball that meets a wall touches it [s]
  double stickiness =
      200;  ///< slip of a sticking contact falls by exp(-stickiness) in a contact time
  double tolerance = 1e-9;  ///< of GSL's step control, absolute and relative
};

/// Dissipated share of the critical damping at which a linear spring and dashpot, whose contact
/// ends when their force vanishes, rebound with `restitution`, and how long the contact lasts in
/// units of sqrt(m/k).
struct Dashpot {
  double share, duration;
  explicit Dashpot(double restitution);
};

/// Balls of unit mass and reduced inertia 2/5.
class SoftMill {
 public:
  SoftMill(const SoftSetting& setting, const std::vector<SoftBall>& balls);

  /// @throws std::runtime_error when GSL's step control fails
  void advance(double time);
  std::vector<SoftBall> balls() const;
 private:
  static int rates(double time, const double y[], double dydt[], void* self);
  double smallest_gap(double time) const;

  SoftSetting setting_;
  int count_;
  double stiffness_, damping_share_, drag_;
  double time_ = 0, step_;
  std::vector<double> y_;  ///< nine numbers a ball: position, velocity, spin
};

}  // namespace edmill::verification
