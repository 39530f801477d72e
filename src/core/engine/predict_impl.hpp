// Implementation of Simulation: what comes next for a ball; included by the instantiation files only.
#pragma once

#include "engine/simulation.hpp"

namespace edmill::engine {

/// What comes next for the balls of an impact.
template <class Real>
void Simulation<Real>::predict(const Impact<Real>& impact) {
  if (impact.with_wall) return predict_all(impact.ball, -1, pose_, near_);
  // Wide scalars begin their wall searches in double.
  if constexpr (std::is_same_v<Real, double>) update_pose();
  predict_all(impact.ball, -1, pose_, near_);
  prefetcher_.more();
  predict_all(impact.partner, impact.ball, pose_, near_partner_);
}

/// @pre find_neighbours(ball, near)
template <class Real>
void Simulation<Real>::predict_all(int ball, int already_done, const model::AnyPose<Real>& pose,
                                   FoundBalls& near) {
  const auto state = candidates_.state(ball, now_);
  agendas_[ball].drop_pairs();
  const int found = candidates_.find(ball, state, now_, near);
  // Before the candidates: how many there are is known late, and the processor can do this meanwhile.
  predict_crossing(ball, state);
  predict_pairs(ball, already_done, state, found, near);
  prefetcher_.more();
  predict_wall(ball, pose);
  requeue(ball);
}

/// Predicts contacts with the candidates found.
template <class Real>
void Simulation<Real>::predict_pairs(int ball, int already_done, const DoubleState& state, int found,
                                     const FoundBalls& near) {
  const int* places = candidates_.places();
  for (int k = 0; k < found; ++k) {
    const int other = candidates_.ball_at(places[k], near);
    if (other == already_done) continue;
    if constexpr (std::is_same_v<Real, double>) {
      const double delay = candidates_.delay(places[k]);
      if (delay >= 0) [[likely]] {
        expect_pair(ball, other, delay);
        continue;
      }
    }
    const Real sum = properties(ball).radius + properties(other).radius;
    const auto answer =
        ladder_.pair(state_in_scalar(ball, state), flights_[ball], flights_[other], now_, sum);
    if (answer.verdict == dynamics::Verdict::contact) expect_pair(ball, other, answer.delay);
  }
}

/// Puts a contact into the ball's agenda.
template <class Real>
void Simulation<Real>::expect_pair(int ball, int other, const Real& delay) {
  Agenda<Real>& a = agendas_[ball];
  const Instant<Real> time = clock_.after(now_, delay);
  if (time >= a.forgotten_from) return;
  if (a.pair_count < Agenda<Real>::capacity) [[likely]] {
    a.put_pair(Agenda<Real>::first_pair + a.pair_count++, time, other, agendas_.latest_impact());
    return;
  }
  const int last = a.farthest();
  a.forgotten_from = time < a.times[last] ? a.times[last] : time;
  if (time < a.times[last]) a.put_pair(last, time, other, agendas_.latest_impact());
}

template <class Real>
void Simulation<Real>::predict_crossing(int ball, const DoubleState& state) {
  if (!candidates_.uses_cells()) return;
  Agenda<Real>& a = agendas_[ball];
  const auto& gravity = candidates_.filter().gravity;
  const auto velocity = dynamics::velocity_after(candidates_.flights()[ball], gravity, state.age);
  const auto crossing = candidates_.grid().crossing(bodies_[ball].cell, state.position, velocity, gravity);
  a.crossing_face = static_cast<std::int8_t>(2 * crossing.axis + (crossing.step > 0));
  a.times[Agenda<Real>::crossing_entry] =
      crossing.delay < Crossing::never ? clock_.after(now_, Real(crossing.delay)) : Instant<Real>::never();
}

/// How far a wall search from `begin` need look: to a little past the ball's nearest pair contact, so that
/// a wall contact which may be first is known.
template <class Real>
Real Simulation<Real>::search_length(int ball, const Instant<Real>& begin) const {
  const Real& longest = ladder_.walls().longest_window();
  const Agenda<Real>& a = agendas_[ball];
  if (a.pair_count == 0) return longest;
  const Real until_pair = clock_.elapsed(begin, a.times[a.nearest()]) + 2 * ladder_.tie_window();
  return std::min(longest, std::max(Real(longest / 4096), until_pair));
}

template <class Real>
void Simulation<Real>::predict_wall(int ball, const model::AnyPose<Real>& pose) {
  ++counts_.wall_searches;
  const Real length = search_length(ball, now_);
  const auto& flight = flights_[ball];
  const dynamics::WallQuery<Real> query{flight, properties(ball).radius, now_, length};
  try {
    if constexpr (std::is_same_v<Real, double>) {
      take_wall_answer(ball, ladder_.wall(pose, query), now_);
    } else {
      take_wall_answer(ball, ladder_.wall(query), now_);  // which begins in double
    }
  } catch (const InterruptedError&) {  // the impact has happened; a continued run begins by searching
    agendas_[ball].wall = -1;
    agendas_[ball].times[Agenda<Real>::wall_entry] = now_;
    stop_ = EndReason::interrupted;
  }
}

template <class Real>
void Simulation<Real>::continue_wall_search(int ball, const Instant<Real>& begin) {
  ++counts_.wall_searches;
  const Real length = search_length(ball, begin);
  take_wall_answer(ball, ladder_.wall({flights_[ball], properties(ball).radius, begin, length}), begin);
  requeue(ball);
}

template <class Real>
void Simulation<Real>::take_wall_answer(int ball, const dynamics::WallAnswer<Real>& answer,
                                        const Instant<Real>& begin) {
  Agenda<Real>& a = agendas_[ball];
  if (answer.verdict == dynamics::Verdict::contact) {
    a.wall = static_cast<std::int8_t>(answer.wall + (answer.by_rule ? Agenda<Real>::tied : 0));
    a.times[Agenda<Real>::wall_entry] = answer.time;
    a.wall_pose = answer.pose;
  } else {
    // The next search begins where this one's proof still holds, whatever the sum is rounded to.
    a.wall = -1;
    a.times[Agenda<Real>::wall_entry] =
        clock_.after(begin, answer.searched - 4 * epsilon<Real>() * clock_.period());
  }
}

}  // namespace edmill::engine
