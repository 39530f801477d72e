#include "audit/audit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "audit/delays.hpp"
#include "audit/flights.hpp"
#include "base/errors.hpp"

namespace edmill::audit {

namespace {

std::vector<Check> checks_not_made(const Findings& findings, bool any_pairs) {
  std::vector<Check> missing;
  for (std::size_t k = 0; k < check_count; ++k) {
    const auto check = static_cast<Check>(k);
    const bool only_pairs = check == Check::momentum && !any_pairs;
    const bool tried = findings.judged_number(check) + findings.unresolved_number(check) > 0;
    if (!tried && !only_pairs) missing.push_back(check);
  }
  return missing;
}

std::uint64_t noted(const Tally& tally, std::string_view beginning) {
  std::uint64_t sum = 0;
  for (const auto& [note, count] : tally.notes)
    if (note.starts_with(beginning)) sum += count;
  return sum;
}

/// What a ball has hit: the other ball, or -1 - wall.
int other_of(const LoggedEvent& event, std::size_t body) {
  return event.with_wall ? -1 - event.partner : event.ball_at(1 - body);
}

/// Takes the events of a log one by one, with the state that precedes each.
class Auditor : Judge {
 public:
  explicit Auditor(const Judge& shared)
      : Judge(shared),
        impacts_(shared),
        flights_(shared),
        stalls_(case_.mill, case_.balls.size()),
        last_(case_.balls.size()),
        with_wall_(case_.mill.vessel.walls().size()),
        rotations_(findings_.examples()) {}

  /// The log begins with these states.
  void begin(const std::vector<model::BallState<double>>& states, double time) {
    for (std::size_t k = 0; k < states.size(); ++k)
      flights_.begin_at_start(static_cast<int>(k), states[k], time);
    stalls_.begin(time);
  }

  void take(LoggedEvent& event) {
    findings_.judged(Check::order);
    findings_.judged(Check::bodies);
    if (event.earlier_by > 0)
      tell(Kind::out_of_order, event, event.earlier_by, event.time, event.time + event.earlier_by);
    if (!event.problem.empty()) {
      tell(event.unknown_body ? Kind::unknown_body : Kind::not_finite, event, 1, unknown, unknown);
      const auto forget = [&](int k) {
        if (k < 0 || k >= flights_.balls()) return;
        flights_.of(k) = Track{};
        stalls_.forget(k);
      };
      forget(event.ball);
      if (!event.with_wall) forget(event.partner);
      return;
    }
    EDMILL_REQUIRE(
        event.ball >= 0 && event.ball < flights_.balls() && event.partner >= 0 &&
            event.partner < (event.with_wall ? static_cast<int>(with_wall_.size()) : flights_.balls()),
        "bodies that the case has");
    if (is_repeated(event)) return tell(Kind::duplicate, event, 0, unknown, unknown);

    Scene scene{{}, flights_.nested_at(event.time), flights_.printed_at(event.time)};
    find_wrong_balls(event);
    const Touch touch = judge_touch(event, scene);
    if (available_.positions(event.with_wall)) scene.impact.bend = bend_of(event, case_, scene.nested);
    scene.friction = stalls_.take(event, *scene.impact.law, tolerances_.relative);
    for (std::size_t body = 0; body < event.count(); ++body)
      flights_.judge(event.ball_at(body), {&event, body, touch.late, touch.displaced});
    if (touch.usable) impacts_.judge(scene);

    for (std::size_t body = 0; body < event.count(); ++body) {
      const int k = event.ball_at(body);
      flights_.begin(k, event.time, event.body[body], available_.body[body]);
      last_[k] = {event.time, other_of(event, body), event.approach_speed, event.body[body].velocity_before,
                  event.body[body].velocity_after};
    }
  }

  /// At the end of the log.
  void finish() {
    flights_.finish();
    impacts_.finish();
    findings_.take(rotations_.findings());
  }

  const Energies& energies() const { return impacts_.energies(); }
  const Flights& flights() const { return flights_; }

