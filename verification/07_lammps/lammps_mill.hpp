// A ball mill in LAMMPS: balls in the vessel's frame, where the walls stand still.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "lammps_library.hpp"

namespace edmill::verification {

inline constexpr double pi = 3.14159265358979323846;
using Triple = std::array<double, 3>;

/// The mill's motion, from docs/theory.md, section 1; a still vessel has period 0.
struct LammpsMotion {
  double arm = 0, theta_max = 0, gamma_max = 0;  ///< [m, rad, rad]
  double period = 0;                             ///< [s]
  double gravity = 0;                            ///< along inertial -Y [m/s2]
};

/// What drives a free ball as the vessel sees it. The vessel's axes throughout.
struct VesselFrame {
  Triple spin{}, spin_rate{};  ///< of the vessel [rad/s, rad/s2]
  Triple pull{};               ///< gravity less the acceleration of the vessel's centre [m/s2]

  VesselFrame() = default;
  VesselFrame(const LammpsMotion& motion, double time);
  /// Acceleration of a free ball: pull, Coriolis, Euler, centrifugal. [m/s2]
  Triple acceleration(const Triple& position, const Triple& velocity) const;
  /// Rate of a free ball's spin against the vessel. [rad/s2]
  Triple spin_acceleration(const Triple& relative_spin) const;
};

struct LammpsBall {
  Triple position, velocity, spin;  ///< in the vessel's frame and against it [m, m/s, rad/s]
};

/// A body in the vessel: a region of LAMMPS that turns about the y axis.
struct LammpsBody {
  std::string region;  ///< "cylinder y 0 0 0.006 -0.03 0.03"
  double speed = 0;    ///< [rad/s]
};

struct LammpsSetting {
  LammpsMotion motion;
  std::function<VesselFrame(double time)>
      frame{};  ///< of another motion, in the place of the above
  std::vector<std::string>
      vial{};  ///< commands that make the region "vial", in the place of a cylinder
  std::vector<LammpsBody> bodies{};
  double vessel_radius = 0, vessel_half_height = 0;  ///< [m]
  double ball_diameter = 0, density = 0;             ///< [m, kg/m3]
  double modulus = 0, poisson = 0.3;                 ///< Young's modulus [Pa]
  double stiffness = 0;  ///< [N/m]: linear springs in the place of Hertz's and Mindlin's
  double damping = 1;    ///< the number that `damping tsuji` takes for the restitution; 1: elastic
  double friction = 0, tangential_damping = 0;  ///< mu; the latter as a share of the normal damping
  bool without_springs =
      false;  ///< along the surface: the damping alone holds it, up to mu times the force
  double time_step = 0;  ///< [s]
};

/// Hertz, Mindlin and Coulomb between balls and with the walls of a region. Fictitious forces and
/// torques come through `fix external`, whose work is added up.
class LammpsMill {
 public:
  LammpsMill(const LammpsSetting& setting, const std::vector<LammpsBall>& balls);

  void run(std::int64_t steps);
  double time() const { return static_cast<double>(steps_) * setting_.time_step; }
  std::vector<LammpsBall> balls();
  /// What fictitious forces and torques and bodies did so far. [J]
  double work() const { return work_; }
  /// Work of the torque on a body, about the y axis. [J]
  double work_of_body(std::size_t body) const { return work_of_bodies_[body]; }
  /// Kinetic energy against the vessel, spin included. [J]
  double kinetic_energy();
  /// work() less the change of kinetic_energy(): lost in contacts, or stored in those that last.
  /// [J]
  double milling_dose() { return work_ - (kinetic_energy() - first_energy_); }
 private:
  static void on_step(
      void* self, std::int64_t step, int count, int* ids, double** x, double** forces);
  VesselFrame frame_at(double time) const {
    return setting_.frame ? setting_.frame(time) : VesselFrame(setting_.motion, time);
  }
  void drive(std::int64_t step, int count, double** x, double** forces);
  void add_work_of_bodies();

  LammpsSetting setting_;
  int count_;
  double mass_, inertia_;
  Lammps lammps_;
  std::int64_t steps_ = 0, driven_ = -1;
  double work_ = 0, first_energy_ = 0;
  std::vector<double> work_of_bodies_;
};

}  // namespace edmill::verification
