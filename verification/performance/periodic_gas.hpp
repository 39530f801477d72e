// Initial state of both reference implementations: elastic smooth spheres in a periodic box.
// Lengths in ball diameters, masses in ball masses, velocities in thermal ones.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace edmill::performance {

/// Balls on a cubic lattice with Maxwellian velocities at temperature 1 and no total momentum.
struct PeriodicGas {
  /// @param packing   volume of the balls over the volume of the box
  /// @param in_order  neighbours are near each other in memory too; otherwise anywhere
  /// @throws std::invalid_argument when the lattice does not fit or the box has no room for four
  /// cells a side
  PeriodicGas(int balls, double packing, std::uint64_t seed, bool in_order);

  /// Cells a side: not thinner than a ball, and up to eight for each ball. Four at least: with
  /// three, a ball could meet another and the other's image.
  int cells_a_side() const;

  double box;  ///< its edge
  std::vector<std::array<double, 3>> positions, velocities;
};

/// Collisions of one ball per unit of time in a fluid at temperature 1: Enskog, with the contact
/// value of Carnahan and Starling.
double enskog_rate(double packing);

}  // namespace edmill::performance
