// Checks that the flights between logged impacts are ballistic and that no impact was missed.
#pragma once

#include "audit/equations.hpp"
#include "base/errors.hpp"
#include "dynamics/decision_ladder.hpp"

namespace edmill::audit {

struct Judge {
  const Case& case_;
  const Available& available_;
  Tolerances tolerances_;
  Findings& findings_;

  double radius_of(int ball) const { return case_.balls[ball].radius; }
};

struct Flying {
  dynamics::Flight<double> flight{Vec::Zero(), Vec::Zero(), {}};
  Vec spin{0, 0, 0};
  double start = 0;  ///< of the flight [s]
};

struct Track : Flying {
  bool state_known = false, spin_known = false;
  bool known_at(double time) const { return state_known && time >= start; }
  /// Time of an unlogged impact during the flight [s]; infinity if none is known.
  double broken_from = std::numeric_limits<double>::infinity();
  std::vector<Finding> pending;  ///< missed impacts, found at the end of the other ball's flight
  /// A missed impact with a wall, held until the ball's next line, which may log it at this time.
  std::optional<Finding> held;
};

struct FlightEnd {
  const LoggedEvent* event;
  std::size_t body;   ///< 0 the event's ball, 1 its partner
  bool late = false;  ///< the bodies met before the event; already reported

  const BodyState& state() const { return event->body[body]; }
  int partner() const { return body == 0 ? event->partner : event->ball; }  ///< ball or wall
};

class Flights : Judge {
 public:
  explicit Flights(const Judge& shared)
      : Judge(shared), equations_(available_, tolerances_), clock_(case_.mill.motion.period()),
        ladder_(case_.mill, smallest_radius(case_), 32.0), top_speed_(32),
        tracks_(case_.balls.size()), flown_through_(case_.mill.wall_count()) {}

  Track& of(int ball) { return tracks_[ball]; }
  const Track& of(int ball) const { return tracks_[ball]; }
  int balls() const { return static_cast<int>(tracks_.size()); }

  /// Position of a ball, extrapolated from its last known state [m]. @pre its state is known
  Vec position_at(int ball, double time) const { return position_of(of(ball), time); }
  VesselFrame nested_at(double time) const { return vessel_at(case_.mill, time, false); }

  /// Checks the flight of a ball that an event ends.
  void judge(int ball, const FlightEnd& end) {
    Track& track = of(ball);
    const double time = end.event->time;
    settle_held(track, end.event);
    if (!track.known_at(time)) return;
    rows_.clear();
    equations_.of_flight(
        {.from = {.position = track.flight.position,
             .velocity_after = track.flight.velocity,
             .spin_after = track.spin},
            .to = end.state(),
            .had = {.position = true, .velocity_after = true, .spin_after = track.spin_known},
            .has = available_.body[end.body],
            .begin = track.start,
            .end = time,
            .radius = radius_of(ball),
            .body = static_cast<int>(end.body)},
        case_.mill.gravity, rows_);
    const double off = judge_end(ball, track, end, false);
    const double until = std::min(time, track.broken_from);
    // The search reduces radii by the tolerance, provided that at least half of a radius remains.
    const double speed = size(track.flight.velocity) + tolerances_.gravity * (time - track.start);
    const double slack = tolerances_.touch(time, true) +
        tolerances_.position(time, speed * (time - track.start), speed);
    if (slack > radius_of(ball) / 2) {
      findings_.unresolved(Check::missed);
      track.pending.clear();
      judge_end(ball, track, end, true);
      return;
    }
    findings_.judged(Check::missed);
    auto missed = first_wall(ball, track, until, slack);
    // The impact that ends the flight is late, not missed.
    if (missed && end.late && end.event->with_wall && missed->partner == end.event->partner)
      missed.reset();
    if (const auto pair = first_ball(ball, track, end, slack);
        pair && pair->time <= until && !(missed && missed->time <= pair->time))
      missed = pair;

    double missed_at = until;
    bool reported = std::isfinite(track.broken_from);
    if (missed) reported |= report_missed(ball, *missed, end, off, missed_at);
    settle_pending(track, end, off, reported ? missed_at : time);
    if (!reported) judge_end(ball, track, end, true);
  }

