// A second, independent answer to the ball-wall question: interval branch and bound in Arb balls.
// It shares neither bounds nor numerics with the solver; only the doubles of the question are
// common.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace edmill::testing {

/// Turns in a drive period: whole ones and a binary fraction.
struct OracleTurns {
  std::int64_t whole;
  std::vector<std::uint64_t> fraction;
};
/// amplitude sin(2 pi (turns of the drive + phase)): metres, or turns of a rotation.
struct OracleSwing {
  double amplitude, phase;
  OracleTurns per_period;
};
/// One joint of a chain, from the ground to the vessel.
struct OracleJoint {
  bool rotates;
  std::array<double, 3> axis, shift;
  double angle;  ///< [turns]
  OracleTurns per_period;
  std::vector<OracleSwing> swings;
  double speed;  ///< of a translation [m/s]
};

/// A wall that stands inward of its place by distance + speed t + swings [m].
struct OraclePiston {
  int wall;
  double distance, speed;
  std::vector<OracleSwing> swings;
};

/// factor x^i y^j z^k r^l.
struct OracleTerm {
  double factor;
  std::array<int, 4> powers;
};

/// A mill, a flight and a window as plain doubles, all taken exactly.
struct OracleQuestion {
  double arm, theta_max, gamma_max, period;       ///< of the nested motion
  double vessel_radius, half_height;              ///< of a cylinder
  std::optional<std::vector<OracleJoint>> chain;  ///< in place of the nested motion
  std::optional<std::array<double, 3>> box;       ///< half of its edges, in place of a cylinder
  std::optional<double> sphere;                   ///< its radius, in place of a cylinder
  std::optional<std::array<double, 3>> rounded;  ///< core radius, half height of the core, rounding
  std::vector<std::array<double, 4>>
      planes;  ///< outward normals and distances, in place of a cylinder
  std::vector<std::vector<OracleTerm>> polynomials;  ///< by wall, in place of a cylinder
  std::vector<OraclePiston> pistons;
  int wall_count() const {
    if (box) return 6;
    if (sphere) return 1;
    if (rounded) return (*rounded)[0] > 0 ? 5 : 3;
    if (!polynomials.empty()) return static_cast<int>(polynomials.size());
    return planes.empty() ? 3 : static_cast<int>(planes.size());
  }
  std::array<double, 3> gravity;
  std::array<double, 3> position, velocity;  ///< at the start of the flight, inertial
  std::int64_t start_period;
  double start_offset;
  double radius;
  std::int64_t begin_period;
  double begin_offset;
  double length;    ///< of the window [s]
  double overtime;  ///< contacts up to this long after the window are reported too [s]
};

enum class OracleVerdict { none, contact, unresolved };

/// First contact with one wall. Delays count from the window's begin and are rounded outwards.
struct OracleContact {
  OracleVerdict verdict = OracleVerdict::none;
  double earliest = 0, latest = 0;  ///< enclosure of the delay [s]
  double slope = 0;                 ///< rate of the gap function there, per second
  double curvature = 0;             ///< its second derivative there
  bool turned_back =
      false;  ///< overlapped and leaving at first; the contact is where the rate vanishes
};

/// Nearest doubles to a gap function and its rate.
struct OracleSample {
  double gap, rate;
};

/// Contacts with the walls by id. A wall is searched up to the first contact with the walls before
/// it and a little beyond.
std::vector<OracleContact> first_contacts(const OracleQuestion& question);

/// Gap function of `wall` at `delay` after the window's begin.
OracleSample gap_after(const OracleQuestion& question, int wall, double delay);

}  // namespace edmill::testing
