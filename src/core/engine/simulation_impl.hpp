// Implementation of Simulation: set-up, saving, states; included by the instantiation files only.
#pragma once

#include <algorithm>
#include <boost/math/special_functions/cbrt.hpp>
#include <vector>

#include "base/errors.hpp"
#include "base/interruption.hpp"
#include "engine/loop_impl.hpp"
#include "engine/simulation.hpp"

namespace edmill::engine {

// Bounds that hold for every ball of a run.

template <class Real>
bool all_alike(const std::vector<model::BallProperties<Real>>& balls) {
  return std::all_of(balls.begin(), balls.end(), [&](const auto& b) { return b == balls.front(); });
}

template <class Real>
Real smallest_radius(const std::vector<model::BallProperties<Real>>& balls) {
  Real smallest = balls.front().radius;
  for (const auto& b : balls) smallest = b.radius < smallest ? b.radius : smallest;
  return smallest;
}

/// The most that gravity adds to a ball's speed in one flight: one that stays within `reach` of the origin
/// bends by g t^2/8 < 2 reach [m/s].
template <class Real>
Real largest_fall(const model::Mill<Real>& mill) {
  using std::sqrt;
  const Real reach = mill.motion.reach(mill.vessel.reach());
  return 4 * sqrt(reach * norm<Real>(mill.gravity));
}

/// Speed of two bodies that the accelerations of walls and gravity bring together over a path [m/s].
template <class Real>
Real speed_over(const Real& path, const model::Mill<Real>& mill) {
  using std::sqrt;
  const Real reach = mill.motion.reach(mill.vessel.extent());
  Real acceleration = mill.motion.acceleration_within(reach) + norm<Real>(mill.gravity);
  if (const auto* pistons = mill.vessel.pistons()) acceleration += pistons->bound(2);
  return sqrt(2 * acceleration * path);
}

/// A clock that advances by less hardly advances: no ball has time to move, or rounding is all that moves it
/// [s].
template <class Real>
Real shortest_advance(const model::Mill<Real>& mill) {
  const Real by_rule = mill.least_separations().second / mill.stall.acceleration;
  return std::max(by_rule, Real(1000000 * epsilon<Real>() * mill.motion.period()));
}

/// Largest speed of a ball until impacts make one faster than twice the fastest ball or wall at the start
/// [m/s].
template <class Real>
Real largest_speed(const std::vector<model::BallState<Real>>& states, const model::Mill<Real>& mill) {
  Real largest{1};
  for (const auto& s : states) {
    const Real speed = norm<Real>(s.velocity);
    if (speed > largest) largest = speed;
  }
  Real wall = mill.motion.speed_within(mill.motion.reach(mill.vessel.extent()));
  if (const auto* pistons = mill.vessel.pistons()) wall += pistons->bound(1);
  return 2 * (largest + wall) + largest_fall(mill);
}

namespace detail {

/// The region that the vessel sweeps, cut into cells that hold about one ball but are thicker than the
/// largest.
template <class Real>
CellGrid make_grid(const model::Mill<Real>& mill, const std::vector<model::BallProperties<Real>>& balls) {
  const auto region = mill.motion.swept(mill.vessel.half_sizes(), mill.vessel.reach());
  Real largest{0};
  for (const auto& b : balls) largest = b.radius > largest ? b.radius : largest;
  const double volume = static_cast<double>(mill.vessel.volume());
  // The C library's cube root is not the same on every machine; nor is long double.
  using boost::math::policies::promote_double;
  constexpr boost::math::policies::policy<promote_double<false>> portable;
  Real edge = 2 * largest * (1 + Real(1) / 1024);
  if (balls.size() <= 32) edge = 2 * (region.high - region.low).maxCoeff();
  const double spacing = 0.45 * boost::math::cbrt(volume / static_cast<double>(balls.size()), portable);
  if (edge < spacing) edge = Real(spacing);
  return CellGrid(vector_cast<double>(region.low), vector_cast<double>(region.high),
                  static_cast<double>(edge), static_cast<int>(balls.size()));
}

}  // namespace detail

template <class Real>
Candidates<Real>::Candidates(const model::Mill<Real>& mill,
                             const std::vector<model::BallProperties<Real>>& balls,
                             const LargeVector<dynamics::Flight<Real>>& flights, const Real& reach,
                             const Real& top_speed)
    : flights_(&flights),
      pairs_(model::mill_cast<double>(mill), 2 * static_cast<double>(smallest_radius(balls)),
             static_cast<double>(reach), static_cast<double>(top_speed)),
      stride_(all_alike(balls) ? 0 : 1),
      grid_(detail::make_grid(mill, balls)) {
  for (const auto& ball : balls) radii_.push_back(static_cast<double>(ball.radius));
  if constexpr (!is_double) double_flights_.resize(balls.size());
  if (grid_.single_cell()) columns_.emplace(static_cast<int>(balls.size()), stride_ == 0);
}

template <class Real>
CellOfBall Candidates<Real>::insert(int ball) {
  const CellOfBall cell = grid_.insert(ball, vector_cast<double>((*flights_)[ball].position));
  update(ball);
  return cell;
}

template <class Real>
Simulation<Real>::Simulation(const model::Case<Real>& the_case,
                             const std::vector<model::BallState<Real>>& states, const Instant<Real>& start,
                             const std::atomic<bool>* interrupt)
    : mill_(the_case.mill),
      clock_(the_case.mill.motion.period()),
      balls_(the_case.balls),
      stride_(all_alike(the_case.balls) ? 0 : 1),
      agendas_(states.size()),
      ladder_(the_case.mill, 2 * smallest_radius(the_case.balls), largest_speed(states, the_case.mill)),
      candidates_(the_case.mill, the_case.balls, flights_, ladder_.walls().reach(),
                  largest_speed(states, the_case.mill)),
      queue_(static_cast<int>(states.size()), the_case.mill.motion.period()),
      prefetcher_(queue_, agendas_, flights_, bodies_, candidates_),
      collapse_watch_(Real(1000000) * epsilon<Real>() / 2 * ladder_.walls().reach()),
      may_collapse_(!(mill_.least_separations().first > 0)),
      slow_(speed_over(collapse_watch_.smallest_path(), mill_)),
      stall_watch_(states.size(), start, shortest_advance(mill_)),
      now_(start),
      tolerated_overlap_(2 * smallest_radius(the_case.balls) / 1000000),
      fall_(largest_fall(the_case.mill)),
      top_speed_(largest_speed(states, the_case.mill)) {
  EDMILL_REQUIRE(!balls_.empty() && balls_.size() == states.size(), "one state for each ball");
  for (const auto& s : states) {
    flights_.push_back({s.position, s.velocity, start});
    bodies_.push_back({s.spin, {}, 0, {}});
  }
  for (int i = 0; i < ball_count(); ++i) bodies_[i].cell = candidates_.insert(i);
  prefetch(ball_count() > Prefetcher<Real>::worthwhile);
  update_pose();
  const Interruption scope(interrupt);
  for (int i = 0; i < ball_count(); ++i) {
    Interruption::check();
    find_neighbours(i, near_);
    predict_all(i, -1, pose_, near_);
  }
}

template <class Real>
void Simulation<Real>::archive(Archive& a) {
  const auto balls = flights_.size();
  if (!a.loading()) agendas_.renumber_impacts();  // often enough for tests to see that it changes nothing
  a(flights_, bodies_, agendas_, ladder_, candidates_, counts_, stall_watch_, now_, top_speed_);
  if (!a.loading()) return;
  EDMILL_REQUIRE(flights_.size() == balls && agendas_.size() == balls, "a saved state of the same case");
  if (!is_sound()) throw InputError("found a saved state that no run of the case can have");
  ladder_.raise_top_speed(top_speed_);
  candidates_.raise_top_speed(top_speed_);
  for (int i = 0; i < ball_count(); ++i) {
    candidates_.update(i);
    requeue(i);  // equal times go to the lower ball, whatever the queue's history
  }
}

/// Saved states can come from elsewhere: what the loop would take on trust is looked at once.
template <class Real>
bool Simulation<Real>::is_sound() const {
  using std::isfinite;
  const std::int64_t most = Instant<Real>::never().period;
  const auto timed = [&](const Instant<Real>& t) {
    return t.period >= -most && t.period <= most && t.offset >= 0 && t.offset <= clock_.period();
  };
  const auto finite = [](const Vec3<Real>& v) { return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]); };
  bool sound =
      timed(now_) && stall_watch_.is_sound(ball_count(), mill_.vessel.wall_count()) && now_.period < most &&
      isfinite(top_speed_) && top_speed_ >= 0 &&
      candidates_.grid().holds_all([this](int ball) -> const CellOfBall& { return bodies_[ball].cell; });
  for (int i = 0; sound && i < ball_count(); ++i) {
    const auto& agenda = agendas_[i];
    sound = finite(flights_[i].position) && finite(flights_[i].velocity) && finite(bodies_[i].spin) &&
            timed(flights_[i].start) && !(now_ < flights_[i].start) && timed(bodies_[i].recent.last) &&
            bodies_[i].recent.burst >= 0 && bodies_[i].recent.burst <= CollapseWatch<Real>::enough &&
            bodies_[i].unmoved >= 0 && bodies_[i].unmoved <= mill_.stall.impacts &&
            timed(agenda.forgotten_from) &&
            agenda.is_sound(ball_count(), mill_.vessel.wall_count(), agendas_.latest_impact()) &&
            !(top_speed_ * top_speed_ < squared_norm<Real>(flights_[i].velocity));
    for (const auto& time : agenda.times) sound = sound && timed(time) && !(time < now_);
  }
  return sound;
}

template <class Real>
model::BallState<Real> Simulation<Real>::state_at(int i, const Instant<Real>& when) const {
  const Real dt = clock_.elapsed(flights_[i].start, when);
  return {dynamics::position_after(flights_[i], mill_.gravity, dt),
          dynamics::velocity_after(flights_[i], mill_.gravity, dt), bodies_[i].spin};
}

template <class Real>
model::Energy<Real> Simulation<Real>::energy_at(const Instant<Real>& when) const {
  model::Energy<Real> energy;
  for (int i = 0; i < ball_count(); ++i)
    energy += model::energy_of<Real>(properties(i), state_at(i, when), mill_.gravity);
  return energy;
}

}  // namespace edmill::engine