  /// What a log looks like: printed errors of the thesis, or finite steps.
  std::vector<Diagnosis> diagnoses() const {
    std::vector<Diagnosis> found;
    const auto add = [&](const char* name, std::uint64_t events, std::uint64_t of, const std::string& text) {
      if (accounts_for(events, of)) found.push_back({name, text, events, of});
    };
    const auto count = [&](Kind kind) { return findings_.of(kind).count; };
    const auto late = count(Kind::late_event), early = count(Kind::early_event);
    add("rotation_order", count(Kind::rotation_order), count(Kind::rotation_order) + late + early,
        "printed error (2.14): the vessel is rotated by R_x(gamma) R_z(theta); with that matrix the bodies "
        "touch. The rotations are nested: R_z(theta) R_x(gamma)");
    const auto& sign = findings_.of(Kind::tangential_sign);
    add("tangential_sign", noted(sign, "(2.34)"), sign.count,
        "printed error (2.34), (A.72): the tangential term of the velocity has the wrong sign; with the "
        "printed sign the velocities are exactly those of the log");
    const auto& unequal = findings_.of(Kind::unequal_balls);
    add("unequal_mass_factor", noted(unequal, "(2.24)"), unequal.count,
        "printed error (2.24): 1 + 1/J instead of 1 + M/(m_i J_i) + M/(m_j J_j); with it the outcome is "
        "exactly that of the log");
    // Other vessels have no such equation.
    if (case_.mill.vessel.walls()[0].label == "cap -y" && with_wall_[0] == 0 && late + early == 0)
      add("gap_sign", flights_.flown_through()[0], count(Kind::missed_event),
          "printed error (2.19), (2.20): no impact with the cap at -y is logged, and balls fly through it; "
          "y - R - h/2 is negative everywhere in the vessel, the gap is h/2 + y - R");
    if (const double step = delays_.step(); step > 0 && early == 0)
      add("time_step", late, late,
          fmt::format(
              "finite steps: contacts are seen late by times that are spread evenly from 0 to {:.2g} s, "
              "alike with all walls and balls; a gap tolerance of {:.2g} m (--gap-tolerance) accepts them "
              "and leaves any other violation",
              step, 1.1 * findings_.of(Kind::late_event).worst));
    return found;
  }

 private:
  /// The last event of a ball, to recognise a duplicate.
  struct LastEvent {
    double time = unknown;
    int other = -1;
    double approach_speed = unknown;
    Vec velocity_before{0, 0, 0}, velocity_after{0, 0, 0};
  };
  struct Touch {
    bool late = false, displaced = false, usable = true;
  };

  /// Bodies that have separated cannot have the same impact again at the same time.
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

  /// A ball that is not at the end of its flight, but at the end of another ball's flight, has the wrong
  /// number.
  void find_wrong_balls(LoggedEvent& event) {
    for (std::size_t body = 0; body < event.count(); ++body) {
      if (!available_.body[body].position || !available_.body[body].velocity_before) continue;
      const auto off = [&](int k) {
        const Track& track = flights_.of(k);
        if (!track.state_known || event.time < track.start) return -1.0;
        return size(Vec(flights_.position_at(k, event.time) - event.body[body].position));
      };
      const int named = event.ball_at(body);
      const double own = off(named), speed = size(event.body[body].velocity_before);
      const double path = own >= 0 ? speed * (event.time - flights_.of(named).start) : 0;
      const double allowed = tolerances_.position(event.time, path, speed), radius = radius_of(named);
      // Balls that may be half a radius away are not told from each other.
      if (own <= radius / 100 + allowed || allowed > radius / 2) continue;
      for (int k = 0; k < flights_.balls(); ++k) {
        const double theirs = off(k);
        if (k == named || theirs < 0 || k == event.ball_at(1 - body) ||
            !vanishes(own, theirs,
                      tolerances_.position(event.time, speed * (event.time - flights_.of(k).start), speed)))
          continue;
        tell(Kind::wrong_partner, event, own, named, k, "the states are another ball's");
        (body == 0 ? event.ball : event.partner) = k;
        break;
      }
    }
  }

  /// Notes how late an event is that does not come before its bodies touch.
  void note_delay(const LoggedEvent& event, const Scene& scene, double depth) {
    if (!available_.velocities_before(event.with_wall)) return;
    const double closing = -scene.impact.g_n();
    if (closing > velocity_scale(scene.impact, false) / 10)
      delays_.add(event.with_wall ? event.partner : -1, std::max(depth, 0.0) / closing);
  }

