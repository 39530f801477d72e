#include "app/certify.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <future>

#include "base/clean_text.hpp"
#include "base/errors.hpp"
#include "base/interruption.hpp"
#include "base/version.hpp"
#include "casefile/case_spec.hpp"
#include "io/input_file.hpp"
#include "io/output_folder.hpp"
#include "output/collision_log.hpp"
#include "prove/proof.hpp"
#include "run/any_run.hpp"

namespace edmill::app {

namespace {

/// Results of work(0) and work(1), which run concurrently. If both throw, that of the first counts.
auto of_both(const auto& work) {
  auto later = std::async(std::launch::async, work, 1);
  auto first = work(0);
  return std::array{std::move(first), later.get()};
}

/// Name of the `mpfr` scalar with this many digits.
std::string chosen(double digits) {
  return fmt::format(
      "mpfr:{}", static_cast<unsigned>(std::clamp(digits, 60.0, double{most_digits})));
}

using run::Event, run::Number;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Digits of the wider run that verifies a run with `digits`.
unsigned wider_than(unsigned digits) { return digits + std::max(20u, digits / 20); }

/// Estimates the number of events to the end of the case by a run in double; reports those so far.
double count_events(
    const casefile::CaseSpec& spec, const std::atomic<bool>* interrupt, const auto& progress) {
  constexpr double longest = 5;  // [s] of processor time
  const auto source = run::make_source("double", spec, true, interrupt);
  const double begin = run::cpu_seconds(), first = source->reached();
  double events = 0;
  for (;;) {
    const auto more = source->pass(1024);
    Interruption::check();
    if (more == 0) return events;
    events += static_cast<double>(more);
    if (spec.end_time && run::cpu_seconds() - begin > longest)
      return events * (spec.end_time->to<double>() - first) / (source->reached() - first);
    progress(events);
  }
}

std::string digits_text(double digits) {
  return digits >= Agreement::most ? "all" : fmt::format("{:.1f}", digits);
}

void write_reference(std::ostream& out, const casefile::CaseSpec& spec,
    const CertifyOptions& options, const Certification& found) {
  out << fmt::format(
      "# edmill certified events 1\n# case {}, digest {}\n# edmill {} ({}), {}\n# {} events, each "
      "value correct to {} digits of the quantity's largest size\n",
      one_line(std::filesystem::path(spec.file).filename().string()), spec.digest, version(),
      commit(), compiler(), found.events.size(), options.digits);
  for (const auto& pair : found.evidence) out << "# " << pair.text() << '\n';
  out << output::collision_log_header(false) << '\n';
  for (std::size_t k = 0; k < found.events.size(); ++k) {
    const Event& e = found.events[k];
    // Two digits more than are certified, so that the rounding of the text does not count.
    const auto text = [&](std::size_t q) { return e[q].str(options.digits + 3, true); };
    out << k << ',' << text(model::time) << ',' << e.ball << (e.with_wall ? ",wall," : ",ball,")
        << e.partner;
    for (std::size_t q = model::approach_speed; q < model::logged_count; ++q) out << ',' << text(q);
    out << '\n';
  }
}

std::string describe(const Event& e) {
  return fmt::format("ball {} and {} {} at {} s", e.ball, e.with_wall ? "wall" : "ball", e.partner,
      e.time.str(17));
}

/// Raises the precision until the sequence of events is certain, and collects the evidence.
class Certifier {
 public:
  Certifier(const casefile::CaseSpec& spec, const CertifyOptions& options)
      : spec_(spec), options_(options),
        expected_(options.collisions > 0
                ? static_cast<double>(options.collisions)
                : count_events(spec, options.interrupt, [&](double events) {
                    options.progress("double", static_cast<std::size_t>(events));
                  })) {}

  /// Compares pairs of fixed scalars, then of `mpfr` with the number of digits that the last pair
  /// suggests, and with more digits if these do not suffice.
  void run() {
    const auto& fixed = casefile::precisions();
    for (std::size_t k = 1; k < fixed.size(); ++k)
      if (side_by_side(fixed[k - 1], fixed[k])) return;
    for (int attempt = 0; attempt < 8; ++attempt) {
      const unsigned digits = digits_needed(), more = wider_than(digits);
      if (more > most_digits) {
        result.undecided = fmt::format("more than {} digits are needed", most_digits);
        return;
      }
      if (side_by_side(chosen(digits), chosen(more))) return;
    }
    result.undecided = "eight attempts with increasing numbers of digits do not agree";
  }

