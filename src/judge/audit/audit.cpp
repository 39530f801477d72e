#include "audit/audit.hpp"

#include <fmt/format.h>

#include <iterator>

#include "audit/flights.hpp"

namespace edmill::audit {

namespace {

/// The body that a ball has hit: the other ball, or -1 - wall.
int other_of(const LoggedEvent& event, std::size_t body) {
  return event.with_wall ? -1 - event.partner : event.ball_at(1 - body);
}

class Auditor : Judge {
 public:
  /// @param result  has the columns and the tolerances, and gets what is found
  Auditor(const Case& the_case, Audit& result)
      : Judge{the_case, result.available, result.tolerances, result.findings}, result_(result),
        equations_(available_, tolerances_), flights_(*this),
        stalls_(case_.mill, case_.balls.size()), last_(case_.balls.size()),
        with_wall_(case_.mill.wall_count()) {}

  /// Starts the flights of all balls from their states at the beginning of the log.
  void begin(const BallStates& states, double time) {
    int ball = 0;
    for (const auto& [position, velocity, spin] : states)
      flights_.begin(ball++, time,
          {.position = position, .velocity_after = velocity, .spin_after = spin},
          {true, true, true, true, true});
    stalls_.begin(time);
  }

  void take(LoggedEvent& event) {
    findings_.judged(Check::order);
    findings_.judged(Check::bodies);
    if (const double by = event.earlier_by; by > 0)
      report(Kind::out_of_order, event, by, event.time, event.time + by);
    for (std::size_t body = 0; body < event.count(); ++body) {
      least_ball_ = std::min(least_ball_, event.ball_at(body));
      most_ball_ = std::max(most_ball_, event.ball_at(body));
    }
    if (!event.problem.empty()) {
      report(
          event.unknown_body ? Kind::unknown_body : Kind::not_finite, event, 1, unknown, unknown);
      for (std::size_t body = 0; body < event.count(); ++body) {
        const int k = event.ball_at(body);
        if (k < 0 || k >= flights_.balls()) continue;
        flights_.of(k) = Track{};
        stalls_.forget(k);
      }
      return;
    }
    EDMILL_REQUIRE(event.ball >= 0 && event.ball < flights_.balls() && event.partner >= 0 &&
            event.partner <
                (event.with_wall ? static_cast<int>(with_wall_.size()) : flights_.balls()),
        "bodies that the case has");
    if (is_repeated(event)) {
      if (!event.with_wall && last_[event.ball].as_partner) ++from_both_sides_;
      return report(Kind::duplicate, event, 0, unknown, unknown);
    }

    const auto frame = flights_.nested_at(event.time);
    find_wrong_balls(event);
    const Touch touch = judge_touch(event, frame);
    const bool placed = available_.positions(event.with_wall);
    const auto impact = impact_of(event, case_, frame, placed);
    const auto friction = stalls_.take(event, *impact.law, tolerances_.relative);
    for (std::size_t body = 0; body < event.count(); ++body)
      flights_.judge(event.ball_at(body), {&event, body, touch.late});
    if (touch.usable) judge_impact(impact, friction);

    for (std::size_t body = 0; body < event.count(); ++body) {
      const int k = event.ball_at(body);
      flights_.begin(k, event.time, event.body[body], available_.body[body]);
      last_[k] = {event.time, other_of(event, body), event.approach_speed,
          event.body[body].velocity_before, event.body[body].velocity_after, body == 1};
    }
  }

