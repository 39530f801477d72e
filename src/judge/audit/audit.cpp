#include "audit/audit.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "audit/auditor.hpp"
#include "base/instant.hpp"

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

/// What a log looks like: printed errors of the thesis, or finite steps.
std::vector<Diagnosis> diagnose(const Auditor& auditor, const Findings& findings,
                                const model::Partners& partners) {
  std::vector<Diagnosis> found;
  const auto add = [&](const char* name, std::uint64_t events, std::uint64_t of, const std::string& text) {
    if (accounts_for(events, of)) found.push_back({name, text, events, of});
  };
  const auto count = [&](Kind kind) { return findings.of(kind).count; };
  const auto late = count(Kind::late_event), early = count(Kind::early_event);
  add("rotation_order", count(Kind::rotation_order), count(Kind::rotation_order) + late + early,
      "printed error (2.14): the vessel is rotated by R_x(gamma) R_z(theta); with that matrix the bodies "
      "touch. The rotations are nested: R_z(theta) R_x(gamma)");
  const auto& sign = findings.of(Kind::tangential_sign);
  add("tangential_sign", noted(sign, "(2.34)"), sign.count,
      "printed error (2.34), (A.72): the tangential term of the velocity has the wrong sign; with the "
      "printed sign the velocities are exactly those of the log");
  const auto& unequal = findings.of(Kind::unequal_balls);
  add("unequal_mass_factor", noted(unequal, "(2.24)"), unequal.count,
      "printed error (2.24): 1 + 1/J instead of 1 + M/(m_i J_i) + M/(m_j J_j); with it the outcome is "
      "exactly that of the log");
  // Other vessels have no such equation.
  if (partners[0].label == "cap -y" && auditor.with_wall()[0] == 0 && late + early == 0)
    add("gap_sign", auditor.flights().flown_through()[0], count(Kind::missed_event),
        "printed error (2.19), (2.20): no impact with the cap at -y is logged, and balls fly through it; y - "
        "R - h/2 is negative everywhere in the vessel, the gap is h/2 + y - R");
  if (const double step = auditor.delays().step(); step > 0 && early == 0)
    add("time_step", late, late,
        fmt::format(
            "finite steps: contacts are seen late by times that are spread evenly from 0 to {:.2g} s, "
            "alike with all walls and balls; a gap tolerance of {:.2g} m (--gap-tolerance) accepts them "
            "and leaves any other violation",
            step, 1.1 * findings.of(Kind::late_event).worst));
  return found;
}

}  // namespace

Options options_of(const casefile::CaseSpec& spec) {
  const auto& s = spec.audit;
  Options options;
  options.conventions.columns = s.columns;
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

namespace {

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
  const auto partners = model::partners_of(the_case.mill.vessel);
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
  result.diagnoses = diagnose(auditor, result.findings, partners);
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
  while (result.events.size() < most) {
    auto event = log.next();
    if (!event) break;
    result.events.push_back(*std::move(event));
  }
  return result;
}

Audit audit(const model::Case<double>& the_case, const EventsAtHand& log, const Options& options) {
  std::size_t k = 0;
  return audit_events(the_case, nullptr, options, log.file, log.available,
                      [&] { return k < log.events.size() ? std::optional(log.events[k++]) : std::nullopt; });
}

}  // namespace edmill::audit