  Touch judge_touch(LoggedEvent& event, Scene& scene) {
    const bool placed = available_.positions(event.with_wall);
    scene.impact = impact_of(event, case_, scene.nested, placed);
    if (!placed) return {};
    if (event.with_wall) return judge_wall_touch(event, scene);
    findings_.judged(Check::touch);
    const double gap = gap_of(event, case_, scene.nested);
    const bool late = gap < -tolerances_.gap;
    if (late) tell(Kind::late_event, event, -gap, gap, 0);
    if (gap > tolerances_.gap)
      tell(Kind::early_event, event, gap, gap, 0);
    else
      note_delay(event, scene, late ? -gap : 0);
    return {late, false, true};
  }

  Touch judge_wall_touch(LoggedEvent& event, Scene& scene) {
    const double radius = radius_of(event.ball), allowed = tolerances_.touch(event.time, true);
    ++with_wall_[event.partner];
    // A wall that may be half a radius away is not told from what is beside it.
    if (tolerances_.wall_places(event.time) > radius / 2) {
      findings_.unresolved(Check::touch);
      return {};
    }
    findings_.judged(Check::touch);
    const double gap = gap_of(event, case_, scene.nested);
    if (std::abs(gap) > allowed) return judge_off_the_wall(event, scene, gap, allowed);
    note_delay(event, scene, 0);
    if (rotations_.is_suspected() && std::abs(gap_of(event, case_, scene.printed)) > allowed)
      rotations_.contradicted();
    return {};
  }

  Touch judge_off_the_wall(LoggedEvent& event, Scene& scene, double gap, double allowed) {
    const auto& vessel = case_.mill.vessel;
    const double radius = radius_of(event.ball);
    const Vec& position = event.body[0].position;
    const double printed_gap = std::abs(gap_of(event, case_, scene.printed));
    const Finding off_the_wall{event, gap < 0 ? Kind::late_event : Kind::early_event, std::abs(gap), gap, 0};
    if (vanishes(std::abs(gap), printed_gap, allowed)) {
      rotations_.explains(std::abs(gap), printed_gap)
          .add({event, Kind::rotation_order, std::abs(gap), gap, 0, "touches with the printed matrix (2.14)",
                true});
      rotations_.plain().add(off_the_wall);
      flights_.set_printed_walls(rotations_.is_named());
      // The other checks use the wall as that code has it.
      scene.displaced = true;
      scene.impact.normal = wall_normal(scene.printed, vessel, event.partner, radius, position);
      scene.impact.set_wall_velocity(wall_velocities[0], scene.nested, scene.printed);
      return {gap < 0, true, true};
    }
    if (rotations_.is_suspected()) rotations_.contradicted();
    if (another_body_is_there(event, scene, allowed, std::abs(gap))) {
      if (!event.with_wall) return {false, false, false};  // the partner's state is not in the log
      scene.impact = impact_of(event, case_, scene.nested, true);
      return {};
    }
    findings_.add(off_the_wall);
    if (gap < 0) note_delay(event, scene, -gap);
    return {gap < 0, false, true};
  }

  /// Finds the body that is actually touched, `off` from the one that is logged; the other checks of the
  /// event use it.
  bool another_body_is_there(LoggedEvent& event, const Scene& scene, double allowed, double off) {
    const double radius = radius_of(event.ball);
    const Vec& position = event.body[0].position;
    if (!(off > radius / 100)) return false;
    for (int wall = 0; wall < static_cast<int>(with_wall_.size()); ++wall)
      if (wall != event.partner &&
          vanishes(off, std::abs(wall_gap(scene.nested, case_, wall, event.ball, position)), allowed)) {
        tell(Kind::wrong_partner, event, off, event.partner, wall, "another wall is touched");
        event.partner = wall;
        return true;
      }
    for (int k = 0; k < flights_.balls(); ++k) {
      if (k == event.ball || !flights_.of(k).state_known || event.time < flights_.of(k).start) continue;
      const Vec between = flights_.position_at(k, event.time) - position;
      const double apart = std::abs(size(between) - radius - radius_of(k));
      if (vanishes(off, apart, allowed)) {
        tell(Kind::wrong_partner, event, off, event.partner, k, "a ball is touched, and no wall");
        flights_.of(k) = Track{};
        event.with_wall = false;
        event.partner = k;
        return true;
      }
    }
    return false;
  }

