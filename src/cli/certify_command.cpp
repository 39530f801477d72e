#include "cli/certify_command.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "base/errors.hpp"
#include "base/version.hpp"
#include "cli/run_case.hpp"
#include "instances/instances.hpp"
#include "io/named_file.hpp"
#include "io/terminal.hpp"
#include "run/agreement.hpp"
#include "run/collision_log.hpp"

namespace edmill::cli {

namespace {

using run::Agreement;
using run::Event;
using run::Number;
using run::Quantity;

bool stop_asked(const std::atomic<bool>* interrupt) {
  return interrupt && interrupt->load(std::memory_order_relaxed);
}

/// The first events of a case in one scalar, and their CPU time.
struct Sequence {
  std::string precision;
  std::vector<Event> events;
  double seconds = 0;
};

Sequence first_events(const std::string& precision, const casefile::CaseSpec& spec,
                      const CertifyOptions& options) {
  Sequence sequence{precision, {}, 0};
  const auto begin = std::chrono::steady_clock::now();
  const auto source = source_in(precision, spec, false);
  const bool show = !options.quiet && ::isatty(STDERR_FILENO);
  while (sequence.events.size() < options.collisions && !stop_asked(options.interrupt)) {
    const auto more = source->next(std::min<std::size_t>(64, options.collisions - sequence.events.size()));
    if (more.empty()) break;
    sequence.events.insert(sequence.events.end(), more.begin(), more.end());
    if (show) io::tell("\r{}: {} of {} events ", precision, sequence.events.size(), options.collisions);
  }
  if (show) io::tell("\r\x1b[K");
  sequence.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return sequence;
}

Agreement compare(const Sequence& one, const Sequence& two) {
  Agreement agreement;
  const std::size_t count = std::min(one.events.size(), two.events.size());
  while (agreement.events() < count &&
         agreement.take(one.events[agreement.events()], two.events[agreement.events()])) {
  }
  return agreement;
}

std::string digits_text(double digits) {
  return digits >= Agreement::most ? "all" : fmt::format("{:.1f}", digits);
}

std::string evidence_line(const Sequence& one, const Sequence& two, const Agreement& agreement) {
  std::string line = fmt::format("{} and {}: {} events in common; digits:", one.precision, two.precision,
                                 agreement.events());
  for (int k = 0; k < run::quantity_count; ++k)
    line += fmt::format(" {} {}", name_of(static_cast<Quantity>(k)),
                        digits_text(agreement.digits(static_cast<Quantity>(k))));
  return line;
}

void write_reference(std::ostream& out, const casefile::CaseSpec& spec, const CertifyOptions& options,
                     const Sequence& sequence, const std::vector<std::string>& evidence) {
  out << "# edmill certified events 1\n"
      << fmt::format("# case {}, digest {}\n", std::filesystem::path(spec.file).filename().string(),
                     spec.digest)
      << fmt::format("# edmill {} ({}), {}\n", version(), commit(), compiler())
      << fmt::format("# {} events, each value correct to {} digits of the quantity's largest size\n",
                     sequence.events.size(), options.digits);
  for (const auto& line : evidence) out << "# " << line << '\n';
  out << run::collision_log_header << '\n';
  for (std::size_t k = 0; k < sequence.events.size(); ++k) {
    const Event& e = sequence.events[k];
    // Two digits more than are certified, so that the rounding of the text does not count.
    const auto text = [&](int q) { return e.values[q].str(options.digits + 2, std::ios_base::scientific); };
    out << k << ',' << text(run::time) << ',' << e.ball << (e.with_wall ? ",wall," : ",ball,") << e.partner;
    for (int q = run::approach_speed; q < run::quantity_count; ++q) out << ',' << text(q);
    out << '\n';
  }
}

std::string describe(const Event& e) {
  return fmt::format("ball {} and {} {} at {} s", e.ball, e.with_wall ? "wall" : "ball", e.partner,
                     e.values[run::time].str(17));
}

}  // namespace

std::unique_ptr<run::EventSource> source_in(const std::string& precision, const casefile::CaseSpec& spec,
                                            bool to_end) {
#define EDMILL_SOURCE_IN(Real) \
  if (precision == ScalarName<Real>::value) return run::make_source<Real>(spec, to_end);
  EDMILL_FOR_EACH_SCALAR(EDMILL_SOURCE_IN)
#undef EDMILL_SOURCE_IN
  throw ContractError("no scalar named " + precision);
}

int run_certify(const casefile::CaseSpec& spec, const CertifyOptions& options) {
  const auto& precisions = casefile::precisions();
  io::NamedFile file(options.file);
  std::vector<std::string> evidence;
  Sequence narrow = first_events(precisions.front(), spec, options);
  for (std::size_t k = 1; k < precisions.size(); ++k) {
    Sequence wide = first_events(precisions[k], spec, options);
    if (stop_asked(options.interrupt)) return ok;
    const Agreement agreement = compare(narrow, wide);
    evidence.push_back(evidence_line(narrow, wide, agreement));
    if (!options.quiet) io::print("{} ({:.1f} s)\n", evidence.back(), narrow.seconds + wide.seconds);
    if (wide.events.size() < options.collisions)
      throw InputError(fmt::format("{}: the case ends after {} collisions, {} are requested", spec.file,
                                   wide.events.size(), options.collisions));
    const auto by_rule = std::find_if(wide.events.begin(), wide.events.end(),
                                      [](const Event& event) { return event.by_rule; });
    if (by_rule != wide.events.end()) {
      io::tell(
          "edmill: event {}, {}, has another contact of its ball at the same time in every scalar: a rule "
          "and not the equations orders them; nothing is written\n",
          by_rule - wide.events.begin(), describe(*by_rule));
      return undecided;
    }
    if (agreement.events() == options.collisions && agreement.least_digits() >= options.digits) {
      file.write([&](std::ostream& out) { write_reference(out, spec, options, wide, evidence); });
      if (!options.quiet) io::print("certified: {}\n", options.file);
      return ok;
    }
    narrow = std::move(wide);
  }
  io::tell("edmill: the widest two scalars do not agree on {} events in {} digits; nothing is written\n",
           options.collisions, options.digits);
  return undecided;
}

void check_shadow(const std::string& precision, const std::string& shadow) {
  const auto& all = casefile::precisions();
  const auto rank = [&](const std::string& name) {
    return std::find(all.begin(), all.end(), name) - all.begin();
  };
  if (rank(shadow) <= rank(precision))
    throw InputError(
        fmt::format("option '--shadow': found \"{}\", expected a scalar wider than {}", shadow, precision));
}

int run_shadow(const casefile::CaseSpec& spec, const std::string& precision, const std::string& shadow,
               const std::atomic<bool>* interrupt) {
  const auto narrow = source_in(precision, spec, true), wide = source_in(shadow, spec, true);
  Agreement agreement;
  std::optional<std::pair<Event, Event>> diverged;
  bool uneven = false;
  while (!diverged && !uneven && !stop_asked(interrupt)) {
    const auto one = narrow->next(64), two = wide->next(64);
    if (one.empty() && two.empty()) break;
    const std::size_t count = std::min(one.size(), two.size());
    for (std::size_t k = 0; k < count && !diverged; ++k)
      if (!agreement.take(one[k], two[k])) diverged = {one[k], two[k]};
    uneven = !diverged && one.size() != two.size();
  }
  io::print("Shadow run: {} and {}, {} events in common\n", shadow, precision, agreement.events());
  if (diverged)
    io::print("  they diverge at event {}: {} has {},\n  {} has {}\n", agreement.events(), precision,
              describe(diverged->first), shadow, describe(diverged->second));
  else
    io::print("  {}\n",
              uneven ? "one has one event more before the end" : "they do not diverge before the end");
  for (int k = 0; k < run::quantity_count; ++k)
    io::print("  {:<16} agrees to {} digits\n", name_of(static_cast<Quantity>(k)),
              digits_text(agreement.digits(static_cast<Quantity>(k))));
  if (const auto lost = agreement.digits_lost_per_event()) {
    const double each = static_cast<double>(agreement.bodies()) / static_cast<double>(spec.ball_count());
    io::print("  digits lost: {:.4f} per event, {:.2f} per collision of a ball\n", *lost,
              *lost * static_cast<double>(agreement.events()) / each);
  }
  return ok;
}

}  // namespace edmill::cli
