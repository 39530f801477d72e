// The contacts of DEM codes: Hertz's force with the damping of Tsuji et al. (Powder Technol. 71,
// 239, 1992).
#pragma once

namespace edmill::decks {

/// The force at the end of a contact with damping: cut off at zero, or attractive to its end.
enum class Separation { free, attracts };

/// Restitution of a contact m x'' = -K x^(3/2) - damping sqrt(m K) x^(1/4) x' as leapfrog
/// integrates it: the force of a step has the velocity of half a step before, in all three codes.
/// The result is the mean over the moments between two steps at which a touch can begin.
/// @param steps  in a contact without damping
/// @pre damping >= 0
double restitution_of(double damping, int steps, Separation separation = Separation::free);

/// The damping that gives a restitution: the inverse of `restitution_of`, to 1e-6.
/// @pre 0.05 <= restitution <= 1
double damping_for(double restitution, int steps, Separation separation = Separation::free);

/// The argument of `damping tsuji` in LAMMPS of 2022, a polynomial of it; or the nearest one.
/// @pre damping >= 0
double lammps_restitution(double damping);

/// The reduction of the restitution by a force that presses the bodies together, divided by the
/// ratio of the speed that this force would give them during the contact to the approach speed; to
/// first order in this ratio. 0.42 for a restitution of 0.3, 0.21 for 0.6, 0.05 for 0.9.
double press_effect(double restitution);

/// coefficientRestitution of LIGGGHTS, en of YADE: damping -sqrt(5) ln e / sqrt(ln^2 e + pi^2).
double formula_restitution(double damping);

/// Young's modulus for which a ball on a flat wall of the same material has this contact time [Pa].
/// @param poisson  Poisson's ratio of both
double young_for(double contact_time, double speed, double radius, double mass, double poisson);

}  // namespace edmill::decks
