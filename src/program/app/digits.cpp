#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <vector>

#include "app/certify.hpp"
#include "base/errors.hpp"
#include "casefile/precisions.hpp"
#include "run/watches.hpp"

namespace edmill::app {

namespace {

std::string chosen(double digits) {
  return fmt::format("mpfr:{}", static_cast<unsigned>(std::clamp(digits, 60.0, double{most_digits})));
}

/// Events to the end of the case: a run in double has about as many as the true motion.
double count_events(const casefile::CaseSpec& spec, const DigitsOptions& options) {
  constexpr double longest = 5;  // [s] of processor time
  const auto source = run::make_source("double", spec, true, options.interrupt);
  const double begin = run::cpu_seconds(), first = source->reached();
  double events = 0;
  while (!stop_asked(options.interrupt)) {
    const auto more = source->pass(1024);
    if (more == 0) return events;
    events += static_cast<double>(more);
    if (spec.end_time && run::cpu_seconds() - begin > longest)
      return events * (spec.end_time->to<double>() - first) / (source->reached() - first);
    options.progress("double", static_cast<std::size_t>(events), events);
  }
  return events;
}

std::string by_rule(const run::Event& event) {
  return fmt::format(
      "a rule and not the equations orders two contacts of ball {} at {} s: no number of digits decides it",
      event.ball, event.time.str(17));
}

/// Finds the decimal digits that an event costs, by two runs with many digits: up to where they are lost, or
/// where `enough` of them are.
void find_lost_digits(RunEstimate& e, double enough, const casefile::CaseSpec& spec,
                      const DigitsOptions& options) try {
  constexpr unsigned digits = 200;
  constexpr std::size_t most = 30000;
  SideBySide runs(spec, chosen(digits), chosen(wider_than(digits)), true, options.interrupt);
  const auto& agreement = runs.agreement();
  const auto lost = [&] {
    return runs.diverged() ? digits : std::max(0.0, digits - agreement.least_digits());
  };
  bool all = false;
  std::vector<double> times;
  while (!stop_asked(options.interrupt) && agreement.events() < most && lost() < enough) {
    const auto events = runs.next(256);
    all = events.empty() && !runs.diverged();
    if (events.empty()) break;
    for (const auto& event : events) {
      if (event.by_rule && e.undecided.empty()) e.undecided = by_rule(event);
      times.push_back(static_cast<double>(event.time));
    }
    options.progress(chosen(digits), agreement.events(), double{most});
  }
  const auto events = static_cast<double>(agreement.events());
  if (!(events > 0)) return;
  e.lost_per_event = lost() / events;
  if (e.precision == "double") return;
  // Few balls can rest longer, and hop more often, in the true motion than in double: it goes on as in the
  // later half of the time so far.
  const double first = times.front(), reached = times.back(), half = (first + reached) / 2;
  if (all) {
    e.events = events;
  } else if (spec.end_time && reached > first) {
    const double end = spec.end_time->to<double>();
    const auto later = times.end() - std::upper_bound(times.begin(), times.end(), half);
    const double rate = std::max(static_cast<double>(later) / (reached - half), e.events / (end - first));
    e.events = events + rate * std::max(0.0, end - reached);
  }
} catch (const UndecidedError& error) {
  e.undecided = error.what();
}

/// The part of an estimate that a run in right digits needs: how many.
RunEstimate estimate_digits(const casefile::CaseSpec& spec, const std::string& precision,
                            const DigitsOptions& options) {
  RunEstimate e;
  const std::clock_t begin = std::clock();
  e.precision = precision;
  e.events = count_events(spec, options);
  find_lost_digits(e, precision.empty() ? 200 : 40, spec, options);
  if (precision.empty()) {
    e.digits = *spec.digits;
    // A twentieth more, since events differ, and the first bits are lost at once.
    e.precision = chosen(static_cast<double>(e.digits) + 1.05 * e.lost_per_event * e.events + 15);
  }
  e.right_events = e.lost_per_event > 0 ? casefile::digits_of(e.precision) / e.lost_per_event : 1e300;
  e.trials = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  return e;
}

/// Processor time of an event [s], when the balls have begun to collide.
double time_per_event(const std::string& precision, const casefile::CaseSpec& spec,
                      const DigitsOptions& options) {
  constexpr double longest = 2;  // [s] of processor time
  const auto source = run::make_source(precision, spec, true, options.interrupt);
  double begin = run::cpu_seconds(), took = 0;
  std::size_t events = 0;
  bool warm = false;
  while (took < longest && !stop_asked(options.interrupt)) {
    const auto more = source->pass(64);
    if (more == 0) break;
    if (!warm) {
      warm = true;
      begin = run::cpu_seconds();
      continue;
    }
    events += more;
    took = run::cpu_seconds() - begin;
    options.progress(precision, events, static_cast<double>(events));
  }
  return events == 0 ? 0 : took / static_cast<double>(events);
}

/// Processor time of a run that drops the digits that it has lost, relative to one that keeps all: by
/// Simpson's rule.
double share_of_verifying(const RunEstimate& e, const casefile::CaseSpec& spec,
                          const DigitsOptions& options) {
  const double first = casefile::digits_of(e.precision), last = first - e.lost_per_event * e.events;
  const auto time_with = [&](double digits) { return time_per_event(chosen(digits), spec, options); };
  return (e.seconds_per_event + 4 * time_with((first + last) / 2) + time_with(last)) /
         (6 * e.seconds_per_event);
}

std::uint64_t most_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024 * static_cast<std::uint64_t>(usage.ru_maxrss);
}

std::string duration(double seconds) {
  if (seconds < 60) return fmt::format("{:.1f} s", seconds);
  if (seconds < 3600) return fmt::format("{:.1f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

}  // namespace

RunEstimate estimate_run(const casefile::CaseSpec& spec, const std::string& precision,
                         const DigitsOptions& options) try {
  RunEstimate e = estimate_digits(spec, precision, options);
  // A run in right digits is made in the wider of the two that agree.
  const auto made_in = precision.empty()
                           ? chosen(wider_than(static_cast<unsigned>(casefile::digits_of(e.precision))))
                           : precision;
  e.seconds_per_event = time_per_event(made_in, spec, options);
  if (precision.empty() && e.seconds_per_event > 0) e.verifying = 2 * share_of_verifying(e, spec, options);
  e.bytes = most_memory();
  e.outputs = !spec.outputs.empty();
  e.interrupted = stop_asked(options.interrupt);
  return e;
} catch (const InterruptedError&) {
  return {.interrupted = true};
}

std::string RunEstimate::text() const {
  std::string out;
  const auto row = [&](const char* name, const std::string& value) {
    out += fmt::format("{:<15} {}\n", name, value);
  };
  row("events", fmt::format("about {:.0f}", events));
  row("digits lost", fmt::format("{:.4f} per event", lost_per_event));
  if (digits > 0)
    row("precision", fmt::format("{}, for {} right digits at the end", precision, digits));
  else
    row("precision", precision + (right_events > events
                                      ? ", which lasts to the end"
                                      : fmt::format(", used up after about {:.0f} events", right_events)));
  row("processor time",
      duration(cpu_seconds()) + (verifying > 0 || outputs ? " for the run" : "") +
          (outputs ? " without its outputs" : "") +
          (verifying > 0 ? fmt::format(", and {} before it to find the digits and verify them",
                                       duration(trials + verifying * cpu_seconds()))
                         : ""));
  row("memory", fmt::format("{:.0f} MB", static_cast<double>(bytes) / 1e6));
  if (!undecided.empty()) row("undecided", undecided);
  return out;
}

double FoundDigits::left() const { return std::min(agreement.least_digits(), states); }

std::uint64_t FoundDigits::right() const {
  return static_cast<std::uint64_t>(std::min(left(), casefile::digits_of(narrow)));
}

std::string FoundDigits::text() const {
  return fmt::format("{} and {}: all {} events and the states at their end agree to {} digits ({:.1f} s)\n",
                     narrow, precision, agreement.events(), right(), seconds);
}

FoundDigits find_digits(const casefile::CaseSpec& spec, const DigitsOptions& options) try {
  const auto begin = std::chrono::steady_clock::now();
  FoundDigits found;
  const auto estimate = estimate_digits(spec, "", options);
  found.undecided = estimate.undecided;
  const double asked = static_cast<double>(*spec.digits);
  for (double digits = casefile::digits_of(estimate.precision);
       digits < most_digits && found.undecided.empty();) {
    found.narrow = chosen(digits);
    found.precision = chosen(wider_than(static_cast<unsigned>(digits)));
    SideBySide runs(spec, found.narrow, found.precision, true, options.interrupt);
    for (bool more = true; more && !(found.interrupted = stop_asked(options.interrupt));) {
      const auto events = runs.next(256);
      more = !events.empty();
      for (const auto& event : events)
        if (event.by_rule && found.undecided.empty()) found.undecided = by_rule(event);
      more = more && found.undecided.empty();
      options.progress(found.precision, runs.agreement().events(), estimate.events);
    }
    found.agreement = runs.agreement();
    found.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const bool all = !runs.diverged() && !runs.uneven();
    found.states = all ? runs.digits_of_states() : 0;
    const bool right = all && found.left() >= asked;
    if (right && found.undecided.empty()) return found;
    if (found.interrupted || !found.undecided.empty()) break;
    const double events = std::max(1.0, static_cast<double>(found.agreement.events()));
    const double lost = all ? digits - found.left() : digits * std::max(1.0, estimate.events / events);
    digits = std::max(1.2 * digits, asked + 1.05 * lost + 15);
  }
  if (!found.interrupted && found.undecided.empty())
    found.undecided = fmt::format("{} digits do not suffice", most_digits);
  found.precision.clear();
  return found;
} catch (const InterruptedError&) {
  return {.interrupted = true};
}

}  // namespace edmill::app
