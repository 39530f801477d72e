#include "audit/flights.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace edmill::audit {

namespace {

constexpr std::size_t pending_kept = 8;
constexpr double fastest_judged = 1e4;  // [m/s]

/// Mistakes of a flight. The last two are of steps of one length, unknown before.
constexpr std::array<const char*, 4> look_notes = {
    "flight without gravity", "flight with the opposite gravity",
    "falls too far at the right velocity: first-order steps, velocity before position",
    "falls too little at the right velocity: first-order steps, position before velocity"};

double smallest_sum(const model::Case<double>& c) {
  double smallest = c.balls.front().radius;
  for (const auto& ball : c.balls) smallest = std::min(smallest, ball.radius);
  return smallest;  // half of that of two balls: radii are reduced by tolerances
}

}  // namespace

Flights::Flights(const Judge& shared)
    : Judge(shared),
      clock_(case_.mill.motion.period()),
      ladder_(case_.mill, smallest_sum(case_), 32.0),
      top_speed_(32),
      tracks_(case_.balls.size()),
      flown_through_(case_.mill.vessel.walls().size()),
      looks_(look_notes.size(), Suspicion(findings_.examples())) {}

Vec Flights::position_at(int ball, double time) const {
  const Track& track = of(ball);
  return position_after(track.flight, time - track.start);
}

void Flights::begin(int ball, double time, const BodyState& state, const Available::Body& has) {
  Track& track = of(ball);
  track.state_known = has.position && has.velocity_after;
  track.spin_known = has.spin_after;
  track.flight = {state.position, state.velocity_after, clock_.at(time)};
  track.spin = state.spin_after;
  track.start = time;
  track.broken = false;
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
}

void Flights::judge(int ball, const FlightEnd& end) {
  Track& track = of(ball);
  const double time = end.event->time;
  settle_held(track, end.event);
  if (!track.state_known || time < track.start) return;
  double off = 0;  // distance of the logged position from the end of the flight [m]
  judge_state(ball, track, end, off, false);
  const double until = track.broken ? std::min(time, track.broken_from) : time;
  // Balls are searched with radii that are smaller by the tolerance, if that leaves half of them.
  const double speed = size(track.flight.velocity) + tolerances_.gravity * (time - track.start);
  const double slack =
      tolerances_.touch(time, true) + tolerances_.position(time, speed * (time - track.start), speed);
  if (slack > radius_of(ball) / 2) {
    findings_.unresolved(Check::missed);
    track.pending.clear();
    return judge_state(ball, track, end, off, true);
  }
  findings_.judged(Check::missed);
  std::optional<Contact> missed;
  if (!end.displaced) missed = first_wall(ball, track, until, slack);
  // The impact that ends the flight is late, not missed.
  if (missed && end.late && end.event->with_wall && missed->partner == end.event->partner) missed.reset();
  if (missed && stays_in_printed_vessel(ball, track, until, slack)) missed.reset();
  auto pair = first_ball(ball, track, end, slack);
  if (pair && (pair->time > until || (missed && missed->time <= pair->time))) pair.reset();
  if (pair) missed.reset();

  double missed_at = until;
  bool told = track.broken;
  if (missed) told |= report_missed_wall(ball, track, *missed, end, off, missed_at);
  if (pair) told |= report_missed_ball(ball, *pair, end, off, missed_at);
  settle_pending(track, end, off, told ? missed_at : time);
  if (!told) judge_state(ball, track, end, off, true);
}

/// @param off  distance of the logged position from the end of the flight [m]
/// @return whether it is reported; then `missed_at` becomes its time
bool Flights::report_missed_wall(int ball, Track& track, const Contact& missed, const FlightEnd& end,
                                 double off, double& missed_at) {
  const bool explained = off > 0 && explained_by_walls(ball, track, end);
  if (off == 0) ++flown_through_[missed.partner];
  if (!explained && off > 0 && missed.depth <= 2 * off) return false;
  track.held = missed_finding(ball, missed, end,
                              explained  ? "the state changes as in this impact, which is not logged"
                              : off == 0 ? "the ball flew through the wall"
                                         : "",
                              explained);
  missed_at = missed.time;
  return true;
}

/// Reports a missed impact of two balls; what only the partner's flight can confirm waits for that flight.
bool Flights::report_missed_ball(int ball, const Contact& pair, const FlightEnd& end, double off,
                                 double& missed_at) {
  Track& other = of(pair.partner);
  if (off > 0 && explained_by_ball(ball, pair, end)) {
    findings_.add(
        missed_finding(ball, pair, end, "the state changes as in this impact, which is not logged", true));
    if (!other.broken || pair.time < other.broken_from) other.broken_from = pair.time;
    other.broken = true;
    missed_at = pair.time;
    return true;
  }
  if ((off > 0 && pair.depth <= 2 * off) || other.pending.size() >= pending_kept) return false;
  const char* note = off == 0 ? "the balls flew through each other" : "";
  other.pending.push_back({missed_finding(ball, pair, end, note, false), pair.depth});
  missed_at = pair.time;
  return off > 0;
}

/// Missed impacts that were found with other balls' flights are confirmed if this flight agrees with the log.
void Flights::settle_pending(Track& track, const FlightEnd& end, double off, double missed_at) {
  const int other = end.partner();
  for (const auto& p : track.pending) {
    const bool told_late = end.late && !end.event->with_wall && p.finding.ball == other;
    if (!told_late && p.finding.time <= missed_at && (off == 0 || p.depth > 2 * off))
      findings_.add(p.finding);
  }
  track.pending.clear();
}

