// A case as a proof needs it: exact numbers, motions as chains of joints, walls as planes,
// cylinders, spheres or bodies inside the vessel.
#pragma once

#include <string>
#include <vector>

#include "casefile/case_spec.hpp"
#include "model/motions/joints.hpp"

namespace edmill::prove {

using casefile::Quantity;
using casefile::QuantityVector;

/// Decimal digits of the runs that place balls at random and order the events to be proven.
inline constexpr unsigned placing_digits = 200;

using ExactJoints = std::vector<model::Joint<Quantity>>;

struct ExactWall {
  enum Kind { plane, cylinder, sphere, solid_box, solid_cylinder } kind = plane;
  QuantityVector normal{}, point{};  ///< of a plane: outward; inside, n.(p - point)/|n| < size
  Quantity size;  ///< distance of the plane from the point, radius, or rounding of a solid [m]
  QuantityVector half{};  ///< of a solid's core: half edges, or radius, half height, radius [m]
  ExactJoints joints;     ///< of a solid: from the ground

  bool is_solid() const { return kind >= solid_box; }
};

template <class Number> struct ContactLaw {
  bool coulomb = true;      ///< Walton and Braun's; else constant
  Number restitution;       ///< e_n
  Number tangential;        ///< least e_t with friction, e_t without
  Number friction;          ///< mu
  Number least_separation;  ///< v_s [m/s]
};
using ExactLaw = ContactLaw<Quantity>;

struct ExactBall {
  Quantity radius, density, reduced_inertia;
  bool in_vessel = false;     ///< the position is that in the vessel frame
  QuantityVector position{};  ///< at the start [m]
  QuantityVector velocity{}, spin{};
};

struct ExactCase {
  std::string name, digest;
  Quantity start;  ///< the initial time [s]
  QuantityVector gravity{};
  ExactJoints joints;            ///< from the ground to the vessel
  std::vector<ExactWall> walls;  ///< of the vessel, then the bodies inside it
  std::vector<ExactLaw> laws;
  std::vector<ExactBall> balls;
  std::vector<std::vector<std::size_t>> law_of_walls;  ///< by ball and wall
  std::vector<std::vector<std::size_t>> law_of_balls;  ///< by ball and ball
};

/// The case in exact numbers.
/// @throws InputError for cases that cannot be proven: rounded vessels, pistons, saved states,
/// random velocities and diameters, laws other than walton-braun and constant
ExactCase exact_case(const casefile::CaseSpec& spec);

}  // namespace edmill::prove
