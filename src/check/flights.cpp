#include "check/flights.hpp"

#include <algorithm>
#include <cmath>

namespace edmill::dynamics {
extern template class DecisionLadder<double>;
}

namespace edmill::audit {

namespace {

constexpr std::size_t pending_kept = 8;
constexpr double fastest_judged = 1e4;  // [m/s]

double smallest_sum(const model::Case<double>& c) {
  double smallest = c.balls.front().radius;
  for (const auto& ball : c.balls) smallest = std::min(smallest, ball.radius);
  return smallest;  // half of that of two balls: radii are reduced by tolerances
}

}  // namespace

Flights::Flights(const model::Case<double>& the_case, const Available& available,
                 const Tolerances& tolerances, Findings& findings)
    : case_(the_case),
      available_(available),
      tolerances_(tolerances),
      findings_(findings),
      clock_(the_case.mill.motion.period()),
      ladder_(the_case.mill, smallest_sum(the_case), 32.0),
      top_speed_(32),
      tracks_(the_case.balls.size()),
      missed_by_wall_(the_case.mill.vessel.walls().size()) {}

VesselFrame Flights::frame_at(double time, bool as_printed) const {
  const auto when = clock_.at(time);
  auto frame = frame_of(case_.mill.motion, case_.mill.motion.pose(when), as_printed);
  frame.moved = moved_walls(case_.mill.vessel, when);
  return frame;
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
  if (!explained && off > 0 && missed.depth <= 2 * off) return false;
  track.held = missed_finding(ball, missed, end,
                              explained  ? "the state changes as in this impact, which is not logged"
                              : off == 0 ? "the ball flew through the wall"
                                         : "");
  missed_at = missed.time;
  return true;
}

/// The same for two balls; what only the partner's flight can confirm is left pending with the partner.
bool Flights::report_missed_ball(int ball, const Contact& pair, const FlightEnd& end, double off,
                                 double& missed_at) {
  Track& other = of(pair.partner);
  if (off > 0 && explained_by_ball(ball, pair, end)) {
    findings_.add(
        missed_finding(ball, pair, end, "the state changes as in this impact, which is not logged"));
    if (!other.broken || pair.time < other.broken_from) other.broken_from = pair.time;
    other.broken = true;
    missed_at = pair.time;
    return true;
  }
  if ((off > 0 && pair.depth <= 2 * off) || other.pending.size() >= pending_kept) return false;
  const Finding finding{Kind::missed_event,
                        pair.depth,
                        end.event->line,
                        pair.time,
                        ball,
                        false,
                        pair.partner,
                        unknown,
                        unknown,
                        off == 0 ? "the balls flew through each other" : ""};
  other.pending.push_back({finding, pair.depth});
  missed_at = pair.time;
  return off > 0;
}

/// Missed impacts that were found with other balls' flights are confirmed if this flight agrees with the log.
void Flights::settle_pending(Track& track, const FlightEnd& end, double off, double missed_at) {
  const int other = end.body == 0 ? end.event->partner : end.event->ball;
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
/// @param off  becomes the distance from the end of the flight, 0 when within the tolerances
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

/// The known mistake that explains a wrong flight.
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
  if (moving(0) && size(Vec(state.position - at(0))) <= close_p) return "flight without gravity";
  if (moving(-1) && size(Vec(state.position - at(-1))) <= close_p) return "flight with the opposite gravity";
  const Vec rest = state.position - at(1);
  const Vec across = rest - g * (dot(rest, g) / dot(g, g));
  if (dv <= close_v && size(across) <= close_p)
    return dot(rest, g) > 0
               ? "falls too far at the right velocity: first-order steps, velocity before position"
               : "falls too little at the right velocity: first-order steps, position before velocity";
  return "";
}

}  // namespace edmill::audit