  Certification result;
 private:
  unsigned digits_needed() const {
    const auto& last = result.evidence.back();
    const double events = static_cast<double>(last.agreement.events());
    const double had = casefile::digits_of(last.narrow);
    const double left = events == expected_ ? last.agreement.least_digits() : 0;
    const double lost = std::max(had - left, 0.0) / std::max(events, 1.0);
    const double needed = options_.digits + 1.05 * lost * expected_ + 10;
    return static_cast<unsigned>(std::min<double>(std::max(needed, 1.2 * had), most_digits));
  }

  /// @return whether these two scalars settle the matter: the events are certain, or cannot be
  bool side_by_side(const std::string& narrow, const std::string& wide) {
    const auto begin = Clock::now();
    SideBySide runs(spec_, narrow, wide, options_.collisions == 0, options_.interrupt);
    std::vector<Event> events;
    // All digits of a long sequence would fill the memory: only those that are written are kept.
    const mpfr::Digits kept(static_cast<unsigned>(options_.digits) + 10);
    const std::size_t wanted = options_.collisions > 0 ? options_.collisions : SIZE_MAX;
    while (events.size() < wanted) {
      auto taken = runs.next(std::min<std::size_t>(256, wanted - events.size()));
      Interruption::check();
      if (taken.empty()) break;
      for (auto& event : taken) {
        for (std::size_t k = 0; k < model::logged_count; ++k) event[k] = event[k].rounded();
        events.push_back(std::move(event));
      }
      options_.progress(wide, events.size());
    }
    result.evidence.push_back({narrow, wide, runs.agreement(), seconds_since(begin)});
    options_.found(result.evidence.back());
    const bool all = !runs.diverged() && !runs.uneven();
    if (all) expected_ = static_cast<double>(events.size());
    if (all && events.size() < options_.collisions)
      throw InputError(fmt::format("{}: the case ends after {} collisions, {} are requested",
          spec_.file, events.size(), options_.collisions));
    const auto by_rule = std::find_if(
        events.begin(), events.end(), [](const Event& event) { return event.by_rule; });
    if (by_rule != events.end()) {
      result.undecided = fmt::format(
          "event {}, {}, has another contact of its ball at the same time in every scalar: a rule "
          "and not the equations orders them",
          by_rule - events.begin(), describe(*by_rule));
      return true;
    }
    if (!all || runs.agreement().least_digits() < options_.digits) return false;
    result.events = std::move(events);
    return true;
  }

