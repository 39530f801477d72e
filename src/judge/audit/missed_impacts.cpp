// Flights: impacts that are missing in a flight, and whether an unlogged one explains its end.
#include <algorithm>

#include "audit/flights.hpp"
#include "base/errors.hpp"

namespace edmill::audit {

/// First contact of a ball with the walls, in (start, until].
std::optional<std::pair<double, int>> Flights::wall_contact(const dynamics::Flight<double>& flight,
                                                            double start, double radius, double until) {
  auto begin = flight.start;
  double rest = until - start;
  while (rest > 0) {
    const double length = std::min(rest, ladder_.walls().longest_window());
    try {
      const auto answer = ladder_.wall({flight, radius, begin, length});
      if (answer.verdict == dynamics::Verdict::contact) {
        const double time = start + clock_.elapsed(flight.start, answer.time);
        if (time > until) return std::nullopt;
        return std::pair(time, answer.wall);
      }
      begin = clock_.after(begin, answer.searched);
      rest -= answer.searched;
    } catch (const UndecidedError&) {
      ++undecided_;
      return std::nullopt;
    }
  }
  return std::nullopt;
}

/// The ball is searched with its radius reduced by the tolerance, so that a contact is certainly an overlap.
auto Flights::first_wall(int ball, const Track& track, double until, double slack) -> std::optional<Contact> {
  const double radius = radius_of(ball);
  const auto frame = nested_at(track.start);
  double overlap = 0;
  for (int wall = 0; wall < walls(); ++wall)
    overlap = std::max(overlap, -wall_gap(frame, case_, wall, ball, track.flight.position));
  const double smaller = radius - overlap - slack;
  if (smaller < radius / 2) return std::nullopt;  // outside the vessel, which was reported before
  const auto contact = wall_contact(track.flight, track.start, smaller, until);
  if (!contact) return std::nullopt;
  return Contact{contact->first, true, contact->second,
                 deepest(ball, track, contact->second, contact->first, until)};
}

double Flights::deepest(int ball, const Track& track, int wall, double from, double until) const {
  constexpr int samples = 32;
  double depth = 0;
  for (int k = 0; k <= samples; ++k) {
    const double time = from + (until - from) * k / samples;
    const Vec position = position_after(track.flight, time - track.start);
    depth = std::max(depth, -wall_gap(nested_at(time), case_, wall, ball, position));
  }
  return depth;
}

/// Whether the log's walls are those of the printed matrix, which was reported, and the flight ends inside
/// of them.
bool Flights::stays_in_printed_vessel(int ball, const Track& track, double until, double slack) const {
  if (!printed_walls_) return false;
  constexpr int samples = 32;
  for (int k = 0; k <= samples; ++k) {
    const double time = track.start + (until - track.start) * k / samples;
    const auto frame = printed_at(time);
    const Vec position = position_after(track.flight, time - track.start);
    for (int wall = 0; wall < walls(); ++wall)
      if (wall_gap(frame, case_, wall, ball, position) < -slack) return false;
  }
  return true;
}

auto Flights::first_ball(int ball, const Track& track, const FlightEnd& end, double slack)
    -> std::optional<Contact> {
  const double until = end.event->time;
  const double radius = radius_of(ball);
  const auto& pairs = ladder_.pairs();
  const auto seen_at_start = pairs.state(track.flight, track.flight.start);
  std::optional<Contact> first;
  for (int other = 0; other < balls(); ++other) {
    const Track& theirs = of(other);
    if (other == ball || !theirs.state_known) continue;
    const bool later = theirs.start > track.start;
    const double from = later ? theirs.start : track.start;
    const double to = theirs.broken ? std::min(until, theirs.broken_from) : until;
    if (from >= to) continue;
    const auto& now = later ? theirs.flight.start : track.flight.start;
    const double sum = radius + radius_of(other);
    // The other ball's place has an uncertain time of its own.
    const double off = slack + 2 * tolerances_.time(until) * size(theirs.flight.velocity);
    if (off > sum / 2) continue;
    const auto seen = later ? pairs.state(track.flight, now) : seen_at_start;
    dynamics::PairAnswer<double> answer;
    try {
      answer = ladder_.pair(seen, track.flight, theirs.flight, now, sum - off);
    } catch (const UndecidedError&) {
      ++undecided_;
    }
    if (answer.verdict != dynamics::Verdict::contact || from + answer.delay > to) continue;
    if (first && first->time <= from + answer.delay) continue;
    const Vec apart = position_at(ball, from) - position_at(other, from);
    if (size(apart) < sum - off) continue;  // they overlapped already, which was reported before
    if (end.late && !end.event->with_wall && end.partner() == other) continue;
    const Vec relative = (track.flight.velocity + case_.mill.gravity * (from - track.start)) -
                         (theirs.flight.velocity + case_.mill.gravity * (from - theirs.start));
    const double nearest = std::clamp(-dot(apart, relative) / dot(relative, relative), 0.0, to - from);
    first = Contact{from + answer.delay, false, other, sum - size(Vec(apart + relative * nearest))};
  }
  return first;
}

/// Whether a ball in this state reaches the logged end of the flight.
bool Flights::arrives(const State& state, const FlightEnd& end) const {
  const double dt = end.event->time - state.start;
  const auto& logged = end.state();
  const double near = std::max(1e-6, 10 * tolerances_.relative);
  const Vec velocity = velocity_after(state.flight, dt);
  return size(Vec(logged.position - position_after(state.flight, dt))) <= near * tolerances_.reach &&
         size(Vec(logged.velocity_before - velocity)) <= 10 * near * std::max(size(velocity), 1.0);
}

/// A ball in this state as it comes into an impact.
BodyState Flights::before_impact(const State& state, double time) const {
  BodyState body;
  body.position = position_after(state.flight, time - state.start);
  body.velocity_before = velocity_after(state.flight, time - state.start);
  body.spin_before = state.spin;
  return body;
}

/// The ball of an impact as it leaves.
auto Flights::after_impact(const LoggedEvent& event) const -> State {
  const auto after = outcome(impact_of(event, case_, nested_at(event.time), true), {})[0];
  return {{after.position, after.velocity_after, clock_.at(event.time)}, after.spin_after, event.time};
}

/// Tries up to four impacts with walls that are not in the log.
bool Flights::explained_by_walls(int ball, const Track& track, const FlightEnd& end) {
  if (!track.spin_known) return false;
  State state{track.flight, track.spin, track.start};
  for (int k = 0; k < 4; ++k) {
    const auto contact = wall_contact(state.flight, state.start, radius_of(ball), end.event->time);
    if (!contact) return false;
    LoggedEvent event;
    event.time = contact->first;
    event.ball = ball;
    event.with_wall = true;
    event.partner = contact->second;
    event.body[0] = before_impact(state, event.time);
    state = after_impact(event);
    if (arrives(state, end)) return true;
  }
  return false;
}

/// Tries the impact with a ball that is not in the log.
bool Flights::explained_by_ball(int ball, const Contact& contact, const FlightEnd& end) const {
  const Track &own = of(ball), &other = of(contact.partner);
  if (!own.spin_known || !other.spin_known) return false;
  // The contact of the actual balls, slightly before that of the reduced ones.
  const double sum = radius_of(ball) + radius_of(contact.partner);
  const Vec apart = position_at(ball, contact.time) - position_at(contact.partner, contact.time);
  const Vec relative = velocity_after(own.flight, contact.time - own.start) -
                       velocity_after(other.flight, contact.time - other.start);
  const double closing = -dot(apart, relative) / size(apart);
  LoggedEvent event;
  event.time = closing > 0 ? contact.time - (sum - size(apart)) / closing : contact.time;
  event.ball = ball;
  event.partner = contact.partner;
  event.body = {before_impact({own.flight, own.spin, own.start}, event.time),
                before_impact({other.flight, other.spin, other.start}, event.time)};
  return arrives(after_impact(event), end);
}

}  // namespace edmill::audit
