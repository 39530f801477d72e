// What an impact does to enclosed velocities and spins. (2.23'), (2.24'), (2.28'); docs/certificates.md,
// "Impulse"
#pragma once

#include "prove/enclosure.hpp"
#include "prove/exact_case.hpp"

namespace edmill::prove {

/// A contact law at the precision in force.
struct Law {
  explicit Law(const ExactLaw& exact);

  bool coulomb;
  Enclosure restitution, tangential, friction, least_separation;
};

struct Impulse {
  Vector push;  ///< P: change of velocity of a body of the effective mass [m/s]
  Vector turn;  ///< Q: n x S gain [m/s]
  Enclosure approach_speed, slip_speed;
};

/// @param normal      n, unit, from the partner to ball i
/// @param contact     G, velocity of the surfaces at the contact against each other [m/s]
/// @param compliance  c = 1 + M/(m_i J_i) + M/(m_j J_j)
/// @param in_stall    friction rests
/// @throws Undecided
Impulse impulse(const Law& law, const Vector& normal, const Vector& contact, const Enclosure& compliance,
                bool in_stall);
/// Whether a flight was long enough for its ball to move, by the rule on stalls. @throws Undecided
bool has_moved(const Law& law, const Enclosure& flight_time);

}  // namespace edmill::prove
