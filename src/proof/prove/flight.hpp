// Where the vessel is and how it moves, balls in free flight and their gaps, all enclosed, and proofs that
// bodies do not meet while a flight is flown. docs/certificates.md, "Rules for the states", rules 4 and 5
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "prove/enclosure.hpp"
#include "prove/exact_case.hpp"

namespace edmill::prove {

/// At a time, or during a bracket of times.
struct Pose {
  Matrix axes;                            ///< R: its columns are the axes of the vessel frame
  Vector centre, velocity, acceleration;  ///< of its origin [m], [m/s], [m/s^2]
  Vector omega, omega_rate;               ///< [rad/s], [rad/s^2]
};

Vector turned(const Matrix& m, const Vector& v);
/// By the transposed matrix.
Vector turned_back(const Matrix& m, const Vector& v);

/// Place, velocity and acceleration of a ball in the vessel frame.
struct InVessel {
  Vector place, velocity, acceleration;
};

/// The joints of a case, at the precision in force when it is made.
class Motion {
 public:
  explicit Motion(const ExactCase& exact);

  /// @param time  [s] after the start of the case
  Pose pose(const Enclosure& time) const;
  /// @param position, velocity, gravity  inertial, of a ball in flight
  static InVessel in_vessel(const Pose& pose, const Vector& position, const Vector& velocity,
                            const Vector& gravity);

 private:
  struct Joint {
    bool rotates;
    Vector axis, shift;
    Enclosure angle, speed;
    std::vector<model::Swing<Enclosure>> swings;
  };

  Enclosure start_, turn_;  ///< [s], 2 pi
  std::vector<Joint> joints_;
};

/// Position and velocity at the exact time `reference`, and the constant spin. A flight is a parabola for all
/// times; it is flown between two impacts.
struct Flight {
  Enclosure reference;  ///< [s] after the start, exact
  Vector position, velocity, spin;

  Vector position_at(const Enclosure& time, const Vector& gravity) const {
    const Enclosure dt = time - reference;
    return position + (velocity + gravity * Enclosure(dt / 2)) * dt;
  }
  Vector velocity_at(const Enclosure& time, const Vector& gravity) const {
    return velocity + gravity * Enclosure(time - reference);
  }
};

/// With components of `bits` bits, each enclosing that of `flight`.
Flight rounded(const Flight& flight, slong bits);

/// A gap function: positive inside, zero in contact. [m] or [m^2]
struct Gap {
  Enclosure value, rate, second;
};

/// The walls of a case as one ball meets them.
class Walls {
 public:
  /// At the precision in force.
  Walls(const ExactCase& exact, const ExactBall& ball);

  Gap gap(std::size_t wall, const InVessel& ball) const;
  Enclosure value(std::size_t wall, const Vector& place) const;
  /// Unit, into the vessel, where the ball touches the wall with its centre at `place`.
  Vector normal(std::size_t wall, const Vector& place) const;

 private:
  struct Wall {
    ExactWall::Kind kind;
    Vector outward;    ///< n of a plane
    Enclosure length;  ///< |n|
    Enclosure offset;  ///< |n| (distance - R) + n.point
    Enclosure room;    ///< R_v - R of round walls
  };
  std::vector<Wall> walls_;
};

/// |r_i - r_j|^2 - (R_i + R_j)^2 of two balls in flight: a convex parabola, since both fall alike.
struct PairGap {
  Vector between, relative;  ///< r_i - r_j at a time, v_i - v_j
  Enclosure square;          ///< (R_i + R_j)^2

  Enclosure value() const { return squared_norm<Enclosure>(between) - square; }
  Enclosure half_rate() const { return dot<Enclosure>(between, relative); }
};

/// A flight between two impacts.
struct Span {
  const Flight& flight;
  Enclosure begin, end;                ///< [s], exact: it is flown within these
  int begin_wall = -1, end_wall = -1;  ///< the wall of the impact at either end; -1 for none
};

/// Proves that one flight meets no wall between its ends.
class WallExclusion {
 public:
  /// @param motion, walls  for the ball; arithmetic is that of the precision in force
  WallExclusion(const Motion& motion, const Walls& walls, const Vector& gravity, const Span& span)
      : motion_(motion), walls_(walls), gravity_(gravity), span_(span) {}

  /// The windows: "r2p2p1". Empty when a bisection this deep does not prove it.
  std::string windows(std::size_t wall);

 private:
  static constexpr int deepest = 14;
  /// In a window: the ball at its middle, and within all of it.
  struct Window {
    Enclosure length_from_middle;
    InVessel middle, all;
  };
  const Window& window(int depth, long index);
  bool bisect(std::size_t wall, int depth, long index, std::string& text);

  const Motion& motion_;
  const Walls& walls_;
  const Vector& gravity_;
  const Span& span_;
  std::map<std::pair<int, long>, Window> windows_;
};

/// Whether two flights are proven not to touch from `begin` to `end`.
bool apart(const Flight& one, const Flight& two, const Enclosure& reach, const Vector& gravity,
           const Enclosure& begin, const Enclosure& end);

}  // namespace edmill::prove