  void finish() {
    for (auto& track : tracks_) settle_held(track, nullptr);
  }

  void begin(int ball, double time, const BodyState& state, const Available::Body& has) {
    Track& track = of(ball);
    track.state_known = has.position && has.velocity_after;
    track.spin_known = has.spin_after;
    track.flight = {state.position, state.velocity_after, clock_.at(time)};
    track.spin = state.spin_after;
    track.start = time;
    track.broken_from = std::numeric_limits<double>::infinity();
    track.pending.clear();
    const double speed = size(state.velocity_after);
    if (!(speed < fastest_judged)) track.state_known = false;
    if (2 * speed > top_speed_ && track.state_known) {
      top_speed_ = 4 * speed;
      ladder_.raise_top_speed(top_speed_);
    }
  }

  /// Number of flights through each wall, for the diagnosis.
  const std::vector<std::uint64_t>& flown_through() const { return flown_through_; }
  std::uint64_t undecided() const { return undecided_; }
 private:
  static constexpr std::size_t pending_kept = 8;
  static constexpr double fastest_judged = 1e4;  ///< [m/s]
  static constexpr int samples = 32;             ///< of a flight

  /// Half of the smallest sum of two radii; the search reduces the sums by no more than half.
  static double smallest_radius(const Case& c) {
    const auto smaller = [](const auto& a, const auto& b) { return a.radius < b.radius; };
    return std::min_element(c.balls.begin(), c.balls.end(), smaller)->radius;
  }

  struct Encounter {
    double time = 0;
    bool with_wall = false;
    int partner = -1;
    double depth = 0;  ///< largest overlap of the bodies later in the flight [m]
  };
  /// First overlap of a ball with a wall in its flight, with a radius reduced by the tolerance.
  std::optional<Encounter> first_wall(int ball, const Track& track, double until, double slack) {
    const double radius = radius_of(ball);
    const auto frame = nested_at(track.start);
    double overlap = 0;
    for (int wall = 0; wall < case_.mill.wall_count(); ++wall)
      overlap = std::max(overlap, -wall_gap(frame, case_, wall, ball, track.flight.position));
    const double smaller = radius - overlap - slack;
    if (smaller < radius / 2) return std::nullopt;  // outside the vessel, which was reported before
    auto contact = wall_contact(track, smaller, until);
    for (int k = 0; contact && k <= samples; ++k) {
      const double time = contact->time + (until - contact->time) * k / samples;
      const double gap =
          wall_gap(nested_at(time), case_, contact->partner, ball, position_of(track, time));
      contact->depth = std::max(contact->depth, -gap);
    }
    return contact;
  }

