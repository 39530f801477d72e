// The effect of impacts on motions infinitesimally close to a run, and Lyapunov exponents: the
// rates at which these diverge from the run, direction by direction (Benettin et al. 1980).
// docs/theory.md, "Tangent dynamics"
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/archive.hpp"
#include "base/instant.hpp"
#include "base/vector.hpp"
#include "model/mill.hpp"

namespace edmill::tangent {

/// Derivative of a ball's state: its difference in a neighbouring motion over the infinitesimal
/// distance of that motion.
template <class Real> struct Tangent {
  Vec3<Real> position{0, 0, 0}, velocity{0, 0, 0}, spin{0, 0, 0};

  /// Free flight for a time [s].
  void fly(const Real& dt) { position += velocity * dt; }
  void archive(Archive& a) { a(position, velocity, spin); }
};

/// One body of an impact just before it, and its velocity after it.
struct Struck {
  int ball;  ///< its number
  Vec3<double> position, velocity, spin, velocity_after;
};

/// An impact of a run.
struct ImpactAt {
  Instant<double> time;
  Vec3<double> normal;    ///< unit, from the partner to the ball
  double approach_speed;  ///< [m/s]
  bool in_stall;          ///< friction rested
};

using Balls = std::vector<model::BallProperties<double>>;

/// The derivative of impacts in a mill. In the neighbouring motion the impact is a little earlier
/// or later: its state is moved to its own impact, through it, and back to the time of the run's
/// impact (the saltation of piecewise smooth systems).
class TangentMap {
 public:
  TangentMap(const model::Mill<double>& mill, const Balls& balls);
  ~TangentMap();

  /// @param directions  of the ball at the impact; they become those after it
  void with_wall(const ImpactAt& impact, int wall, const Struck& struck,
      std::span<Tangent<double>> directions) const;
  /// @param of_one, of_two  directions of either ball, in the same order
  void of_pair(const ImpactAt& impact, const Struck& one, const Struck& two,
      std::span<Tangent<double>> of_one, std::span<Tangent<double>> of_two) const;
 private:
  struct InDuals;  // heavy
  std::unique_ptr<InDuals> mill_;
};

/// A set of directions that evolves with a run and is kept orthonormal. The growth of each
/// direction orthogonal to the previous ones is summed; the sums over the time tend to the largest
/// exponents, in order.
class Spectrum {
 public:
  /// @param directions  how many; at most nine for each ball
  Spectrum(const model::Mill<double>& mill, const Balls& balls, const Instant<double>& start,
      std::size_t directions);

  void with_wall(const ImpactAt& impact, int wall, const Struck& struck);
  void of_pair(const ImpactAt& impact, const Struck& one, const Struck& two);

  /// Makes the directions orthonormal at this instant, and adds the logarithms of their growth to
  /// the sums.
  void orthonormalise(const Instant<double>& now);
  /// Natural logarithms of the growth, direction by direction, up to the last call of
  /// `orthonormalise`; minus infinity for a direction that impacts at the least separation speed
  /// have annihilated.
  const std::vector<double>& growth() const { return state_.growth; }

  std::size_t directions() const { return count_; }

  /// The state that changes during a run.
  struct State {
    std::vector<Tangent<double>> tangents;  ///< of ball 0 in each direction, of ball 1...
    std::vector<Instant<double>> since;     ///< instants at which they are known, by ball
    std::vector<double> growth;
    std::uint64_t since_orthonormal = 0;  ///< impacts
    std::vector<std::int64_t> of_ball{};  ///< of these, by ball

    void archive(Archive& a) { a(tangents, since, growth, since_orthonormal, of_ball); }
  };
  const State& state() const { return state_; }
  void restore(State state) { state_ = std::move(state); }
 private:
  std::span<Tangent<double>> of_ball(int ball) {
    return {state_.tangents.data() + static_cast<std::size_t>(ball) * count_, count_};
  }
  void fly(int ball, const Instant<double>& now);
  double product(std::size_t a, std::size_t b) const;
  void count_impact(const Instant<double>& now, int ball, int partner);

  TangentMap map_;
  DriveClock<double> clock_;
  std::size_t balls_, count_;     ///< numbers of balls and of directions
  double length_, speed_, spin_;  ///< units in which directions are measured
  State state_;
};

}  // namespace edmill::tangent