  const casefile::CaseSpec& spec_;
  const CertifyOptions& options_;
  double expected_;  ///< number of events
};

}  // namespace

void Largest::take(const Number& one, const Number& two) {
  difference = std::max(difference, Number(abs(one - two)));
  size = std::max(size, Number(abs(two)));
}

double Largest::digits() const {
  constexpr double zero = 1e-20;  // [SI]
  if (!(difference > 0)) return Agreement::most;
  return -static_cast<double>(log10(size > zero ? Number(difference / size) : difference));
}

bool Agreement::take(const Event& one, const Event& two) {
  if (!one.same_bodies(two)) return false;
  for (std::size_t k = 0; k < model::logged_count; ++k) largest_[k].take(one[k], two[k]);
  if (const Number difference = abs(one.time - two.time); difference > 0)
    growth_.add(static_cast<double>(events_), static_cast<double>(log10(difference)));
  ++events_;
  bodies_ += one.with_wall ? 1 : 2;
  return true;
}

double Agreement::least_digits() const {
  double least = most;
  for (const auto& quantity : largest_) least = std::min(least, quantity.digits());
  return least;
}

std::optional<double> Agreement::digits_lost_per_event() const {
  return growth_.points() < 10 ? std::nullopt : std::optional(growth_.slope());
}

SideBySide::SideBySide(const casefile::CaseSpec& spec, const std::string& narrow,
    const std::string& wide, bool to_end, const std::atomic<bool>* interrupt)
    : interrupt_(interrupt), digits_{chosen_digits_of(narrow), chosen_digits_of(wide)},
      sources_(of_both([&](int k) {
        return run::make_source(k == 0 ? narrow : wide, spec, to_end, interrupt);
      })) {}

std::vector<run::Event> SideBySide::next(std::size_t count) {
  if (diverged_ || uneven_) return {};
  auto [one, two] = of_both([&](int k) { return sources_[k]->next(count); });
  if (interrupt_ && *interrupt_) return {};
  const std::size_t both = std::min(one.size(), two.size());
  std::size_t same = 0;
  while (same < both && agreement_.take(one[same], two[same])) ++same;
  if (same < both)
    diverged_ = {one[same], two[same]};
  else  // a wider scalar follows a collapse for some events more
    uneven_ =
        one.size() != two.size() && !sources_[0]->has_collapsed() && !sources_[1]->has_collapsed();
  two.resize(same);
  drop_lost_digits();
  return std::move(two);
}

void SideBySide::drop_lost_digits() {
  constexpr double kept = 20;          // beyond those that are right
  constexpr double least = 50;         // in which the engine is tested most
  constexpr unsigned worthwhile = 20;  // about one limb of MPFR
  if (digits_[0] == 0 || digits_[1] == 0 || diverged_ || uneven_) return;
  const double needed = std::max(agreement_.least_digits() + kept, least);
  if (digits_[0] - needed < dropped_ + std::max(worthwhile, digits_[0] / 32)) return;
  dropped_ = static_cast<unsigned>(digits_[0] - needed);
  of_both([&](int k) {
    sources_[k]->continue_in(digits_[k] - dropped_);
    return 0;
  });
}

double SideBySide::digits_of_states() const {
  const auto one = sources_[0]->states(), two = sources_[1]->states();
  std::array<Largest, 3> kinds;  // of three components each
  for (std::size_t k = 0; k < one.size(); ++k) kinds[k / 3 % kinds.size()].take(one[k], two[k]);
  double least = Agreement::most;
  for (const auto& kind : kinds) least = std::min(least, kind.digits());
  return least;
}

Certification certify(const casefile::CaseSpec& spec, const CertifyOptions& options) try {
  if (options.collisions == 0 && !spec.end_time)
    throw InputError(spec.file + ": no run.end_time: set it, or give --collisions");
  io::NamedFile file(options.file);
  const Interruption scope(options.interrupt);
  Certifier certifier(spec, options);
  certifier.run();
  auto result = std::move(certifier.result);
  if (!result.events.empty())
    file.write([&](std::ostream& out) { write_reference(out, spec, options, result); });
  return result;
} catch (const InterruptedError&) {
  return {.interrupted = true};
}

void require_wider(
    const std::string& precision, const std::string& wider, const std::string& what) {
  if (casefile::digits_of(wider) <= casefile::digits_of(precision))
    throw InputError(
        fmt::format("{}: found \"{}\", expected a scalar wider than {}", what, wider, precision));
}

Shadow shadow(const casefile::CaseSpec& spec, const std::string& precision,
    const std::string& wider, const std::atomic<bool>* interrupt) {
  SideBySide runs(spec, precision, wider, true, interrupt);
  while (!runs.next(64).empty()) {
  }
  return {{precision, wider, runs.agreement()}, runs.diverged(), runs.uneven(),
      interrupt && *interrupt, spec.ball_count()};
}

std::string Evidence::text() const {
  std::string line =
      fmt::format("{} and {}: {} events in common; digits:", narrow, wide, agreement.events());
  for (std::size_t k = 0; k < model::logged_count; ++k)
    line +=
        fmt::format(" {} {}", model::logged_quantities[k].name, digits_text(agreement.digits(k)));
  return line;
}

std::string Shadow::text() const {
  std::string out =
      fmt::format("Shadow run: {} and {}, {} events in common\n", wide, narrow, agreement.events());
  if (diverged)
    out += fmt::format("  they diverge at event {}: {} has {},\n  {} has {}\n", agreement.events(),
        narrow, describe(diverged->first), wide, describe(diverged->second));
  else
    out += fmt::format("  {}\n",
        uneven ? "one has one event more before the end" : "they do not diverge before the end");
  for (std::size_t k = 0; k < model::logged_count; ++k)
    out += fmt::format("  {:<16} agrees to {} digits\n", model::logged_quantities[k].name,
        digits_text(agreement.digits(k)));
  if (const auto lost = agreement.digits_lost_per_event()) {
    const double each = static_cast<double>(agreement.bodies()) / static_cast<double>(balls);
    out += fmt::format("  digits lost: {:.4f} per event, {:.2f} per collision of a ball\n", *lost,
        *lost * static_cast<double>(agreement.events()) / each);
  }
  return out;
}

namespace {

std::string by_rule(const run::Event& event) {
  return fmt::format(
      "a rule and not the equations orders two contacts of ball {} at {} s: no number of digits "
      "decides it",
      event.ball, event.time.str(17));
}

/// Measures the decimal digits lost per event in two runs, until all or `enough` are lost.
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
  while (agreement.events() < most && lost() < enough) {
    const auto events = runs.next(256);
    Interruption::check();
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
  // A few balls may rest longer, and hop more often, in the true motion than in double:
  // extrapolates with the event rate in the later half of the time so far.
  const double first = times.front(), reached = times.back(), half = (first + reached) / 2;
  if (all) {
    e.events = events;
  } else if (spec.end_time && reached > first) {
    const double end = spec.end_time->to<double>();
    const auto later = times.end() - std::upper_bound(times.begin(), times.end(), half);
    const double rate =
        std::max(static_cast<double>(later) / (reached - half), e.events / (end - first));
    e.events = events + rate * std::max(0.0, end - reached);
  }
} catch (const UndecidedError& error) {
  e.undecided = error.what();
}

/// Estimates the number of events, and the number of digits that a run needs for them.
RunEstimate estimate_digits(
    const casefile::CaseSpec& spec, const std::string& precision, const DigitsOptions& options) {
  RunEstimate e;
  const std::clock_t begin = std::clock();
  e.precision = precision;
  e.events = count_events(spec, options.interrupt,
      [&](double events) { options.progress("double", static_cast<std::size_t>(events), events); });
  find_lost_digits(e, precision.empty() ? 200 : 40, spec, options);
  if (precision.empty()) {
    e.digits = *spec.digits;
    // A twentieth more, since events differ, and the first bits are lost at once.
    e.precision = chosen(static_cast<double>(e.digits) + 1.05 * e.lost_per_event * e.events + 15);
  }
  e.right_events =
      e.lost_per_event > 0 ? casefile::digits_of(e.precision) / e.lost_per_event : 1e300;
  e.trials = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  return e;
}

/// Processor time of an event [s], when the balls have begun to collide.
double time_per_event(
    const std::string& precision, const casefile::CaseSpec& spec, const DigitsOptions& options) {
  constexpr double longest = 2;  // [s] of processor time
  const auto source = run::make_source(precision, spec, true, options.interrupt);
  source->pass(64);
  const double begin = run::cpu_seconds();
  double took = 0;
  std::size_t events = 0;
  while (took < longest) {
    const auto more = source->pass(64);
    Interruption::check();
    if (more == 0) break;
    events += more;
    took = run::cpu_seconds() - begin;
    options.progress(precision, events, static_cast<double>(events));
  }
  return events == 0 ? 0 : took / static_cast<double>(events);
}

/// Processor time of a run that drops lost digits over one that keeps all, by Simpson's rule.
double share_of_verifying(
    const RunEstimate& e, const casefile::CaseSpec& spec, const DigitsOptions& options) {
  const double first = casefile::digits_of(e.precision), last = first - e.lost_per_event * e.events;
  const auto time_with = [&](double n) { return time_per_event(chosen(n), spec, options); };
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
  const Interruption scope(options.interrupt);
  RunEstimate e = estimate_digits(spec, precision, options);
  // A run with a required number of digits uses the wider of the two scalars that agree.
  const auto made_in = precision.empty()
      ? chosen(wider_than(static_cast<unsigned>(casefile::digits_of(e.precision))))
      : precision;
  e.seconds_per_event = time_per_event(made_in, spec, options);
  if (precision.empty() && e.seconds_per_event > 0)
    e.verifying = 2 * share_of_verifying(e, spec, options);
  e.bytes = most_memory();
  e.outputs = !spec.outputs.empty();
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
  row("precision",
      precision +
          (digits > 0 ? fmt::format(", for {} right digits at the end", digits)
                  : right_events > events
                  ? ", which lasts to the end"
                  : fmt::format(", used up after about {:.0f} events", right_events)));
  const auto* of_run = outputs ? " for the run without its outputs"
      : verifying > 0          ? " for the run"
                               : "";
  row("processor time",
      duration(cpu_seconds()) + of_run +
          (verifying > 0 ? fmt::format(", and {} before it to find the digits and verify them",
                               duration(trials + verifying * cpu_seconds()))
                         : ""));
  row("memory", fmt::format("{:.0f} MB", static_cast<double>(bytes) / 1e6));
  if (!undecided.empty()) row("undecided", undecided);
  return out;
}

std::uint64_t FoundDigits::right() const {
  return static_cast<std::uint64_t>(std::min(left(), casefile::digits_of(narrow)));
}

std::string FoundDigits::text() const {
  return fmt::format(
      "{} and {}: all {} events and the states at their end agree to {} digits ({:.1f} s)\n",
      narrow, precision, agreement.events(), right(), seconds);
}

FoundDigits find_digits(const casefile::CaseSpec& spec, const DigitsOptions& options) try {
  const Interruption scope(options.interrupt);
  const auto begin = Clock::now();
  FoundDigits found;
  const auto estimate = estimate_digits(spec, "", options);
  found.undecided = estimate.undecided;
  const double asked = static_cast<double>(*spec.digits);
  for (double digits = casefile::digits_of(estimate.precision);
       digits < most_digits && found.undecided.empty();) {
    found.narrow = chosen(digits);
    found.precision = chosen(wider_than(static_cast<unsigned>(digits)));
    SideBySide runs(spec, found.narrow, found.precision, true, options.interrupt);
    for (bool more = true; more;) {
      const auto events = runs.next(256);
      Interruption::check();
      for (const auto& event : events)
        if (event.by_rule && found.undecided.empty()) found.undecided = by_rule(event);
      more = !events.empty() && found.undecided.empty();
      options.progress(found.precision, runs.agreement().events(), estimate.events);
    }
    found.agreement = runs.agreement();
    found.seconds = seconds_since(begin);
    const bool all = !runs.diverged() && !runs.uneven();
    found.states = all ? runs.digits_of_states() : 0;
    if (!found.undecided.empty()) break;
    if (all && found.left() >= asked) return found;
    const double events = std::max(1.0, static_cast<double>(found.agreement.events()));
    const double lost =
        all ? digits - found.left() : digits * std::max(1.0, estimate.events / events);
    digits = std::max(1.2 * digits, asked + 1.05 * lost + 15);
  }
  if (found.undecided.empty())
    found.undecided = fmt::format("{} digits do not suffice", most_digits);
  found.precision.clear();
  return found;
} catch (const InterruptedError&) {
  return {.interrupted = true};
}

std::size_t right_events(
    const std::string& precision, const casefile::CaseSpec& spec, const prove::Proof& proof) {
  const auto source = run::make_source(precision, spec, false);
  std::size_t right = 0;
  while (right < proof.events.size()) {
    const auto more = source->next(std::min<std::size_t>(256, proof.events.size() - right));
    if (more.empty()) return right;
    for (const auto& event : more) {
      const auto& proven = proof.events[right];
      if (event.ball != proven.ball || event.with_wall != proven.with_wall ||
          event.partner != proven.partner)
        return right;
      ++right;
    }
  }
  return right;
}

prove::Proof prove(const casefile::CaseSpec& spec, const ProveOptions& options) {
  io::NamedFile events(options.file), certificate(options.certificate);
  auto proof = prove::prove(spec, options);
  if (proof.interrupted || !proof.impossible.empty()) return proof;
  events.write([&](auto& out) { prove::write_events(out, proof, 27); });
  certificate.write([&](auto& out) { prove::write_certificate(out, proof); });
  return proof;
}

std::vector<std::string> check_certificate(
    const casefile::CaseSpec& spec, const std::string& certificate) {
  io::InputFile file(certificate, "a certificate");
  return prove::other_case(file, certificate, prove::exact_case(spec));
}

}  // namespace edmill::app