  /// First contact of a ball with the walls, in (start, until].
  std::optional<Encounter> wall_contact(const Flying& own, double radius, double until) {
    auto begin = own.flight.start;
    double rest = until - own.start;
    while (rest > 0) {
      const double length = std::min(rest, ladder_.walls().longest_window());
      try {
        const auto answer = ladder_.wall({own.flight, radius, begin, length});
        if (answer.verdict == dynamics::Verdict::contact) {
          const double time = own.start + clock_.elapsed(own.flight.start, answer.time);
          if (time > until) return std::nullopt;
          return Encounter{time, true, answer.wall};
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

  std::optional<Encounter> first_ball(
      int ball, const Track& own, const FlightEnd& end, double slack) {
    const double until = end.event->time;
    const double radius = radius_of(ball);
    const auto& pairs = ladder_.pairs();
    const auto seen_at_start = pairs.state(own.flight, own.flight.start);
    std::optional<Encounter> first;
    for (int other = 0; other < balls(); ++other) {
      const Track& theirs = of(other);
      if (other == ball || !theirs.state_known) continue;
      const bool later = theirs.start > own.start;
      const double from = later ? theirs.start : own.start;
      const double to = std::min(until, theirs.broken_from);
      if (from >= to) continue;
      const auto& now = later ? theirs.flight.start : own.flight.start;
      const double sum = radius + radius_of(other);
      const Vec apart = position_at(ball, from) - position_at(other, from);
      const Vec relative = velocity_of(own, from) - velocity_of(theirs, from);
      // Gravity cancels: the distance changes only by the relative velocity.
      if (size(apart) > 1.001 * (sum + size(relative) * (to - from))) continue;
      // The position of the other ball has its own uncertainty of time.
      const double off = slack + 2 * rounding_of(until) * size(theirs.flight.velocity);
      if (off > sum / 2) continue;
      const auto seen = later ? pairs.state(own.flight, now) : seen_at_start;
      dynamics::PairAnswer<double> answer;
      try {
        answer = ladder_.pair(seen, own.flight, theirs.flight, now, sum - off);
      } catch (const UndecidedError&) {
        ++undecided_;
      }
      if (answer.verdict != dynamics::Verdict::contact || from + answer.delay > to) continue;
      if (first && first->time <= from + answer.delay) continue;
      if (size(apart) < sum - off) continue;  // they overlapped already, which was reported before
      if (end.late && !end.event->with_wall && end.partner() == other) continue;
      const double at = std::clamp(-dot(apart, relative) / dot(relative, relative), 0.0, to - from);
      const double nearest = size(Vec(apart + relative * at));
      first = Encounter{from + answer.delay, false, other, sum - nearest};
    }
    return first;
  }

  /// True if up to four unlogged impacts with walls lead the ball to the logged end of its flight.
  bool explained_by_walls(int ball, const FlightEnd& end) {
    if (!of(ball).spin_known) return false;
    Flying own = of(ball);
    for (int k = 0; k < 4; ++k) {
      const auto contact = wall_contact(own, radius_of(ball), end.event->time);
      if (!contact) return false;
      LoggedEvent event{
          {.ball = ball, .with_wall = true, .partner = contact->partner, .time = contact->time}};
      event.body[0] = before_impact(own, event.time);
      own = after_impact(event);
      if (arrives(own, end)) return true;
    }
    return false;
  }

  /// True if an unlogged impact with another ball leads the ball to the logged end of its flight.
  bool explained_by_ball(int ball, const Encounter& contact, const FlightEnd& end) const {
    const Track &own = of(ball), &other = of(contact.partner);
    if (!own.spin_known || !other.spin_known) return false;
    // The contact of the actual balls, slightly before that of the reduced ones.
    const double sum = radius_of(ball) + radius_of(contact.partner);
    const Vec apart = position_at(ball, contact.time) - position_at(contact.partner, contact.time);
    const Vec relative = velocity_of(own, contact.time) - velocity_of(other, contact.time);
    const double closing = -dot(apart, relative) / size(apart);
    const double time = closing > 0 ? contact.time - (sum - size(apart)) / closing : contact.time;
    return arrives(after_impact({{.ball = ball, .partner = contact.partner, .time = time},
                       {before_impact(own, time), before_impact(other, time)}}),
        end);
  }

  BodyState before_impact(const Flying& own, double time) const {
    return {.position = position_of(own, time),
        .velocity_before = velocity_of(own, time),
        .spin_before = own.spin};
  }

  Flying after_impact(const LoggedEvent& event) const {
    const auto after = outcome(impact_of(event, case_, nested_at(event.time), true), {}).body[0];
    return {{after.position, after.velocity_after, clock_.at(event.time)}, after.spin_after,
        event.time};
  }

  bool arrives(const Flying& own, const FlightEnd& end) const {
    const auto& logged = end.state();
    const double near = std::max(1e-6, 10 * tolerances_.relative);
    const Vec velocity = velocity_of(own, end.event->time);
    return size(Vec(logged.position - position_of(own, end.event->time))) <=
        near * tolerances_.reach &&
        size(Vec(logged.velocity_before - velocity)) <= 10 * near * std::max(size(velocity), 1.0);
  }

  /// Judges position, velocity and spin at the end of a flight by its rows.
  /// @return the distance from the end of the flight, 0 when within the tolerances [m]
  double judge_end(int ball, const Track& track, const FlightEnd& end, bool report_it) {
    const auto& has = available_.body[end.body];
    const auto judge_row = [&](Check check, bool violated, double off, double found, auto note) {
      findings_.judged(check);
      if (!violated) return;
      Finding at_end{*end.event, kind_of(check), off, found, 0, note};
      at_end.ball = ball;
      at_end.partner = end.partner();
      findings_.add(at_end);
    };
    bool ends_elsewhere = false, resolved = true;
    double off = 0, off_velocity = 0;
    for (const Row& row : rows_) {
      if (row.equation == Check::spin_kept) {
        const bool none = size(end.state().spin_before) == 0;
        if (report_it)
          judge_row(row.equation, row.is_violated(), row.size, row.size,
              none ? "the spin is 0 before the impact" : "");
      } else if (has.velocity_before) {
        ends_elsewhere = ends_elsewhere || row.is_violated();
        const bool of_place = row.kind == RowKind::place;
        off = std::max(off, row.size * (of_place ? 1 : end.event->time - track.start));
        if (of_place)
          resolved = row.allowed <= tolerances_.reach;
        else
          off_velocity = row.size;
      }
    }
    if (report_it && has.position && has.velocity_before) {
      if (resolved)
        judge_row(Check::flight, ends_elsewhere, off, off_velocity, "");
      else
        findings_.unresolved(Check::flight);
    }
    return ends_elsewhere ? std::max(off, std::numeric_limits<double>::min()) : 0;
  }

  /// Reports a missed impact. An impact with a wall is held until the ball's next line; an impact
  /// of two balls that only the partner's flight can confirm is held until the end of that flight.
  /// @param off  distance of the logged position from the end of the flight [m]
  /// @param at  set to the time of the impact if it is, or may still be, reported [s]
  /// @return true if the impact is considered reported
  bool report_missed(int k, const Encounter& missed, const FlightEnd& end, double off, double& at) {
    const bool wall = missed.with_wall, flown_through = off == 0;
    const bool explained =
        !flown_through && (wall ? explained_by_walls(k, end) : explained_by_ball(k, missed, end));
    if (wall && flown_through) ++flown_through_[missed.partner];
    if (!explained && !flown_through && missed.depth <= 2 * off) return false;
    Finding finding{*end.event, Kind::missed_event, missed.depth, unknown, unknown,
        explained            ? "the state changes as in this impact, which is not logged"
            : !flown_through ? ""
            : wall           ? "the ball flew through the wall"
                             : "the balls flew through each other"};
    finding.ball = k;
    finding.with_wall = wall;
    finding.partner = missed.partner;
    finding.time = missed.time;
    if (wall) {
      of(k).held = finding;
    } else if (Track& other = of(missed.partner); explained) {
      findings_.add(finding);
      other.broken_from = std::min(other.broken_from, missed.time);
    } else if (other.pending.size() < pending_kept) {
      other.pending.push_back(finding);
    } else {
      return false;
    }
    at = missed.time;
    return wall || explained || !flown_through;
  }

  /// Confirms missed impacts found at the end of others' flights, if this one agrees with the log.
  void settle_pending(Track& track, const FlightEnd& end, double off, double missed_at) {
    const int other = end.partner();
    for (const auto& missed : track.pending) {
      const bool told_late = end.late && !end.event->with_wall && missed.ball == other;
      if (!told_late && missed.time <= missed_at && (off == 0 || missed.size > 2 * off))
        findings_.add(missed);
    }
    track.pending.clear();
  }

  /// Reports the held impact unless the next line logs it at the same time: time-stepping codes log
  /// several impacts of a ball at one time, of which the second is late, not missed.
  void settle_held(Track& track, const LoggedEvent* next) {
    if (!track.held) return;
    const bool at_once = next && next->time == track.start && next->with_wall;
    if (!at_once || next->partner != track.held->partner) findings_.add(*track.held);
    track.held.reset();
  }

  Vec position_of(const Flying& own, double time) const {
    return dynamics::position_after(own.flight, case_.mill.gravity, time - own.start);
  }

  Vec velocity_of(const Flying& own, double time) const {
    return dynamics::velocity_after(own.flight, case_.mill.gravity, time - own.start);
  }

  Equations equations_;
  Rows rows_;  ///< of the present flight
  DriveClock<double> clock_;
  dynamics::DecisionLadder<double> ladder_;
  double top_speed_;
  std::vector<Track> tracks_;
  std::vector<std::uint64_t> flown_through_;
  std::uint64_t undecided_ = 0;
};

}  // namespace edmill::audit
