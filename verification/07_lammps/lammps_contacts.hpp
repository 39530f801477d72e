// LAMMPS's contacts as laws of an impact: their restitution and what they leave of a slip.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "edmill/contact_law.hpp"
#include "lammps_mill.hpp"
#include "model/contact_law.hpp"

namespace edmill::verification {

/// Contacts so short that the normal does not turn during them: those that laws are measured on.
/// [s]
inline constexpr double brief = 1e-6;

/// Young's modulus at which a ball that meets a wall at v = 1 m/s touches it for `duration` by
/// Hertz's theory: 2.9432 x / v, with the depth x = (5 m v^2 / (4 k))^(2/5), the force k x^(3/2), k
/// = (4/3) E / (2 (1
/// - nu^2)) sqrt(R).
inline double modulus_of(double duration, double diameter, const LammpsSetting& s) {
  const double radius = diameter / 2, mass = s.density * 4 / 3 * pi * std::pow(radius, 3);
  const double k = 5 * mass / 4 / std::pow(duration / 2.9432, 2.5);
  return k * 3 / 4 / std::sqrt(radius) * 2 * (1 - s.poisson * s.poisson);
}

inline LammpsSetting setting_of(double diameter, double contact_duration, double friction = 0.4) {
  LammpsSetting s;
  s.vessel_radius = 0.019, s.vessel_half_height = 0.0285;
  s.ball_diameter = diameter, s.density = 8000, s.friction = friction;
  s.modulus = modulus_of(contact_duration, diameter, s);
  s.time_step = contact_duration / 50;
  return s;
}

/// Linear springs under which a ball touches a wall for `duration` at any speed: half a period of
/// pi / duration.
inline void make_linear(LammpsSetting& s, double contact_duration) {
  const double radius = s.ball_diameter / 2,
               mass = s.density * 4 / 3 * pi * radius * radius * radius;
  s.stiffness = mass * pi * pi / (contact_duration * contact_duration);
}

/// What an impact leaves of the approach and of the slip of the surfaces: restitution and e_t.
struct Left {
  double normal, tangential;
};

/// An impact in LAMMPS of a ball with a cap, or of two balls: the mean over impacts that begin at
/// different places within a step. @param speed, slip  approach and slip [m/s]
inline Left impact(
    const LammpsSetting& s, bool pair, double speed, double slip = 0, int phases = 8) {
  const double radius = s.ball_diameter / 2;
  Left sum{0, 0};
  for (int k = 0; k < phases; ++k) {
    const double gap = speed * s.time_step * (1 + (k + 0.5) / phases);
    std::vector<LammpsBall> balls{
        {{0, s.vessel_half_height - radius - gap, 0}, {slip, speed, 0}, {}}};
    if (pair)
      balls = {{{0, -radius - gap / 2, 0}, {slip / 2, speed / 2, 0}, {}},
          {{0, radius + gap / 2, 0}, {-slip / 2, -speed / 2, 0}, {}}};
    LammpsMill mill(s, balls);
    const auto velocity = [&] {
      auto now = mill.balls();
      if (!pair) now.push_back({});
      return Left{now[0].velocity[1] - now[1].velocity[1],
          now[0].velocity[0] - now[1].velocity[0] - (now[0].spin[2] + now[1].spin[2]) * radius};
    };
    // Parting, and at the same velocities later on.
    Left left = velocity(), before{1, 0};
    for (int i = 0; i < 100 &&
         (left.normal > 0 || left.normal != before.normal || left.tangential != before.tangential);
         ++i) {
      before = left;
      mill.run(50);
      left = velocity();
    }
    sum.normal -= left.normal / speed / phases;
    if (slip != 0) sum.tangential += left.tangential / slip / phases;
  }
  return sum;
}

/// Restitution of head-on impacts.
inline double rebound(const LammpsSetting& s, bool pair, double speed, int phases = 8) {
  return impact(s, pair, speed, 0, phases).normal;
}

/// The number for `damping tsuji` at which LAMMPS's own balls rebound with `restitution`, in fine
/// steps.
inline double damping_for(double restitution, LammpsSetting s) {
  s.time_step /= 8;
  double low = 0.1, high = 0.99;
  for (int i = 0; i < 20; ++i) {
    s.damping = (low + high) / 2;
    (rebound(s, false, 1, 1) < restitution ? low : high) = s.damping;
  }
  return (low + high) / 2;
}

/// Walton and Braun's law turns from sticking to sliding at once; a Mindlin contact slips in part
/// between them. This law has the restitution and e_t, by slip over approach, that LAMMPS's own
/// contacts have with the time step of its mills, of walls or of pairs: their springs along the
/// surface differ by more than a factor of two.
class MindlinLaw : public CustomLaw<double> {
 public:
  MindlinLaw(LammpsSetting s, bool pair) : restitution_(impact(s, pair, 1).normal) {
    for (double slip = 0.125; slip <= 8; slip += slip < 3 ? 0.125 : 0.5) {
      slips_.push_back(slip);
      left_.push_back(
          std::min(1.0, impact(s, pair, 1, slip).tangential));  // 1 + 4e-5 without friction
    }
  }

  double restitution(const double&) const override { return restitution_; }
  double restitution_of_slip(const double& normal_change, const double& slip_speed,
      const double& /*compliance*/) const override {
    if (!(normal_change > 0)) return 1;
    const double slip = slip_speed * (1 + restitution_) / normal_change;  // over the approach
    if (slip <= slips_.front()) return left_.front();
    if (slip >= slips_.back())
      return 1 - (1 - left_.back()) * slips_.back() / slip;  // all of it slides
    const auto k = std::upper_bound(slips_.begin(), slips_.end(), slip) - slips_.begin();
    const double share = (slip - slips_[k - 1]) / (slips_[k] - slips_[k - 1]);
    return left_[k - 1] + share * (left_[k] - left_[k - 1]);
  }
 private:
  double restitution_;
  std::vector<double> slips_, left_;
};

inline model::LawOfProgram<double> law_of_contacts(const LammpsSetting& s, bool pair) {
  return {std::make_shared<MindlinLaw>(s, pair)};
}

}  // namespace edmill::verification
