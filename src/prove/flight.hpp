// Balls in free flight and their gaps, enclosed.
#pragma once

#include <vector>

#include "prove/exact_case.hpp"
#include "prove/pose.hpp"

namespace edmill::prove {

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

  std::size_t count() const { return walls_.size(); }
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

}  // namespace edmill::prove
