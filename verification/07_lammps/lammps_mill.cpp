#include "lammps_mill.hpp"

#include <cmath>
#include <sstream>

namespace edmill::verification {
namespace {

Triple cross(const Triple& a, const Triple& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const Triple& a, const Triple& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Triple triple(const double* v) { return {v[0], v[1], v[2]}; }
Triple plus(const Triple& a, double factor, const Triple& b) {
  return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}

}  // namespace

VesselFrame::VesselFrame(const LammpsMotion& m, double time)
    : spin{}, spin_rate{}, pull{0, -m.gravity, 0} {
  if (m.period == 0) return;
  const double w = 2 * pi / m.period, c = std::cos(w * time), s = std::sin(w * time);
  const double theta = m.theta_max * c + pi / 2, theta_rate = -m.theta_max * w * s,
               theta_second = -m.theta_max * w * w * c;
  const double gamma = m.gamma_max * s, gamma_rate = m.gamma_max * w * c,
               gamma_second = -w * w * gamma;
  const double cg = std::cos(gamma), sg = std::sin(gamma);
  // The vessel turns with theta' about Z and with gamma' about x'; Z is (0, sin gamma, cos gamma)
  // to it.
  spin = {gamma_rate, theta_rate * sg, theta_rate * cg};
  spin_rate = {gamma_second, theta_second * sg + theta_rate * gamma_rate * cg,
      theta_second * cg - theta_rate * gamma_rate * sg};
  // In the axes turned by theta alone: gravity, less the centre's acceleration on its circle about
  // Z.
  const double along = -m.gravity * std::sin(theta) + m.arm * theta_rate * theta_rate,
               across = -m.gravity * std::cos(theta) - m.arm * theta_second;
  pull = {along, across * cg, -across * sg};
}

Triple VesselFrame::acceleration(const Triple& position, const Triple& velocity) const {
  const Triple coriolis = cross(spin, velocity), euler = cross(spin_rate, position),
               centrifugal = cross(spin, cross(spin, position));
  return plus(plus(plus(pull, -2, coriolis), -1, euler), -1, centrifugal);
}

Triple VesselFrame::spin_acceleration(const Triple& relative_spin) const {
  return plus(plus({}, -1, spin_rate), -1, cross(spin, relative_spin));
}

LammpsMill::LammpsMill(const LammpsSetting& s, const std::vector<LammpsBall>& balls)
    : setting_(s), count_(static_cast<int>(balls.size())) {
  const double radius = s.ball_diameter / 2;
  mass_ = s.density * 4 / 3 * pi * radius * radius * radius;
  inertia_ = 0.4 * mass_ * radius * radius;
  const auto say = [&](const auto&... parts) {
    std::ostringstream line;
    line.precision(17);
    (line << ... << parts);
    lammps_.command(line.str());
  };
  say("units si");
  say("atom_style sphere");
  say("atom_modify sort 0 0");
  say("boundary f f f");
  say("comm_modify vel yes");
  const double wide = 1.2 * s.vessel_radius, high = 1.2 * s.vessel_half_height;
  say("region box block ", -wide, " ", wide, " ", -high, " ", high, " ", -wide, " ", wide,
      " units box");
  say("create_box 1 box");
  for (const LammpsBall& b : balls)
    say("create_atoms 1 single ", b.position[0], " ", b.position[1], " ", b.position[2],
        " units box");
  say("set group all diameter ", s.ball_diameter, " density ", s.density);
  // limit_damping: without it a parting contact attracts, and friction takes mu times that force
  // too.
  std::ostringstream contact;
  contact.precision(17);
  // The polynomial of tsuji has no zero at restitution 1.
  const bool elastic = s.damping == 1;
  if (s.stiffness > 0)
    contact << " hooke " << s.stiffness << " " << (elastic ? 0 : s.damping)
            << " tangential linear_history " << s.stiffness * 2 / 7;
  else
    contact << " hertz/material " << s.modulus << " " << (elastic ? 0 : s.damping) << " "
            << s.poisson << " tangential "
            << (s.without_springs ? "linear_nohistory" : "mindlin NULL");
  contact << " " << s.tangential_damping << " " << s.friction << " damping "
          << (elastic ? "velocity" : "tsuji") << " limit_damping ";
  say("pair_style granular");
  say("pair_coeff * *", contact.str());
  say("neighbor ", 0.3 * radius, " bin");
  say("neigh_modify delay 0 every 1 check yes");
  if (s.vial.empty())
    say("region vial cylinder y 0 0 ", s.vessel_radius, " ", -s.vessel_half_height, " ",
        s.vessel_half_height, " side in units box");
  for (const auto& command : s.vial) say(command);
  say("fix walls all wall/gran/region granular", contact.str(), "region vial");
  for (std::size_t k = 0; k < s.bodies.size(); ++k) {
    say("variable angle", k, " equal step*dt*", s.bodies[k].speed);
    say("region body", k, " ", s.bodies[k].region, " side out units box rotate v_angle", k,
        " 0 0 0 0 1 0");
    say("fix body", k, " all wall/gran/region granular", contact.str(), "region body", k,
        " contacts");
  }
  work_of_bodies_.resize(s.bodies.size());
  say("fix motion all nve/sphere");
  // After the walls: `drive` then sees all forces of the contacts.
  say("fix frame all external pf/callback 1 1");
  lammps_.set_callback("frame", &LammpsMill::on_step, this);
  say("timestep ", s.time_step);
  say("thermo_modify lost error");
  double **v = lammps_.vectors("v"), **spins = lammps_.vectors("omega");
  for (int i = 0; i < count_; ++i)
    for (int k = 0; k < 3; ++k) v[i][k] = balls[i].velocity[k], spins[i][k] = balls[i].spin[k];
  first_energy_ = kinetic_energy();
  lammps_.command("run 0");
}

void LammpsMill::run(std::int64_t steps) {
  lammps_.command("run " + std::to_string(steps) + " pre no post no");
  steps_ += steps;
}

std::vector<LammpsBall> LammpsMill::balls() {
  double **x = lammps_.vectors("x"), **v = lammps_.vectors("v"), **spins = lammps_.vectors("omega");
  std::vector<LammpsBall> all;
  for (int i = 0; i < count_; ++i) all.push_back({triple(x[i]), triple(v[i]), triple(spins[i])});
  return all;
}

double LammpsMill::kinetic_energy() {
  double sum = 0;
  for (const LammpsBall& b : balls())
    sum += mass_ / 2 * dot(b.velocity, b.velocity) + inertia_ / 2 * dot(b.spin, b.spin);
  return sum;
}

void LammpsMill::on_step(
    void* self, std::int64_t step, int count, int*, double** x, double** forces) {
  static_cast<LammpsMill*>(self)->drive(step, count, x, forces);
}

/// LAMMPS calls between its two half kicks: positions are those of the step, velocities half a step
/// older. The step's own velocity needs all forces, of which those that depend on velocity are
/// taken with the older one.
void LammpsMill::drive(std::int64_t step, int count, double** x, double** forces) {
  if (count != count_) throw std::runtime_error("LAMMPS lost a ball");
  double **v = lammps_.vectors("v"), **spins = lammps_.vectors("omega");
  double **force = lammps_.vectors("f"), **torque = lammps_.vectors("torque");
  const double dt = setting_.time_step, half = step == 0 ? 0 : dt / 2;
  const VesselFrame frame = frame_at(static_cast<double>(step) * dt);
  for (int i = 0; i < count; ++i) {
    const Triple p = triple(x[i]), old_v = triple(v[i]), old_spin = triple(spins[i]);
    Triple a = frame.acceleration(p, old_v), turn = frame.spin_acceleration(old_spin);
    const Triple now_v = plus(plus(old_v, half / mass_, triple(force[i])), half, a),
                 now_spin = plus(plus(old_spin, half / inertia_, triple(torque[i])), half, turn);
    a = frame.acceleration(p, now_v);
    turn = frame.spin_acceleration(now_spin);
    for (int k = 0; k < 3; ++k) {
      forces[i][k] = mass_ * a[k];
      torque[i][k] += inertia_ * turn[k];
    }
    if (step > driven_ && step > 0)
      work_ += dt * (mass_ * dot(a, now_v) + inertia_ * dot(turn, now_spin));
  }
  if (step > driven_ && step > 0) add_work_of_bodies();
  driven_ = step;
}

/// The torque of the contacts, with the fix's force on a ball and its place.
void LammpsMill::add_work_of_bodies() {
  for (std::size_t k = 0; k < work_of_bodies_.size(); ++k) {
    double** rows = lammps_.rows_of_fix("body" + std::to_string(k));
    double torque = 0;
    for (int i = 0; i < count_; ++i)
      if (rows[i][0] > 0) torque += rows[i][6] * rows[i][1] - rows[i][4] * rows[i][3];
    const double done = setting_.time_step * setting_.bodies[k].speed * torque;
    work_of_bodies_[k] += done;
    work_ += done;
  }
}

}  // namespace edmill::verification
