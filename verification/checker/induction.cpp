#include "induction.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "numbers.hpp"
#include "pose.hpp"
#include "rules.hpp"
#include "verdict.hpp"

namespace checker {
namespace {

/// "At the start": each component, but a velocity or spin of zero, has the radius 2^-bits.
State state_at_start(const Ball& ball, const Pose& pose, Bits bits) {
  State state{ball.in_vessel ? pose.origin + pose.to_inertial(ball.position) : ball.position,
      ball.velocity, ball.spin};
  for (Real& component : state.position) widen(component, bits);
  for (Vec* vector : {&state.velocity, &state.spin})
    for (Real& component : *vector)
      if (!component.zero()) widen(component, bits);
  return state;
}

/// The flight that begins in this state in the middle of the bracket of an event.
Flight flight_from(const State& state, const Real& bracket, long event, const Vec& gravity) {
  Flight flight{middle(bracket), state, bracket, lower_end(bracket), event, {}, {}, {}, {}};
  const WithPrecision scope(few_bits);
  flight.position_at_0 = flight.position(0, gravity);
  flight.velocity_at_0 = flight.velocity(0, gravity);
  return flight;
}

/// Rule 3: the enclosures of the file, which must hold the computed ones.
Vec require_within(const Json& given, const Vec& computed) {
  Vec result;
  for (Index k = 0; k < 3; ++k) {
    result[k] = enclosure(list(given, 3).at(k).get<std::string>());
    if (!contains(result[k], computed[k]))
      throw Violation("rule 3: a state does not hold what the impact does");
  }
  return result;
}

State require_within(const Json& given, const State& computed) {
  with_keys(given, {"r", "v", "s"});
  return {require_within(given.at("r"), computed.position),
      require_within(given.at("v"), computed.velocity),
      require_within(given.at("s"), computed.spin)};
}

}  // namespace

Induction::Induction(const Json& header, Bits bits)
    : motion_{read_mill(header), {}}, stalls_(motion_.mill.balls.size()) {
  const Pose pose = pose_of(motion_.mill, 0);
  for (const Ball& ball : motion_.mill.balls)
    motion_.flights.push_back(
        flight_from(state_at_start(ball, pose, bits), 0, -1, motion_.mill.gravity));
}

void Induction::take_event(const Json& line) {
  with_keys(line, {"event", "ball", "wall", "partner", "time", "states", "windows"});
  // Rule 6: no event is left out.
  if (line.value("event", Json()) != events_) throw Violation("rule 6: its number is not the next");
  const Contact contact = read_contact(line);
  const auto& [ball, with_wall, other] = contact;

  // Rule 1: the bracket comes after the one before, and the first after the start.
  const Real bracket = enclosure(line.at("time").get<std::string>());
  const Real until = upper_end(bracket);
  if (!(end_ < lower_end(bracket)))
    throw Violation("rule 1: it does not come after the one before");

  const Json &windows = line.at("windows"), &states = line.at("states");
  const Index bodies = with_wall ? 1 : 2;
  if (list(windows, 2).size() != bodies || list(states, 2).size() != bodies)
    throw Violation("other bodies");

  // Rule 2: the event happens. Rules 4 and 5: no other event comes first.
  require_contact(motion_, contact, bracket);
  if (with_wall) {
    require_no_walls(ball, windows.at(0), until, other);
    require_no_balls(ball, {}, until, events_);
  } else {
    require_no_walls(ball, windows.at(0), until, {});
    require_no_balls(ball, other, until, events_);
    require_no_walls(other, windows.at(1), until, {});
    require_no_balls(other, ball, until, events_);
  }

  // Rule 3: the states of the file hold those that follow from the impact.
  const std::vector<State> computed = after_impact(contact, bracket);
  begin_flight(ball, require_within(states.at(0), computed[0]), contact, bracket);
  if (!with_wall) begin_flight(other, require_within(states.at(1), computed[1]), contact, bracket);

  // Rule 5: two balls that have collided part, and so do not meet again on these flights.
  if (!with_wall && !motion_.gap_rate(contact, bracket).positive())
    throw Violation("rule 5: the balls do not part");

  end_ = until;
  ++events_;
}

void Induction::take_end(const Json& line) const {
  with_keys(line, {"end", "windows"});
  const Json& windows = line.at("windows");
  if (windows.size() > balls()) throw Violation("rule 6: the last line has windows of other balls");
  if (line.value("end", Json()) != events_)
    throw Violation("rule 6: the last line names another number of events");
  // Rules 4, 5 and 6: every flight that has not ended, up to the end of the last event's bracket.
  const long last = events_ - 1;
  for (Index ball = 0; ball < balls(); ++ball) {
    if (motion_.flights[ball].event == last && events_ > 0)
      continue;  // its flight begins with the last event
    const std::string name = std::to_string(ball);
    if (!windows.contains(name)) throw Violation("rule 6: the last line lacks a ball");
    require_no_walls(ball, windows.at(name), end_, {});
    require_no_balls(ball, {}, end_, last);
  }
}

Contact Induction::read_contact(const Json& line) const {
  const bool with_wall = line.contains("wall");
  const Index ball = index(line.at("ball"), balls());
  const Index other = with_wall ? index(line.at("wall"), motion_.mill.walls.size())
                                : index(line.at("partner"), balls());
  if (!with_wall && other <= ball)
    throw Violation("the ball with the lower number is not the first");
  return {ball, with_wall, other};
}

/// Rule 4: no other wall than the last one, with which the flight of the ball ends.
void Induction::require_no_walls(
    Index ball, const Json& windows, const Real& until, std::optional<Index> last) const {
  const Index walls = motion_.mill.walls.size();
  if (list(windows, 64).size() != walls) throw Violation("rule 4: windows of other walls");
  for (Index wall = 0; wall < walls; ++wall)
    require_no_wall(motion_, ball, wall, windows.at(wall).get<std::string>(), until, last == wall);
}

/// Rule 5: no other ball than the partner, with which the flight of ball i ends in this event. It
/// is compared with the flights that have not ended; those that ended before were compared with it
/// then.
void Induction::require_no_balls(
    Index i, std::optional<Index> partner, const Real& until, long event) const {
  const Flight& a = motion_.flights[i];
  for (Index j = 0; j < balls(); ++j) {
    const Flight& b = motion_.flights[j];
    if (j == i || j == partner || std::max(a.event, b.event) >= event) continue;
    const bool parting =
        a.event == b.event && a.partner == j && b.partner == i;  // from their collision
    if (!parting) require_no_pair(motion_, i, j, until);
  }
}

std::vector<State> Induction::after_impact(const Contact& contact, const Real& bracket) {
  const Mill& mill = motion_.mill;
  const auto& [i, with_wall, j] = contact;
  const Law& law = mill.laws[(with_wall ? mill.law_of_walls : mill.law_of_balls)[i][j]];
  const bool first = stalls_.stalled(i, law, bracket - motion_.flights[i].bracket);
  if (with_wall) return {after_wall_impact(motion_, i, j, bracket, first)};
  const bool second = stalls_.stalled(j, law, bracket - motion_.flights[j].bracket);
  const std::array<State, 2> states = after_pair_impact(motion_, i, j, bracket, first || second);
  return {states[0], states[1]};
}

void Induction::begin_flight(
    Index ball, const State& state, const Contact& contact, const Real& bracket) {
  Flight& flight = motion_.flights[ball];
  flight = flight_from(state, bracket, events_, motion_.mill.gravity);
  if (contact.with_wall)
    flight.wall = contact.other;
  else
    flight.partner = ball == contact.ball ? contact.other : contact.ball;
}

}  // namespace checker
