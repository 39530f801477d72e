// The contacts of DEM codes: Hertz's force with the damping of Tsuji, Tanaka and Ishida (Powder Technol. 71,
// 239, 1992), whose restitution does not depend on the speed.
#pragma once

namespace edmill::decks {

/// What the damping does to bodies that separate: the force ends at zero, or pulls them back until they part.
enum class Separation { free, attracts };

/// Restitution of a contact m x'' = -K x^(3/2) - damping sqrt(m K) x^(1/4) x' as leapfrog integrates it: the
/// force of a step has the velocity of half a step before, in LAMMPS, LIGGGHTS and YADE alike. Mean over the
/// places of the touch between two steps.
/// @param steps  in a contact without damping
/// @pre damping >= 0
double restitution_of(double damping, int steps, Separation separation = Separation::free);

/// The inverse, to 1e-6.
/// @pre 0.05 <= restitution <= 1
double damping_for(double restitution, int steps, Separation separation = Separation::free);

/// The number that LAMMPS of 2022 wants after `damping tsuji`: its polynomial of this number is the damping.
/// Nothing when no number gives it.
/// @pre damping >= 0
double lammps_restitution(double damping);

/// What a force that presses the bodies together takes off their restitution: the speed that it would give
/// them while they touch, over that of the approach, times this. 0.42 for a restitution of 0.3, 0.21 for 0.6
/// (0.18 with a linear spring), 0.05 for 0.9; to first order in that speed.
double press_effect(double restitution);

/// What LIGGGHTS calls coefficientRestitution and YADE en: their damping is -sqrt(5) ln e / sqrt(ln^2 e +
/// pi^2).
double formula_restitution(double damping);

/// Young's modulus of bodies that are alike, with which a ball touches a flat wall for so long [Pa].
/// @param poisson  of both
double young_for(double contact_time, double speed, double radius, double mass, double poisson);

}  // namespace edmill::decks
