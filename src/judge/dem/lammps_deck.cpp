// LAMMPS of 2021 and later: exact regions. Regions turn about one axis at most, so a vessel that turns is at
// rest and the fictitious forces and torques come from Python.
#include <fmt/format.h>

#include "base/errors.hpp"
#include "dem/deck.hpp"
#include "dem/moving_vessel.hpp"
#include "dem/soft_contact.hpp"

namespace edmill::dem {

namespace {

std::string region_of(const DeckCase& c, const std::string& moves) {
  const auto& v = c.mill.vessel;
  if (const auto* box = v.get_if<model::BoxVessel<double>>())
    return fmt::format("region vessel block {} {} {} {} {} {} side in units box{}\n", -box->half[0],
                       box->half[0], -box->half[1], box->half[1], -box->half[2], box->half[2], moves);
  if (const auto* cylinder = v.get_if<model::CylinderVessel<double>>())
    return fmt::format("region vessel cylinder y 0 0 {} {} {} side in units box{}\n", cylinder->radius,
                       -cylinder->half_height, cylinder->half_height, moves);
  if (const auto* sphere = v.get_if<model::SphereVessel<double>>())
    return fmt::format("region vessel sphere 0 0 0 {} side in units box{}\n", sphere->radius, moves);
  throw InputError(
      fmt::format("{}: key 'vessel.type': found a vessel that is no single region of LAMMPS, expected "
                  "cylinder, box or sphere",
                  c.file));
}

std::string contact_of(const DeckCase& c, const DeckOptions& options, const SoftLaw& law) {
  if (law.damping > 1.2728)
    throw InputError(
        fmt::format("{}: key 'contact.restitution': found {}, expected {:.2g} or more: LAMMPS's damping "
                    "tsuji goes no lower",
                    c.file, law.restitution, restitution_of(1.2728, options.steps) + 0.005));
  return fmt::format(
      "hertz/material {:.12g} {:.9g} {:g} tangential mindlin NULL 0.0 {:.12g} damping tsuji limit_damping",
      c.young, lammps_restitution(law.damping), DeckCase::poisson, law.friction);
}

/// The state of a ball as the deck has it: inertial, or as seen from the vessel.
model::BallState<double> state_in(const DeckCase& c, std::size_t ball, bool in_vessel) {
  const auto& s = c.states[ball];
  if (!in_vessel) return s;
  const auto& motion = c.mill.motion;
  const auto seen = motion.to_vessel_frame(c.pose, s.position, s.velocity);
  return {seen.position, seen.velocity, in_axes(motion, c.pose, s.spin - motion.angular_velocity(c.pose))};
}

std::string atoms_of(const DeckCase& c, bool in_vessel) {
  std::string text, sets;
  for (std::size_t k = 0; k < c.balls.size(); ++k) {
    const auto [x, v, w] = state_in(c, k, in_vessel);
    text += fmt::format("create_atoms 1 single {} {} {} units box\n", x[0], x[1], x[2]);
    sets += fmt::format(
        "set atom {0} diameter {1} density {2}\n"
        "set atom {0} vx {3} vy {4} vz {5} omega {6} {7} {8}\n",
        k + 1, 2 * c.balls[k].radius, c.density(k), v[0], v[1], v[2], w[0], w[1], w[2]);
  }
  return text + sets;
}

/// Fictitious forces and torques with the velocity of the step, not LAMMPS's of half a step before.
std::string frame_in_python(const DeckCase& c) {
  const auto& g = c.mill.gravity;
  std::string masses, radii;
  for (const auto& ball : c.balls) {
    masses += fmt::format("{}, ", ball.mass);
    radii += fmt::format("{}, ", ball.radius);
  }
  return fmt::format(R"(python drive input 1 SELF format p here """
import numpy as np
from lammps import lammps
{}
G, DT, BEGIN = np.array([{}, {}, {}]), {}, {}
M, RADIUS = np.array([{}])[:, None], np.array([{}])[:, None]
I = 0.4*M*RADIUS**2
held = {{}}
def drive(pointer, virial):
    if not held:
        held['lammps'] = lammps(ptr=pointer)
        for name in ('x', 'v', 'omega', 'f', 'torque'):
            held[name] = held['lammps'].numpy.extract_atom(name)[:len(M)]
    step = held['lammps'].extract_global('ntimestep')
    x, v, u, f, T = (held[name] for name in ('x', 'v', 'omega', 'f', 'torque'))
    R, C, w, dw, V, A = pose(BEGIN+step*DT)
    dw, W, D = R.T @ dw, skew(R.T @ w), skew(R.T @ dw)
    h = 0.0 if step == 0 else DT/2
    # Rows are balls: a row times W.T is the cross product of w with it.
    rest = R.T @ (G-A)-x @ (D+W @ W).T
    now = v+h/M*f+h*(rest-2*v @ W.T)
    spin = u+h/I*T-h*(dw+u @ W.T)
    f += M*(rest-2*now @ W.T)
    T -= I*(dw+spin @ W.T)
"""
fix frame all python/invoke 1 post_force drive
)",
                     pose_in_python(c), g[0], g[1], g[2], c.time_step, c.begin, masses, radii);
}

}  // namespace

Deck lammps_deck(const DeckCase& c, const DeckOptions& options) {
  const bool in_vessel = !c.translates();
  const double reach = 1.5 * c.mill.motion.reach(c.mill.vessel.reach());
  std::string text = header_of(c, options);
  text += fmt::format("# frame {}\n", in_vessel ? "vessel" : "laboratory");
  text += fmt::format(R"(units si
atom_style sphere
atom_modify map array sort 0 0
boundary f f f
comm_modify vel yes
newton off
region space block {0:.6g} {1:.6g} {0:.6g} {1:.6g} {0:.6g} {1:.6g} units box
create_box 1 space
{2}timestep {3}
neighbor {4:.6g} bin
neigh_modify delay 0 every 1 check yes
pair_style granular
pair_coeff * * {5}
)",
                      -reach, reach, atoms_of(c, in_vessel), c.time_step, c.largest_radius / 2,
                      contact_of(c, options, c.of_balls));
  if (!in_vessel) {
    const auto formulas = displacement_formulas(c, "v_t");
    text += fmt::format("variable t equal {}+step*dt\n", c.begin);
    for (std::size_t k = 0; k < 3; ++k)
      text += fmt::format("variable move{} equal {}\n", "xyz"[k], formulas[k]);
    text += region_of(c, c.mill.motion.wall_speed(0) > 0 ? " move v_movex v_movey v_movez" : "");
  } else {
    text += region_of(c, "");
  }
  text += fmt::format("fix walls all wall/gran/region granular {} region vessel\n",
                      contact_of(c, options, c.of_walls));
  if (!in_vessel) text += weight_of(c);
  text += "fix motion all nve/sphere\n";
  if (in_vessel) text += frame_in_python(c);
  text += fmt::format(R"(dump frames all custom {} {}.dump id x y z vx vy vz omegax omegay omegaz mass radius
dump_modify frames sort id format float %.15g time yes units yes
thermo {}
thermo_modify lost error
run {}
)",
                      c.frame_every, options.name, std::max(1L, c.steps / 20), c.steps);
  Deck deck{{{options.name + ".in", std::move(text)}}, fmt::format("lmp -in {}.in", options.name), {}};
  if (in_vessel)
    deck.notes = {
        "the vessel turns, which LAMMPS's regions do about one axis at most: the deck computes in the "
        "vessel's frame, with fictitious forces by python3-lammps"};
  return deck;
}

}  // namespace edmill::dem
