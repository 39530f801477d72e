#include "edmill/audit/flights.hpp"

#include <algorithm>
#include <cmath>

#include "edmill/core/errors.hpp"

namespace edmill::dynamics {
extern template class DecisionLadder<double>;
}

namespace edmill::audit {

namespace {

double dot(const Vec& a, const Vec& b) { return edmill::dot<double>(a, b); }
double size(const Vec& a) { return edmill::norm<double>(a); }

constexpr std::size_t pending_kept = 8;
constexpr double fastest_judged = 1e4;  // [m/s]

double smallest_sum(const model::Case<double>& c) {
  double smallest = c.balls.front().radius;
  for (const auto& ball : c.balls) smallest = std::min(smallest, ball.radius);
  return smallest;  // half of what two balls have: radii are made smaller by tolerances
}

}  // namespace

Flights::Flights(const model::Case<double>& the_case, const Available& available,
                 const Tolerances& tolerances, Findings& findings)
    : case_(the_case),
      available_(available),
      tolerances_(tolerances),
      findings_(findings),
      clock_(the_case.mill.motion.period),
      ladder_(the_case.mill, smallest_sum(the_case), 32.0),
      top_speed_(32),
      tracks_(the_case.balls.size()) {}

VesselFrame Flights::nested_at(double time) const {
  return nested_frame(case_.mill.motion, model::pose_at<double>(case_.mill.motion, clock_.at(time).offset));
}
VesselFrame Flights::printed_at(double time) const {
  return printed_frame(case_.mill.motion, model::pose_at<double>(case_.mill.motion, clock_.at(time).offset));
}

Vec Flights::position_at(int ball, double time) const {
  const Track& track = of(ball);
  return dynamics::position_after(track.flight, case_.mill.gravity, time - track.start);
}

void Flights::begin(int ball, double time, const BodyState& state, const Available::Body& has) {
  Track& track = of(ball);
  track.state_known = has.position && has.velocity_after;
  track.spin_known = has.spin_after;
  track.flight = {state.position, state.velocity_after, clock_.at(time)};
  track.spin = state.spin_after;
  track.start = time;
  track.broken = false;
  track.since_start = false;
  track.pending.clear();
  const double speed = size(state.velocity_after);
  if (!(speed < fastest_judged)) track.state_known = false;
  if (2 * speed > top_speed_ && track.state_known) {
    top_speed_ = 4 * speed;
    ladder_.raise_top_speed(top_speed_);
  }
}

void Flights::begin_at_start(int ball, const model::BallState<double>& state, double time) {
  BodyState body;
  body.position = state.position;
  body.velocity_after = state.velocity;
  body.spin_after = state.spin;
  begin(ball, time, body, {true, true, true, true, true});
  of(ball).since_start = true;
}

void Flights::judge(int ball, const FlightEnd& end) {
  Track& track = of(ball);
  const double time = end.event->time;
  settle_held(track, end.event);
  if (!track.state_known || time < track.start) return;
  double off = 0;  // how far the flight ends from where it should [m]
  judge_state(ball, track, end, off, false);
  findings_.judged(Check::missed);

  const double until = track.broken ? std::min(time, track.broken_from) : time;
  const double slack = tolerances_.touch(time, size(track.flight.velocity)) +
                       tolerances_.position(time, size(track.flight.velocity) * (time - track.start), 0);
  std::optional<Contact> missed;
  if (!end.displaced) missed = first_wall(ball, track, until, slack);
  // The impact that ends the flight is late, not missed.
  if (missed && end.late && end.event->with_wall && missed->partner == end.event->partner) missed.reset();
  if (missed && stays_in_printed_vessel(ball, track, until, slack)) missed.reset();
  auto pair = first_ball(ball, track, end, slack);
  if (pair && (pair->time > until || (missed && missed->time <= pair->time))) pair.reset();
  if (pair) missed.reset();

  bool told = track.broken;
  double missed_at = until;
  const auto deep = [&](const Contact& c) { return off == 0 || c.depth > 2 * off; };
  if (missed) {
    const bool explained = off > 0 && explained_by_walls(ball, track, end);
    if (explained || deep(*missed)) {
      track.held = missed_finding(ball, *missed, end,
                                  explained  ? "the state changes as by this impact: it is not logged"
                                  : off == 0 ? "the ball flew on through the wall"
                                             : "");
      told = true;
      missed_at = missed->time;
    }
  }
  if (pair) {
    const bool explained = off > 0 && explained_by_ball(ball, *pair, end);
    Track& other = of(pair->partner);
    if (explained) {
      findings_.add(
          missed_finding(ball, *pair, end, "the state changes as by this impact: it is not logged"));
      if (!other.broken || pair->time < other.broken_from) other.broken_from = pair->time;
      other.broken = told = true;
      missed_at = pair->time;
    } else if (deep(*pair) && other.pending.size() < pending_kept) {
      const Finding finding{Kind::missed_event,
                            pair->depth,
                            end.event->line,
                            pair->time,
                            ball,
                            false,
                            pair->partner,
                            unknown,
                            unknown,
                            off == 0 ? "the balls flew on through each other" : ""};
      other.pending.push_back({finding, pair->depth});
      told = told || off > 0;
      missed_at = pair->time;
    }
  }
  settle_pending(track, end, off, told ? missed_at : time);
  if (!told) judge_state(ball, track, end, off, true);
}

/// Missed impacts that other balls' flights have found are true if this flight was as the log says.
void Flights::settle_pending(Track& track, const FlightEnd& end, double off, double missed_at) {
  const int other = end.body == 0 ? end.event->partner : end.event->ball;
  for (const auto& p : track.pending) {
    const bool told_late = end.late && !end.event->with_wall && p.finding.ball == other;
    if (!told_late && p.finding.time <= missed_at && (off == 0 || p.depth > 2 * off))
      findings_.add(p.finding);
  }
  track.pending.clear();
}

/// Codes that step in time tell several impacts of a ball at one time: the second one is late and not missed.
void Flights::settle_held(Track& track, const LoggedEvent* next) {
  if (!track.held) return;
  const bool told =
      next && next->time == track.start && next->with_wall && next->partner == track.held->partner;
  if (!told) {
    findings_.add(*track.held);
    ++missed_by_wall_[static_cast<std::size_t>(track.held->partner)];
  }
  track.held.reset();
}

void Flights::finish() {
  for (auto& track : tracks_) settle_held(track, nullptr);
}

Finding Flights::missed_finding(int ball, const Contact& contact, const FlightEnd& end,
                                const char* note) const {
  return {Kind::missed_event, contact.depth,   end.event->line, contact.time, ball,
          contact.with_wall,  contact.partner, unknown,         unknown,      note};
}

/// Position, velocity and spin at the end of a flight.
/// @param off  becomes the distance from where the flight should end, 0 when within the tolerances
void Flights::judge_state(int ball, const Track& track, const FlightEnd& end, double& off, bool tell_it) {
  const LoggedEvent& event = *end.event;
  const BodyState& state = event.body[end.body];
  const auto& has = available_.body[end.body];
  const double time = event.time, dt = time - track.start;
  const double speed = std::max(size(track.flight.velocity), size(state.velocity_before));
  const auto tell = [&](Kind kind, double amount, double found, const char* note) {
    findings_.add({kind, amount, event.line, time, ball, event.with_wall,
                   end.body == 0 ? event.partner : event.ball, found, 0, note});
  };
  off = 0;
  if (has.position && has.velocity_before) {
    const double dp = size(Vec(state.position - position_at(ball, time)));
    const double dv =
        size(Vec(state.velocity_before - dynamics::velocity_after(track.flight, case_.mill.gravity, dt)));
    const double gravity = size(case_.mill.gravity);
    const bool good = dp <= tolerances_.position(time, speed * dt, speed) &&
                      dv <= tolerances_.relative * (speed + gravity * dt) + tolerances_.time(time) * gravity;
    if (!good) off = std::max(dp, dv * dt);
    if (!good && off == 0) off = std::numeric_limits<double>::min();
    if (tell_it) {
      findings_.judged(Check::flight);
      if (!good) tell(Kind::non_ballistic, std::max(dp, dv * dt), dv, look_of(track, state, dt, dv));
    }
  }
  if (tell_it && has.spin_before && track.spin_known) {
    findings_.judged(Check::spin_kept);
    const double radius = case_.balls[static_cast<std::size_t>(ball)].radius;
    const double change = radius * size(Vec(state.spin_before - track.spin));
    if (change >
        tolerances_.relative * std::max({speed, radius * size(track.spin), radius * size(state.spin_before)}))
      tell(Kind::lost_spin, change, change,
           size(state.spin_before) == 0 ? "the spin is 0 before the impact" : "");
  }
}

/// What a wrong flight looks like.
const char* Flights::look_of(const Track& track, const BodyState& state, double dt, double dv) const {
  const Vec &p = track.flight.position, &v = track.flight.velocity, &g = case_.mill.gravity;
  const double speed = std::max(size(v), size(state.velocity_before));
  const double close_v = tolerances_.relative * (speed + size(g) * dt);
  const double close_p = tolerances_.position(track.start + dt, speed * dt, speed);
  if (!(size(g) > 0) || !(dt > 0)) return "";
  const auto at = [&](double share) { return Vec(p + v * dt + g * (share * dt * dt / 2)); };
  const auto moving = [&](double share) {
    return size(Vec(state.velocity_before - v - g * (share * dt))) <= close_v;
  };
  if (moving(0) && size(Vec(state.position - at(0))) <= close_p) return "flown without gravity";
  if (moving(-1) && size(Vec(state.position - at(-1))) <= close_p) return "flown with the opposite gravity";
  const Vec rest = state.position - at(1);
  const Vec across = rest - g * (dot(rest, g) / dot(g, g));
  if (dv <= close_v && size(across) <= close_p)
    return dot(rest, g) > 0
               ? "falls too far at the right velocity: first-order steps, velocity before position"
               : "falls too little at the right velocity: first-order steps, position before velocity";
  return "";
}

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

/// The search is for a ball that is smaller by what is forgiven, so that a contact is an overlap for certain.
auto Flights::first_wall(int ball, const Track& track, double until, double slack) -> std::optional<Contact> {
  const double radius = case_.balls[static_cast<std::size_t>(ball)].radius;
  const auto frame = nested_at(track.start);
  double overlap = 0;
  for (int wall = 0; wall < model::wall_count; ++wall)
    overlap = std::max(overlap, -wall_gap(frame, case_.mill.vessel, wall, radius, track.flight.position));
  const double smaller = radius - overlap - slack;
  if (smaller < radius / 2) return std::nullopt;  // outside of the vessel, which was told before
  const auto contact = wall_contact(track.flight, track.start, smaller, until);
  if (!contact) return std::nullopt;
  return Contact{contact->first, true, contact->second,
                 deepest(ball, track, contact->second, contact->first, until)};
}

double Flights::deepest(int ball, const Track& track, int wall, double from, double until) const {
  const double radius = case_.balls[static_cast<std::size_t>(ball)].radius;
  constexpr int samples = 32;
  double depth = 0;
  for (int k = 0; k <= samples; ++k) {
    const double time = from + (until - from) * k / samples;
    const Vec position = dynamics::position_after(track.flight, case_.mill.gravity, time - track.start);
    depth = std::max(depth, -wall_gap(nested_at(time), case_.mill.vessel, wall, radius, position));
  }
  return depth;
}

/// Whether the log's walls stand as the printed matrix has them, which was told, and the flight ends inside
/// of them.
bool Flights::stays_in_printed_vessel(int ball, const Track& track, double until, double slack) const {
  if (findings_.of(Kind::rotation_order).count < 3) return false;
  const double radius = case_.balls[static_cast<std::size_t>(ball)].radius;
  constexpr int samples = 32;
  for (int k = 0; k <= samples; ++k) {
    const double time = track.start + (until - track.start) * k / samples;
    const auto frame = printed_at(time);
    const Vec position = dynamics::position_after(track.flight, case_.mill.gravity, time - track.start);
    for (int wall = 0; wall < model::wall_count; ++wall)
      if (wall_gap(frame, case_.mill.vessel, wall, radius, position) < -slack) return false;
  }
  return true;
}

auto Flights::first_ball(int ball, const Track& track, const FlightEnd& end, double slack)
    -> std::optional<Contact> {
  const double until = end.event->time;
  const double radius = case_.balls[static_cast<std::size_t>(ball)].radius;
  const auto& pairs = ladder_.pairs();
  const auto seen_at_start = pairs.seen(track.flight, track.flight.start);
  std::optional<Contact> first;
  for (int other = 0; other < balls(); ++other) {
    const Track& theirs = of(other);
    if (other == ball || !theirs.state_known) continue;
    const bool later = theirs.start > track.start;
    const double from = later ? theirs.start : track.start;
    const double to = theirs.broken ? std::min(until, theirs.broken_from) : until;
    if (from >= to) continue;
    const auto& now = later ? theirs.flight.start : track.flight.start;
    const double sum = radius + case_.balls[static_cast<std::size_t>(other)].radius;
    const auto seen = later ? pairs.seen(track.flight, now) : seen_at_start;
    dynamics::PairAnswer<double> answer;
    try {
      answer = ladder_.pair(seen, track.flight, theirs.flight, now, sum - slack);
    } catch (const UndecidedError&) {
      ++undecided_;
    }
    if (answer.verdict != dynamics::Verdict::contact || from + answer.delay > to) continue;
    if (first && first->time <= from + answer.delay) continue;
    const Vec apart = position_at(ball, from) - position_at(other, from);
    if (size(apart) < sum - slack) continue;  // they overlapped already, which was told before
    const bool the_end =
        !end.event->with_wall && (end.body == 0 ? end.event->partner : end.event->ball) == other;
    if (the_end && end.late) continue;
    const Vec relative = (track.flight.velocity + case_.mill.gravity * (from - track.start)) -
                         (theirs.flight.velocity + case_.mill.gravity * (from - theirs.start));
    const double nearest = std::clamp(-dot(apart, relative) / dot(relative, relative), 0.0, to - from);
    first = Contact{from + answer.delay, false, other, sum - size(Vec(apart + relative * nearest))};
  }
  return first;
}

Scene Flights::scene_at(int ball, int wall, double time, const Vec& position) const {
  Scene scene;
  scene.nested = nested_at(time);
  scene.printed = printed_at(time);
  Impact& impact = scene.impact;
  impact.with_wall = true;
  impact.ball[0] = case_.balls[static_cast<std::size_t>(ball)];
  impact.normal = wall_normal(scene.nested, wall, position);
  impact.wall_velocity = wall_velocity(WallVelocity::nested, scene.nested, scene.printed,
                                       position - impact.normal * impact.ball[0].radius, position);
  impact.set_masses();
  return scene;
}

/// Whether a ball in this state comes to the end of the flight as it is logged.
bool Flights::arrives(const State& state, const FlightEnd& end) const {
  const double dt = end.event->time - state.start;
  const auto& logged = end.event->body[end.body];
  const double near = std::max(1e-6, 10 * tolerances_.relative);
  const Vec velocity = dynamics::velocity_after(state.flight, case_.mill.gravity, dt);
  return size(Vec(logged.position - dynamics::position_after(state.flight, case_.mill.gravity, dt))) <=
             near * tolerances_.reach &&
         size(Vec(logged.velocity_before - velocity)) <= 10 * near * std::max(size(velocity), 1.0);
}

/// Tries up to four impacts with walls that the log does not have.
bool Flights::explained_by_walls(int ball, const Track& track, const FlightEnd& end) {
  if (!track.spin_known) return false;
  State state{track.flight, track.spin, track.start};
  double last = track.last_impact.value_or(-1);
  const auto& law = case_.mill.ball_wall;
  for (int k = 0; k < 4; ++k) {
    const auto contact = wall_contact(state.flight, state.start,
                                      case_.balls[static_cast<std::size_t>(ball)].radius, end.event->time);
    if (!contact) return false;
    const double time = contact->first, dt = time - state.start;
    LoggedEvent event;
    event.with_wall = true;
    event.body[0].position = dynamics::position_after(state.flight, case_.mill.gravity, dt);
    event.body[0].velocity_before = dynamics::velocity_after(state.flight, case_.mill.gravity, dt);
    event.body[0].spin_before = state.spin;
    const auto scene = scene_at(ball, contact->second, time, event.body[0].position);
    Formula formula;
    formula.restitution = time - last < law.collapse_time ? 1 : law.restitution_normal;
    const auto after = outcome(scene.impact, law, event, formula);
    state = {{event.body[0].position, after[0].velocity_after, clock_.at(time)}, after[0].spin_after, time};
    last = time;
    if (arrives(state, end)) return true;
  }
  return false;
}

/// Tries the impact with a ball that the log does not have.
bool Flights::explained_by_ball(int ball, const Contact& contact, const FlightEnd& end) const {
  const Track &own = of(ball), &other = of(contact.partner);
  if (!own.spin_known || !other.spin_known) return false;
  LoggedEvent event;
  Impact impact;
  impact.ball = {case_.balls[static_cast<std::size_t>(ball)],
                 case_.balls[static_cast<std::size_t>(contact.partner)]};
  impact.set_masses();
  // The contact of the balls as they are, a little before that of the smaller ones.
  const double sum = impact.ball[0].radius + impact.ball[1].radius;
  Vec apart = position_at(ball, contact.time) - position_at(contact.partner, contact.time);
  const auto velocity = [&](const Track& track) {
    return dynamics::velocity_after(track.flight, case_.mill.gravity, contact.time - track.start);
  };
  const Vec relative = velocity(own) - velocity(other);
  const double closing = -dot(apart, relative) / size(apart);
  const double time = closing > 0 ? contact.time - (sum - size(apart)) / closing : contact.time;
  const std::array<const Track*, 2> tracks = {&own, &other};
  for (std::size_t k = 0; k < 2; ++k) {
    const double dt = time - tracks[k]->start;
    event.body[k].position = dynamics::position_after(tracks[k]->flight, case_.mill.gravity, dt);
    event.body[k].velocity_before = dynamics::velocity_after(tracks[k]->flight, case_.mill.gravity, dt);
    event.body[k].spin_before = tracks[k]->spin;
  }
  apart = event.body[0].position - event.body[1].position;
  impact.normal = apart * (1 / size(apart));
  const auto& law = case_.mill.ball_ball;
  for (const double e : {law.restitution_normal, 1.0}) {
    Formula formula;
    formula.restitution = e;
    const auto after = outcome(impact, law, event, formula);
    if (arrives(
            {{event.body[0].position, after[0].velocity_after, clock_.at(time)}, after[0].spin_after, time},
            end))
      return true;
  }
  return false;
}

}  // namespace edmill::audit