  ImpactJudge impacts_;
  Flights flights_;
  StallHistory stalls_;
  std::vector<LastEvent> last_;
  std::vector<std::uint64_t> with_wall_;  ///< logged impacts with each, for the diagnosis
  DelaysByPartner delays_;                ///< how late each event is that is not a graze
  Suspicion rotations_;                   ///< the walls are those of the printed matrix
};

/// @param next  gives the events in order of time
template <class Next>
Audit audit_events(const model::Case<double>& the_case, const std::vector<model::BallState<double>>* states,
                   const Options& options, const std::string& file, const Available& available,
                   const Next& next) {
  Audit result;
  result.findings = Findings(options.examples);
  result.tolerances = tolerances_of(the_case, options);
  result.log_name = file;
  result.available = available;
  Auditor auditor(Judge{the_case, result.available, result.tolerances, result.findings});
  if (states)
    auditor.begin(*states, DriveClock<double>(the_case.mill.motion.period()).seconds(the_case.initial_time));
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
  result.energies = auditor.energies();
  result.undecided = auditor.flights().undecided();
  result.not_made = checks_not_made(result.findings, any_pairs);
  result.diagnoses = auditor.diagnoses();
  const auto& checked = result.findings;
  // A log most of whose contacts cannot be judged is not called clean.
  const bool judged = checked.judged_number(Check::touch) + checked.judged_number(Check::milling_dose) > 0 &&
                      checked.judged_number(Check::touch) >= checked.unresolved_number(Check::touch);
  result.verdict = result.findings.total() > 0 ? Verdict::violations
                   : judged                    ? Verdict::clean
                                               : Verdict::too_few;
  return result;
}

EventLog open_log(const model::Case<double>& the_case, const Options& options) {
  return {options.log, options.conventions, static_cast<int>(the_case.balls.size()),
          static_cast<int>(the_case.mill.vessel.walls().size()), 1e15 * the_case.mill.motion.period()};
}

}  // namespace

Options options_of(const casefile::CaseSpec& spec) {
  const auto& s = spec.audit;
  Options options;
  options.conventions.columns.assign(s.columns.begin(), s.columns.end());
  options.conventions.first_ball = static_cast<int>(s.first_ball.value_or(0));
  if (!s.walls.empty())
    options.conventions.walls =
        parse_walls(s.walls, casefile::partners_of(spec), spec.file + ": key 'audit.walls'");
  if (s.tolerance) options.tolerance = s.tolerance->to<double>();
  if (s.gap_tolerance) options.gap_tolerance = s.gap_tolerance->to<double>();
  options.from_start = s.from_start;
  return options;
}

std::string_view name_of(Verdict verdict) {
  static constexpr std::array<std::string_view, 3> names = {"clean", "violations", "too_few"};
  return names[static_cast<std::size_t>(verdict)];
}

Tolerances tolerances_of(const model::Case<double>& the_case, const Options& options) {
  Tolerances tolerances;
  tolerances.relative = options.tolerance;
  tolerances.reach = the_case.mill.motion.reach(the_case.mill.vessel.reach());
  tolerances.gravity = norm<double>(the_case.mill.gravity);
  tolerances.walls = WallRates::of(the_case.mill);
  tolerances.gap = options.gap_tolerance.value_or(options.tolerance * tolerances.reach);
  return tolerances;
}

Audit audit(const model::Case<double>& the_case, const std::vector<model::BallState<double>>& states,
            const Options& options) {
  EventLog log = open_log(the_case, options);
  return audit_events(the_case, options.from_start ? &states : nullptr, options, log.file(), log.available(),
                      [&] { return log.next(); });
}

EventsAtHand read_events(const model::Case<double>& the_case, const Options& options, std::size_t most) {
  EventLog log = open_log(the_case, options);
  EventsAtHand result{log.file(), log.available(), {}};
  for (std::optional<LoggedEvent> event; result.events.size() < most && (event = log.next());)
    result.events.push_back(*std::move(event));
  return result;
}

Audit audit(const model::Case<double>& the_case, const EventsAtHand& log, const Options& options) {
  std::size_t k = 0;
  return audit_events(the_case, nullptr, options, log.file, log.available,
                      [&] { return k < log.events.size() ? std::optional(log.events[k++]) : std::nullopt; });
}

}  // namespace edmill::audit
