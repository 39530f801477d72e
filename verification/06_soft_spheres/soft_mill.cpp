#include "soft_mill.hpp"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

namespace edmill::verification {
namespace {

constexpr double pi = 3.14159265358979323846, inertia = 0.4;

Triple operator+(const Triple& a, const Triple& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Triple operator-(const Triple& a, const Triple& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Triple operator*(double s, const Triple& a) { return {s * a[0], s * a[1], s * a[2]}; }
double dot(const Triple& a, const Triple& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Triple cross(const Triple& a, const Triple& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Triple triple(const double* v) { return {v[0], v[1], v[2]}; }

/// Axes of the vessel in the inertial frame and its centre, with their rates, by differentiating
/// P = R_z(theta) [ (l,0,0) + R_x(gamma) p ] term by term.
struct Vessel {
  std::array<Triple, 3> axis, axis_rate;
  Triple centre, centre_rate;

  Vessel(const SoftSetting& s, double time) {
    const double w = 2 * pi / s.period, angle = w * time;
    const double theta = s.amplitude * std::cos(angle) + pi / 2,
                 theta_rate = -s.amplitude * w * std::sin(angle);
    const double gamma = s.amplitude * std::sin(angle),
                 gamma_rate = s.amplitude * w * std::cos(angle);
    const double ct = std::cos(theta), st = std::sin(theta), cg = std::cos(gamma),
                 sg = std::sin(gamma);
    const Triple out{ct, st, 0}, side{-st, ct, 0}, up{0, 0, 1};
    axis = {out, cg * side + sg * up, cg * up - sg * side};
    const Triple out_rate = theta_rate * side, side_rate = -theta_rate * out;
    axis_rate = {
        out_rate, gamma_rate * axis[2] + cg * side_rate, -gamma_rate * axis[1] - sg * side_rate};
    centre = s.arm * out, centre_rate = s.arm * out_rate;
  }
  Triple inward(const Triple& point) const {
    const Triple d = point - centre;
    return {dot(axis[0], d), dot(axis[1], d), dot(axis[2], d)};
  }
  Triple outward(const Triple& p) const { return p[0] * axis[0] + p[1] * axis[1] + p[2] * axis[2]; }
  Triple velocity(const Triple& point) const {
    const Triple p = inward(point);
    return centre_rate + p[0] * axis_rate[0] + p[1] * axis_rate[1] + p[2] * axis_rate[2];
  }
};

struct Touch {
  double gap;
  Triple normal;  ///< away from the wall, in the vessel's axes
};

std::array<Touch, 3> walls(const SoftSetting& s, const Triple& p) {
  const double r = std::hypot(p[0], p[2]), free_height = s.vessel_half_height - s.ball_radius;
  return {{{free_height + p[1], {0, 1, 0}}, {free_height - p[1], {0, -1, 0}},
      {s.vessel_radius - s.ball_radius - r,
          r > 0 ? (-1 / r) * Triple{p[0], 0, p[2]} : Triple{1, 0, 0}}}};
}

}  // namespace

/// With share s = c / (2 sqrt(k m)), depth x, rate x': k x + c x' vanishes first when the phase of
/// the damped oscillation is pi - atan2(2 s q, 1 - 2 s^2), q = sqrt(1 - s^2), and there x' = -v
/// exp(-s phase / q).
Dashpot::Dashpot(double restitution) {
  const auto phase = [](double s) {
    return pi - std::atan2(2 * s * std::sqrt(1 - s * s), 1 - 2 * s * s);
  };
  double low = 0, high = 0.999;
  for (int i = 0; i < 60; ++i) {
    share = (low + high) / 2;
    const double e = std::exp(-share * phase(share) / std::sqrt(1 - share * share));
    (e > restitution ? low : high) = share;
  }
  duration = phase(share) / std::sqrt(1 - share * share);
}

SoftMill::SoftMill(const SoftSetting& setting, const std::vector<SoftBall>& balls)
    : setting_(setting), count_(static_cast<int>(balls.size())), step_(setting.contact_time / 100) {
  const Dashpot dashpot(setting.restitution);
  stiffness_ = std::pow(dashpot.duration / setting.contact_time, 2);
  damping_share_ = dashpot.share;
  drag_ = setting.stickiness / setting.contact_time;
  for (const SoftBall& b : balls)
    for (const Triple* part : {&b.position, &b.velocity, &b.spin})
      y_.insert(y_.end(), part->begin(), part->end());
}

/// Newton's and Euler's equations. In a contact of reduced mass M the normal force is k x + c x'
/// and never pulls; friction opposes the slip with mu times that, or less when a drag that stops it
/// within a small part of the contact asks for less.
int SoftMill::rates(double time, const double y[], double dydt[], void* self) {
  const SoftMill& mill = *static_cast<SoftMill*>(self);
  const SoftSetting& s = mill.setting_;
  const double R = s.ball_radius;
  const Vessel vessel(s, time);
  const auto part = [&](int ball, int k) { return triple(y + 9 * ball + 3 * k); };
  for (int i = 0; i < mill.count_; ++i) {
    double* d = dydt + 9 * i;
    for (int k = 0; k < 3; ++k)
      d[k] = y[9 * i + 3 + k], d[3 + k] = k == 1 ? -s.gravity : 0, d[6 + k] = 0;
  }
  const auto push = [&](int ball, const Triple& normal, const Triple& force) {
    const Triple turn = (-R / (inertia * R * R)) * cross(normal, force);
    for (int k = 0; k < 3; ++k)
      dydt[9 * ball + 3 + k] += force[k], dydt[9 * ball + 6 + k] += turn[k];
  };
  // `g` is the velocity of the contact point of the ball against the partner's.
  const auto force = [&](double depth, const Triple& n, const Triple& g, double mass) -> Triple {
    const double damping = 2 * mill.damping_share_ * std::sqrt(mill.stiffness_ * mass);
    const double press = std::max(0.0, mill.stiffness_ * depth - damping * dot(g, n));
    const Triple slip = g - dot(g, n) * n;
    const double speed = std::sqrt(dot(slip, slip)), pull = 1 / mass * (1 + 1 / inertia);
    const double friction = std::min(s.friction * press, mill.drag_ / pull * speed);
    return press * n - (speed > 0 ? friction / speed : 0) * slip;
  };
  for (int i = 0; i < mill.count_; ++i) {
    for (const Touch& touch : walls(s, vessel.inward(part(i, 0)))) {
      if (touch.gap >= 0) continue;
      const Triple n = vessel.outward(touch.normal), arm = -R * n;
      const Triple g = part(i, 1) + cross(part(i, 2), arm) - vessel.velocity(part(i, 0) + arm);
      push(i, n, force(-touch.gap, n, g, 1));
    }
    for (int j = 0; j < i; ++j) {
      const Triple apart = part(i, 0) - part(j, 0);
      const double distance = std::sqrt(dot(apart, apart));
      if (distance >= 2 * R) continue;
      const Triple n = (1 / distance) * apart;
      const Triple g = part(i, 1) - part(j, 1) - cross(R * (part(i, 2) + part(j, 2)), n);
      const Triple f = force(2 * R - distance, n, g, 0.5);
      push(i, n, f);
      push(j, -1.0 * n, -1.0 * f);
    }
  }
  return GSL_SUCCESS;
}

double SoftMill::smallest_gap(double time) const {
  const Vessel vessel(setting_, time);
  double least = 1;
  for (int i = 0; i < count_; ++i) {
    const Triple r = triple(&y_[9 * i]);
    for (const Touch& touch : walls(setting_, vessel.inward(r))) least = std::min(least, touch.gap);
    for (int j = 0; j < i; ++j) {
      const Triple apart = r - triple(&y_[9 * j]);
      least = std::min(least, std::sqrt(dot(apart, apart)) - 2 * setting_.ball_radius);
    }
  }
  return least;
}

void SoftMill::advance(double time) {
  const std::size_t size = y_.size();
  const std::unique_ptr<gsl_odeiv2_step, void (*)(gsl_odeiv2_step*)> stepper(
      gsl_odeiv2_step_alloc(gsl_odeiv2_step_rk8pd, size), gsl_odeiv2_step_free);
  const std::unique_ptr<gsl_odeiv2_control, void (*)(gsl_odeiv2_control*)> control(
      gsl_odeiv2_control_y_new(setting_.tolerance, setting_.tolerance), gsl_odeiv2_control_free);
  const std::unique_ptr<gsl_odeiv2_evolve, void (*)(gsl_odeiv2_evolve*)> evolve(
      gsl_odeiv2_evolve_alloc(size), gsl_odeiv2_evolve_free);
  gsl_odeiv2_system system{&SoftMill::rates, nullptr, size, this};
  while (time_ < time) {
    // No step may jump over a contact: nothing here approaches faster than 20 m/s.
    step_ = std::min(step_, std::max(setting_.contact_time / 20, smallest_gap(time_) / 20));
    if (gsl_odeiv2_evolve_apply(evolve.get(), control.get(), stepper.get(), &system, &time_, time,
            &step_, y_.data()) != GSL_SUCCESS)
      throw std::runtime_error("GSL's integration failed");
  }
}

std::vector<SoftBall> SoftMill::balls() const {
  std::vector<SoftBall> all;
  for (int i = 0; i < count_; ++i)
    all.push_back({triple(&y_[9 * i]), triple(&y_[9 * i + 3]), triple(&y_[9 * i + 6])});
  return all;
}

}  // namespace edmill::verification
