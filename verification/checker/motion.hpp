// The flights of the balls, and the gaps between bodies.
#pragma once

#include <optional>
#include <vector>

#include "mill.hpp"

namespace checker {

/// A ball at a time; the velocity and the spin are inertial.
struct State {
  Vec position, velocity, spin;
};

/// The flight of a ball between two of its events a and b: r + v (t - m) + g (t - m)^2 / 2.
struct Flight {
  Real time;     ///< m, the middle of the bracket of event a, exact; 0 at the start
  State state;   ///< at m
  Real bracket;  ///< of event a; 0 at the start
  Real begin;    ///< A, the lower end of the bracket
  long event;    ///< a; -1 at the start
  std::optional<Index> wall, partner;  ///< what the ball met in event a
  Vec position_at_0, velocity_at_0;    ///< of the same parabola, in few bits: for quick comparisons

  Vec position(const Real& t, const Vec& gravity) const {
    return state.position + (state.velocity + gravity * ((t - time) / 2)) * (t - time);
  }
  Vec velocity(const Real& t, const Vec& gravity) const {
    return state.velocity + gravity * (t - time);
  }
};

/// What meets in an event: a ball and a wall, or two balls i = `ball` and j = `other`.
struct Contact {
  Index ball;
  bool with_wall;
  Index other;  ///< the wall, or the ball with the higher number
};

/// The mill, and of each ball the flight that has not ended.
struct Motion {
  Mill mill;
  std::vector<Flight> flights;

  Vec position(Index ball, const Real& t) const { return flights[ball].position(t, mill.gravity); }
  Vec velocity(Index ball, const Real& t) const { return flights[ball].velocity(t, mill.gravity); }

  /// y = v_i - v_j, at all times the same.
  Vec relative_velocity(Index i, Index j, const Real& t) const;

  /// x_m + y d: r_i - r_j at a time, or on a bracket from its middle.
  Vec separation(Index i, Index j, const Real& t) const;

  /// R_i + R_j
  Real reach(Index i, Index j) const { return mill.balls[i].radius + mill.balls[j].radius; }

  /// f of rule 2.
  Real gap(const Contact& contact, const Real& t) const;

  /// f' of rule 2; half of it for two balls.
  Real gap_rate(const Contact& contact, const Real& t) const;
};

}  // namespace checker
