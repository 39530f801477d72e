// Implementation of Simulation: set-up, saving, states; included by the instantiation files only.
#pragma once

#include "base/errors.hpp"
#include "base/interruption.hpp"
#include "engine/ball_bounds.hpp"
#include "engine/candidates_impl.hpp"
#include "engine/collide_impl.hpp"
#include "engine/loop_impl.hpp"
#include "engine/predict_impl.hpp"
#include "engine/simulation.hpp"
#include "engine/ties_impl.hpp"

namespace edmill::engine {

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
  bool sound = timed(now_) && stall_watch_.is_sound(ball_count(), mill_.vessel.wall_count()) &&
               now_.period < most && isfinite(top_speed_) && top_speed_ >= 0 &&
               candidates_.holds_all([this](int ball) -> const CellOfBall& { return bodies_[ball].cell; });
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