  /// Completes the pending checks at the end of the log and makes the diagnoses.
  void finish() {
    flights_.finish();
    result_.undecided = flights_.undecided();
    result_.diagnoses = diagnoses();
  }
 private:
  /// Diagnoses walls that the other code lacks, and other conventions for numbers and lines.
  std::vector<Diagnosis> diagnoses() const {
    std::vector<Diagnosis> found;
    const auto add = [&](const char* name, std::uint64_t events, Kind kind, std::string text) {
      if (const auto of = findings_.of(kind).count; accounts_for(events, of))
        found.push_back({name, std::move(text), events, of});
    };
    if (least_ball_ == 1 && most_ball_ == flights_.balls())
      add("numbers", findings_.of(Kind::unknown_body).count, Kind::unknown_body,
          fmt::format("no ball 0 is logged, but a ball {}: balls are numbered from 1 on, as with "
                      "--first-ball 1",
              most_ball_));
    std::string numbers;
    for (std::size_t wall = 1; wall <= with_wall_.size(); ++wall)
      numbers += (wall > 1 ? "," : "") + std::to_string(wall);
    add("walls", next_wall_, Kind::wrong_partner,
        fmt::format("the wall before is touched: walls are numbered from 1 on, as with --walls {}",
            numbers));
    add("pairs", from_both_sides_, Kind::duplicate,
        "impacts of two balls are logged for the one and for the other: log each once");
    const auto walls = case_.mill.walls();
    for (std::size_t wall = 0; wall < walls.size(); ++wall)
      if (with_wall_[wall] == 0)
        add("unseen_wall", flights_.flown_through()[wall], Kind::missed_event,
            fmt::format("no impact with {} is logged, and balls fly through it{}",
                walls[wall].meaning,
                walls[wall].label == "cap -y"
                    ? "; as with the printed error (2.19), (2.20): y - R - h/2 is negative "
                      "everywhere in the vessel, the gap is h/2 + y - R"
                    : ""));
    return found;
  }

  struct LastEvent {
    double time = unknown;
    int other = -1;
    double approach_speed = unknown;
    Vec velocity_before{0, 0, 0}, velocity_after{0, 0, 0};
    bool as_partner = false;
  };
  struct Touch {
    bool late = false, usable = true;
  };

  void report(Kind kind, const LoggedEvent& event, double size, double found, double expected,
      const char* note = "") {
    findings_.add({event, kind, size, found, expected, note});
  }

  /// True if the event repeats the ball's last one: bodies cannot collide twice at the same time.
  bool is_repeated(const LoggedEvent& event) const {
    const LastEvent& last = last_[event.ball];
    if (last.time != event.time || last.other != other_of(event, 0)) return false;
    if (available_.body[0].velocity_before && available_.body[0].velocity_after) {
      // In a line with the roles exchanged, these are the states of the other ball.
      return last.velocity_before == event.body[0].velocity_before &&
          last.velocity_after == event.body[0].velocity_after &&
          last.velocity_before != last.velocity_after;
    }
    return last.approach_speed == event.approach_speed && event.approach_speed > 0;
  }

  /// Reports and corrects wrong ball numbers: the state is at the end of another ball's flight.
  void find_wrong_balls(LoggedEvent& event) {
    for (std::size_t body = 0; body < event.count(); ++body) {
      if (!available_.body[body].position || !available_.body[body].velocity_before) continue;
      const double time = event.time, speed = size(event.body[body].velocity_before);
      const auto off = [&](int k) {
        if (!flights_.of(k).known_at(time)) return -1.0;
        return size(Vec(flights_.position_at(k, time) - event.body[body].position));
      };
      const auto allowed = [&](int k) {
        return tolerances_.position(time, speed * (time - flights_.of(k).start), speed);
      };
      const int named = event.ball_at(body), other = event.ball_at(1 - body);
      const double own = off(named), radius = radius_of(named);
      // Balls cannot be distinguished if the tolerance exceeds half a radius.
      if (own < 0 || own <= radius / 100 + allowed(named) || allowed(named) > radius / 2) continue;
      for (int k = 0; k < flights_.balls(); ++k) {
        const double theirs = off(k);
        if (k == named || k == other || theirs < 0 || !vanishes(own, theirs, allowed(k))) continue;
        report(Kind::wrong_partner, event, own, named, k, "the states are another ball's");
        (body == 0 ? event.ball : event.partner) = k;
        break;
      }
    }
  }

  Touch judge_touch(LoggedEvent& event, const VesselFrame& frame) {
    if (event.with_wall) ++with_wall_[event.partner];
    if (!available_.positions(event.with_wall)) return {};
    const double allowed = tolerances_.touch(event.time, event.with_wall);
    // The touch cannot be checked if the wall's position is uncertain by more than half a radius.
    if (event.with_wall && tolerances_.wall_places(event.time) > radius_of(event.ball) / 2) {
      findings_.unresolved(Check::touch);
      return {};
    }
    findings_.judged(Check::touch);
    const double gap = gap_of(event, case_, frame);
    if (std::abs(gap) <= allowed) return {};
    if (event.with_wall && another_is_met(event, frame, allowed, std::abs(gap)))
      return {false, event.with_wall};  // the log lacks the state of the other ball, if it was one
    report(gap < 0 ? Kind::late_event : Kind::early_event, event, std::abs(gap), gap, 0);
    return {gap < 0, true};
  }

