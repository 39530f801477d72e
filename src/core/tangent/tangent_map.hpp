// What an impact does to motions infinitesimally close to a run's.
// docs/theory.md, "Tangent dynamics"
#pragma once

#include <memory>
#include <span>

#include "base/instant.hpp"
#include "base/vector.hpp"
#include "model/mill.hpp"

namespace edmill::tangent {

/// By how much the state of a ball differs in a motion nearby, over how near that is: a derivative.
template <class Real>
struct Tangent {
  Vec3<Real> position{0, 0, 0}, velocity{0, 0, 0}, spin{0, 0, 0};

  /// Free flight for a time [s].
  void fly(const Real& dt) { position += velocity * dt; }
  void archive(Archive& a) { a(position, velocity, spin); }
};

/// One body of an impact just before it, and its velocity after it.
template <class Real>
struct Struck {
  const model::BallProperties<Real>& ball;
  Vec3<Real> position, velocity, spin, velocity_after;
};

/// An impact of a run.
template <class Real>
struct ImpactAt {
  Instant<Real> time;
  Vec3<Real> normal;    ///< unit, from the partner to the ball
  Real approach_speed;  ///< [m/s]
  bool in_stall;        ///< friction rested
};

/// The derivative of impacts in a mill. The motion nearby meets its partner a little earlier or later: its
/// state is taken to its own impact, through it, and back to the time of the run's (the saltation of
/// piecewise smooth systems).
class TangentMap {
 public:
  explicit TangentMap(const model::Mill<double>& mill);
  ~TangentMap();

  /// @param directions  of the ball at the impact; they become those after it
  void with_wall(const ImpactAt<double>& impact, int wall, const Struck<double>& ball,
                 std::span<Tangent<double>> directions) const;
  /// @param of_one, of_two  directions of either ball, in the same order
  void of_pair(const ImpactAt<double>& impact, const Struck<double>& one, const Struck<double>& two,
               std::span<Tangent<double>> of_one, std::span<Tangent<double>> of_two) const;

 private:
  struct InDuals;  // heavy
  std::unique_ptr<InDuals> mill_;
};

}  // namespace edmill::tangent
