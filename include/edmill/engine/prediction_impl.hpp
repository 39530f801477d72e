// Implementation of Simulation: what comes next for a ball, and which of two contacts is first; included by
// the instantiation files only.
#pragma once

#include "edmill/engine/simulation.hpp"

namespace edmill::engine {

/// @pre fetch_neighbours(ball, near)
template <class Real>
void Simulation<Real>::predict_all(int ball, int already_done, const model::VesselPose<Real>& pose,
                                   FoundBalls& near) {
  const auto roughly = see_roughly(ball);
  agendas_[ball].drop_pairs();
  const int found = look_around(ball, roughly, near);
  // Before the suspects: how many there are is known late, and the processor can do this meanwhile.
  predict_crossing(ball, roughly);
  predict_suspects(ball, already_done, roughly, found, near);
  fetch_more();
  predict_wall(ball, pose);
  requeue(ball);
}

/// Finds the suspects among all balls that the ball may meet.
/// @return how many there are
template <class Real>
int Simulation<Real>::look_around(int ball, const RoughlySeen& roughly, FoundBalls& near) {
  if (table_) return table_->look(question(ball, roughly), looks_);
  if (!many_balls()) grid_.neighbours(bodies_[ball].cell, near);
  return look_at_near(ball, roughly, near);
}

template <class Real>
int Simulation<Real>::look_at_near(int ball, const RoughlySeen& roughly, FoundBalls& near) {
  looks_.make_room(near.count);
  return look_at(rough_flights(), radii_.data(), stride_, question(ball, roughly), ball, near.balls.data(),
                 near.count, looks_);
}

/// Predicts contacts with the suspects of `looks_`.
template <class Real>
void Simulation<Real>::predict_suspects(int ball, int already_done, const RoughlySeen& roughly, int found,
                                        const FoundBalls& near) {
  const int* suspects = looks_.suspects();
  for (int k = 0; k < found; ++k) {
    const int other = table_ ? suspects[k] : near.balls[suspects[k]];
    if (other == already_done) continue;
    if constexpr (std::is_same_v<Real, double>) {
      const double delay = looks_.delay(suspects[k]);
      if (delay >= 0) [[likely]] {
        expect_pair(ball, other, delay);
        continue;
      }
    }
    const Real sum = properties(ball).radius + properties(other).radius;
    const auto answer = ladder_.pair(see(ball, roughly), flights_[ball], flights_[other], now_, sum);
    if (answer.verdict == dynamics::Verdict::contact) expect_pair(ball, other, answer.delay);
  }
}

template <class Real>
void Simulation<Real>::flight_changed(int ball) {
  if constexpr (!std::is_same_v<Real, double>)
    rough_flights_[ball] = dynamics::flight_cast<double>(flights_[ball]);
  if (table_) table_->set(ball, rough_flights()[ball], radii_[ball * stride_]);
}

/// Puts a contact into the ball's agenda.
template <class Real>
void Simulation<Real>::expect_pair(int ball, int other, const Real& delay) {
  Agenda& a = agendas_[ball];
  const Instant<Real> time = clock_.after(now_, delay);
  if (time >= a.forgotten_from) return;
  if (a.pair_count < Agenda::capacity) [[likely]] {
    a.put_pair(Agenda::first_pair + a.pair_count++, time, other, impact_number_);
    return;
  }
  const int last = a.farthest();
  a.forgotten_from = time < a.times[last] ? a.times[last] : time;
  if (time < a.times[last]) a.put_pair(last, time, other, impact_number_);
}

template <class Real>
void Simulation<Real>::predict_crossing(int ball, const RoughlySeen& roughly) {
  if (grid_.single_cell()) return;
  Agenda& a = agendas_[ball];
  const auto& gravity = pair_filter_.filter().gravity;
  const auto velocity = dynamics::velocity_after(rough_flights()[ball], gravity, roughly.age);
  const auto crossing = grid_.crossing(bodies_[ball].cell, roughly.position, velocity, gravity);
  a.crossing_face = static_cast<std::int8_t>(2 * crossing.axis + (crossing.step > 0));
  a.times[Agenda::crossing_entry] =
      crossing.delay < Crossing::never ? clock_.after(now_, Real(crossing.delay)) : Instant<Real>::never();
}

/// How far a wall search from `begin` need look: to the ball's nearest pair contact, after which it is moot.
template <class Real>
Real Simulation<Real>::search_length(int ball, const Instant<Real>& begin) const {
  const Real& longest = ladder_.walls().longest_window();
  const Agenda& a = agendas_[ball];
  if (a.pair_count == 0) return longest;
  const Real until_pair = clock_.elapsed(begin, a.times[a.nearest()]);
  return std::min(longest, std::max(Real(longest / 4096), until_pair));
}

template <class Real>
void Simulation<Real>::predict_wall(int ball, const model::VesselPose<Real>& pose) {
  ++counts_.wall_searches;
  const Real length = search_length(ball, now_);
  const auto& flight = flights_[ball];
  const dynamics::WallQuery<Real> query{flight, properties(ball).radius, now_, length};
  if constexpr (std::is_same_v<Real, double>) {
    take_wall_answer(ball, ladder_.wall(pose, query), now_);
  } else {
    take_wall_answer(ball, ladder_.wall(query), now_);  // which begins in double
  }
}

template <class Real>
void Simulation<Real>::continue_wall_search(int ball) {
  ++counts_.wall_searches;
  const Real length = search_length(ball, now_);
  take_wall_answer(ball, ladder_.wall({flights_[ball], properties(ball).radius, now_, length}), now_);
  requeue(ball);
}

template <class Real>
void Simulation<Real>::take_wall_answer(int ball, const dynamics::WallAnswer<Real>& answer,
                                        const Instant<Real>& begin) {
  Agenda& a = agendas_[ball];
  if (answer.verdict == dynamics::Verdict::contact) {
    a.wall = static_cast<std::int8_t>(answer.wall);
    a.times[Agenda::wall_entry] = answer.time;
    a.wall_pose = answer.pose;
    if (answer.tie) ++counts_.simultaneous_contacts;
  } else {
    a.wall = -1;
    a.times[Agenda::wall_entry] = clock_.after(begin, answer.searched);
  }
}

/// Contacts of one ball at times within rounding of each other are put in order by wider scalars; a true tie
/// keeps the order of the queue and is counted.
template <class Real>
auto Simulation<Real>::settle_ties(Event event) -> Event {
  const auto shares_ball = [&](const Event& other) {
    const auto involves = [&](int ball) {
      return other.ball == ball || (other.kind == EventKind::pair_contact && other.partner == ball);
    };
    return involves(event.ball) || (event.kind == EventKind::pair_contact && involves(event.partner));
  };
  const auto settle = [&](const Event& other) {
    const bool same =
        other.kind == event.kind && ((other.ball == event.ball && other.partner == event.partner) ||
                                     (other.kind == EventKind::pair_contact && other.ball == event.partner &&
                                      other.partner == event.ball));
    if (same || !is_contact(other) || !shares_ball(other)) return;
    const int order = ladder_.order(contact_of(event), contact_of(other));
    if (order == 0) ++counts_.simultaneous_contacts;
    if (order > 0) {
      event = other;
      now_ = other.time;
    }
  };
  const Instant<Real> limit = clock_.after(event.time, suspicion_);
  // The ball's own contacts besides this one, which is the entry that was queued.
  const Agenda& a = agendas_[event.ball];
  for (int entry = 0; entry < static_cast<int>(a.times.size()); ++entry) {
    const bool another = (entry != a.next) & (entry != Agenda::crossing_entry);
    if (!(another & (a.times[entry] <= limit))) continue;
    if (entry != Agenda::wall_entry) {
      if (still_holds(a, entry))
        settle({EventKind::pair_contact, a.times[entry], event.ball, a.partner_at(entry)});
    } else if (a.wall >= 0) {
      settle({EventKind::wall_contact, a.times[entry], event.ball, a.wall});
    }
  }
  const int rival = queue_.runner_up(limit);
  if (rival >= 0) {
    const Event other = next_of(rival);
    if (other.kind != EventKind::pair_contact || still_holds(agendas_[rival], agendas_[rival].next))
      settle(other);
  }
  return event;
}

template <class Real>
dynamics::Contact<Real> Simulation<Real>::contact_of(const Event& event) const {
  const auto& flight = flights_[event.ball];
  if (event.kind == EventKind::wall_contact)
    return {true, flight, flight, properties(event.ball).radius, event.time};
  const auto& partner = flights_[event.partner];
  const Real sum = properties(event.ball).radius + properties(event.partner).radius;
  if (flight.start < partner.start) return {false, partner, flight, sum, event.time};
  return {false, flight, partner, sum, event.time};
}

}  // namespace edmill::engine