  /// Finds the body that is touched, at `off` from the logged one; the other checks use it.
  bool another_is_met(LoggedEvent& event, const VesselFrame& frame, double allowed, double off) {
    const double radius = radius_of(event.ball);
    const Vec& position = event.body[0].position;
    if (!(off > radius / 100)) return false;
    for (int wall = 0; wall < static_cast<int>(with_wall_.size()); ++wall)
      if (wall != event.partner &&
          vanishes(off, std::abs(wall_gap(frame, case_, wall, event.ball, position)), allowed)) {
        report(Kind::wrong_partner, event, off, event.partner, wall, "another wall is touched");
        if (event.partner == wall + 1) ++next_wall_;
        event.partner = wall;
        return true;
      }
    for (int k = 0; k < flights_.balls(); ++k) {
      if (k == event.ball || !flights_.of(k).known_at(event.time)) continue;
      const Vec between = flights_.position_at(k, event.time) - position;
      const double apart = std::abs(size(between) - radius - radius_of(k));
      if (vanishes(off, apart, allowed)) {
        report(Kind::wrong_partner, event, off, event.partner, k, "a ball is touched, and no wall");
        flights_.of(k) = Track{};
        event.with_wall = false;
        event.partner = k;
        return true;
      }
    }
    return false;
  }

  /// Judges an impact by the states of its bodies, or without them by the logged speeds.
  void judge_impact(LoggedImpact impact, Friction friction) {
    const LoggedEvent& event = *impact.event;
    impact.in_stall = friction == Friction::rests;
    rows_.clear();
    const auto allowed = equations_.of_impact(impact, rows_);
    if (friction == Friction::either) {  // choose the one that violates fewer equations
      Rows rested;
      impact.in_stall = true;
      equations_.of_impact(impact, rested);
      const auto violated = [](const Rows& rows) {
        return std::count_if(rows.begin(), rows.end(), std::mem_fn(&Row::is_violated));
      };
      impact.in_stall = violated(rested) < violated(rows_);
      if (impact.in_stall) rows_ = std::move(rested);
    }
    bool wrong_torque = false;
    for (auto row = rows_.begin(); row != rows_.end(); ++row) {
      // An equation with a row for each of two bodies counts once, by the worse row.
      if (const auto next = std::next(row);
          next != rows_.end() && next->equation == row->equation) {
        if (next->size < row->size) *next = *row;
        continue;
      }
      if (!allowed.can_be_checked) {
        findings_.unresolved(row->equation);
        continue;
      }
      if (row->equation == Check::spin_change) wrong_torque = row->is_violated();
      // With a wrong torque the slip after the impact carries no further information.
      const bool known = !(wrong_torque && row->equation == Check::tangential_law);
      findings_.judged(row->equation);
      if (known && row->is_violated())
        report(kind_of(row->equation), event, row->size, row->found, row->expected);
    }
    const bool with_wall = impact.with_wall();
    if (allowed.can_be_checked && available_.positions(with_wall) &&
        available_.velocities_before(with_wall) && available_.velocities_after(with_wall) &&
        available_.spins(with_wall))
      add_energies(impact, allowed.energy);
  }

  /// Adds the energies of an impact to the totals. @param allowed  tolerance of energies [J]
  void add_energies(const LoggedImpact& impact, double allowed) {
    const double work = work_of_wall(impact), gained = kinetic_change(impact);
    const Speeds speeds = speeds_before(impact);
    const double due = supplied(impact, speeds.g_n, impact.separation_speed(speeds.g_n));
    Energies& energies = result_.energies;
    ++energies.impacts;
    energies.wall_work += work;
    energies.kinetic_change += gained;
    energies.supplied += due;
    energies.milling_dose +=
        available_.milling_dose ? impact.event->milling_dose : dose_by_law(impact, speeds);
    if (due > 0) ++energies.supplying;
    if (const double created = gained - work - due; created > allowed) {
      ++energies.creating;
      energies.created += created;
    }
  }