/// Time-stepping codes log several impacts of a ball at one time: the second one is late, not missed.
void Flights::settle_held(Track& track, const LoggedEvent* next) {
  if (!track.held) return;
  const bool told =
      next && next->time == track.start && next->with_wall && next->partner == track.held->partner;
  if (!told) findings_.add(*track.held);
  track.held.reset();
}

void Flights::finish() {
  for (auto& track : tracks_) settle_held(track, nullptr);
  for (const auto& look : looks_) findings_.take(look.findings());
}

Finding Flights::missed_finding(int ball, const Contact& contact, const FlightEnd& end, const char* note,
                                bool explained) const {
  return {Kind::missed_event, contact.depth, end.event->line, contact.time, ball,     contact.with_wall,
          contact.partner,    unknown,       unknown,         note,         explained};
}

/// Position, velocity and spin at the end of a flight.
/// @param off  becomes the distance from the end of the flight, 0 when within the tolerances
void Flights::judge_state(int ball, const Track& track, const FlightEnd& end, double& off, bool tell_it) {
  const LoggedEvent& event = *end.event;
  const BodyState& state = end.state();
  const auto& has = available_.body[end.body];
  const double time = event.time, dt = time - track.start;
  const double speed = std::max(size(track.flight.velocity), size(state.velocity_before));
  const auto finding = [&](Kind kind, double amount, double found, const char* note) {
    return Finding{kind, amount, event.line, time, ball, event.with_wall, end.partner(), found, 0, note};
  };
  off = 0;
  if (has.position && has.velocity_before) {
    const double dp = size(Vec(state.position - position_at(ball, time)));
    const double dv = size(Vec(state.velocity_before - velocity_after(track.flight, dt)));
    const double fastest = speed + tolerances_.gravity * dt;
    const bool good =
        dp <= tolerances_.position(time, speed * dt, fastest) && dv <= tolerances_.velocity(time, fastest);
    if (!good) off = std::max(dp, dv * dt);
    if (!good && off == 0) off = std::numeric_limits<double>::min();
    if (tell_it && tolerances_.position(time, 0, fastest) > tolerances_.reach)
      findings_.unresolved(Check::flight);
    else if (tell_it)
      tell_flight(track, state, finding(Kind::non_ballistic, std::max(dp, dv * dt), dv, ""), good);
  }
  if (tell_it && has.spin_before && track.spin_known) {
    findings_.judged(Check::spin_kept);
    const double radius = radius_of(ball);
    const double change = radius * size(Vec(state.spin_before - track.spin));
    if (change >
        tolerances_.relative * std::max({speed, radius * size(track.spin), radius * size(state.spin_before)}))
      findings_.add(finding(Kind::lost_spin, change, change,
                            size(state.spin_before) == 0 ? "the spin is 0 before the impact" : ""));
  }
}

/// How far the end of a flight is from where a mistake leads. @param shows  how far the mistake leads [m]
double Flights::look(std::size_t k, const Track& track, const BodyState& state, double dt, double& shows) {
  const Vec& g = case_.mill.gravity;
  const Vec fallen = state.position - (track.flight.position + track.flight.velocity * dt);
  const Vec gained = state.velocity_before - track.flight.velocity;
  // Shares of the fall and of the velocity that gravity gives in the time.
  double fall = k == 0 ? 0 : -1, gain = fall;
  if (k >= 2) {
    const double excess = dot(fallen, g) / dot(g, g) - dt * dt / 2, sign = k == 2 ? 1 : -1;
    if (!(step_ > 0) && sign * excess > 0) step_ = 2 * sign * excess / dt;
    fall = 1 + sign * step_ / dt, gain = 1;
  }
  shows = std::abs(fall - 1) * tolerances_.gravity * dt * dt / 2;
  return std::max(size(Vec(fallen - g * (fall * dt * dt / 2))), size(Vec(gained - g * (gain * dt))) * dt);
}

/// Reports a flight unless it is good, by the mistake that explains it.
void Flights::tell_flight(const Track& track, const BodyState& state, const Finding& finding, bool good) {
  findings_.judged(Check::flight);
  const double dt = finding.time - track.start,
               speed = std::max(size(track.flight.velocity), size(state.velocity_before));
  const double allowed = tolerances_.position(finding.time, speed * dt, speed);
  bool told = good;
  for (std::size_t k = 0; k < looks_.size() && tolerances_.gravity > 0 && dt > 0; ++k) {
    if (good && !looks_[k].is_suspected()) continue;
    const bool first = k >= 2 && !(step_ > 0);
    double shows = 0;
    const double left = look(k, track, state, dt, shows);
    if (!told && vanishes(finding.size, left, allowed)) {
      told = true;
      Finding named = finding;
      named.note = look_notes[k], named.explained = true;
      looks_[k]
          .explains(finding.size, first ? finding.size : left)
          .add(named);  // the first one gives the step
      looks_[k].plain().add(finding);
    } else if (looks_[k].is_suspected() && shows > allowed && !(left <= allowed)) {
      looks_[k].contradicted();
    }
    if (first && !looks_[k].is_suspected()) step_ = 0;
  }
  if (!told) findings_.add(finding);
}

}  // namespace edmill::audit