  Audit& result_;
  Equations equations_;
  Rows rows_;  ///< equations of the current impact
  Flights flights_;
  StallHistory stalls_;
  std::vector<LastEvent> last_;
  std::vector<std::uint64_t> with_wall_;  ///< number of logged impacts with each wall
  int least_ball_ = std::numeric_limits<int>::max(), most_ball_ = -1;  ///< numbers in the log
  std::uint64_t from_both_sides_ = 0;  ///< pair impacts logged again with exchanged roles
  std::uint64_t next_wall_ = 0;        ///< impacts whose actual wall has the logged number - 1
};

/// @param next  returns the next event in order of time, or nothing at the end
Audit audit_events(const Case& the_case, const BallStates* states, const Options& options,
    const std::string& file, const Available& available, const auto& next) {
  Audit result;
  result.findings = Findings(options.examples);
  result.tolerances = tolerances_of(the_case, options);
  result.log_name = file;
  result.available = available;
  Auditor auditor(the_case, result);
  const DriveClock<double> clock(the_case.mill.motion.period());
  if (states) auditor.begin(*states, clock.seconds(the_case.initial_time));
  bool any_pairs = false;
  while (auto event = next()) {
    if (options.interrupt && options.interrupt->load(std::memory_order_relaxed)) {
      result.interrupted = true;
      break;
    }
    if (result.events++ == 0) result.first = event->time;
    result.last = std::max(result.last, event->time);
    any_pairs = any_pairs || !event->with_wall;
    auditor.take(*event);
    if (options.progress && result.events % 4096 == 0) options.progress(event->time, result.events);
  }
  auditor.finish();
  const auto& checked = result.findings;
  result.not_made = checks_with([&](Check check) {
    const bool tried = checked.judged_number(check) + checked.unresolved_number(check) > 0;
    return !tried && (check != Check::momentum || any_pairs);
  });
  // A log can be clean only if at least half of its contacts could be checked.
  const bool judged =
      checked.judged_number(Check::touch) + checked.judged_number(Check::milling_dose) > 0 &&
      checked.judged_number(Check::touch) >= checked.unresolved_number(Check::touch);
  result.verdict = result.findings.total() > 0 ? Verdict::differ
      : judged                                 ? Verdict::agree
                                               : Verdict::too_few;
  return result;
}

logs::EventLog open_log(const Case& the_case, const Options& options) {
  return {options.log, options.conventions, static_cast<int>(the_case.balls.size()),
      the_case.mill.wall_count(), 1e15 * the_case.mill.motion.period()};
}

}  // namespace

Options options_of(const casefile::CaseSpec& spec) {
  const auto& s = spec.audit;
  Options options;
  options.conventions.columns.assign(s.columns.begin(), s.columns.end());
  options.conventions.first_ball = static_cast<int>(s.first_ball.value_or(0));
  if (!s.walls.empty())
    options.conventions.walls =
        logs::parse_walls(s.walls, casefile::partners_of(spec), spec.file + ": key 'audit.walls'");
  if (s.tolerance) options.tolerance = s.tolerance->to<double>();
  if (s.gap_tolerance) options.gap_tolerance = s.gap_tolerance->to<double>();
  options.from_start = s.from_start;
  return options;
}

std::string_view name_of(Verdict verdict) {
  return std::array{"clean", "violations", "too_few"}.at(static_cast<std::size_t>(verdict));
}

Tolerances tolerances_of(const Case& the_case, const Options& options) {
  Tolerances tolerances;
  tolerances.relative = options.tolerance;
  tolerances.reach = the_case.mill.motion.reach(the_case.mill.vessel.reach());
  tolerances.gravity = norm<double>(the_case.mill.gravity);
  tolerances.walls = WallRates::of(the_case.mill);
  tolerances.gap = options.gap_tolerance.value_or(options.tolerance * tolerances.reach);
  return tolerances;
}

Audit audit(const Case& the_case, const BallStates& states, const Options& options) {
  auto log = open_log(the_case, options);
  return audit_events(the_case, options.from_start ? &states : nullptr, options, log.file(),
      log.available(), [&] { return log.next(); });
}

EventsAtHand read_events(const Case& the_case, const Options& options, std::size_t most) {
  auto log = open_log(the_case, options);
  EventsAtHand result{log.file(), log.available(), {}};
  for (std::optional<LoggedEvent> event; result.events.size() < most && (event = log.next());)
    result.events.push_back(*std::move(event));
  return result;
}

Audit audit(const Case& the_case, const EventsAtHand& log, const Options& options) {
  std::size_t k = 0;
  return audit_events(the_case, nullptr, options, log.file, log.available,
      [&] { return k < log.events.size() ? std::optional(log.events[k++]) : std::nullopt; });
}

}  // namespace edmill::audit
