#include "app/certify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "base/errors.hpp"
#include "base/version.hpp"
#include "base/with_scalar.hpp"
#include "instances/instances.hpp"
#include "io/named_file.hpp"
#include "run/collision_log.hpp"

namespace edmill::app {

namespace {

using run::Agreement;
using run::Event;
using run::Number;
using run::Quantity;

bool stop_asked(const std::atomic<bool>* interrupt) {
  return interrupt && interrupt->load(std::memory_order_relaxed);
}

/// The first events of a case in one scalar, and how long they took.
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
  while (sequence.events.size() < options.collisions && !stop_asked(options.interrupt)) {
    const auto more = source->next(std::min<std::size_t>(64, options.collisions - sequence.events.size()));
    if (more.empty()) break;
    sequence.events.insert(sequence.events.end(), more.begin(), more.end());
    options.progress(precision, sequence.events.size());
  }
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

void write_reference(std::ostream& out, const casefile::CaseSpec& spec, const CertifyOptions& options,
                     const Certification& found) {
  out << "# edmill certified events 1\n"
      << fmt::format("# case {}, digest {}\n", std::filesystem::path(spec.file).filename().string(),
                     spec.digest)
      << fmt::format("# edmill {} ({}), {}\n", version(), commit(), compiler())
      << fmt::format("# {} events, each value correct to {} digits of the quantity's largest size\n",
                     found.events.size(), options.digits);
  for (const auto& pair : found.evidence) out << "# " << pair.text() << '\n';
  out << run::collision_log_header << '\n';
  for (std::size_t k = 0; k < found.events.size(); ++k) {
    const Event& e = found.events[k];
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

std::string Evidence::text() const {
  std::string line = fmt::format("{} and {}: {} events in common; digits:", narrow, wide, agreement.events());
  for (int k = 0; k < run::quantity_count; ++k)
    line += fmt::format(" {} {}", name_of(static_cast<Quantity>(k)),
                        digits_text(agreement.digits(static_cast<Quantity>(k))));
  return line;
}

std::unique_ptr<run::EventSource> source_in(const std::string& precision, const casefile::CaseSpec& spec,
                                            bool to_end) {
  return with_scalar(precision, [&]<class Real>() { return run::make_source<Real>(spec, to_end); });
}

Certification certify(const casefile::CaseSpec& spec, const CertifyOptions& options,
                      const std::function<void(const Evidence&)>& found) {
  const auto& precisions = casefile::precisions();
  std::optional<io::NamedFile> file;
  if (!options.file.empty()) file.emplace(options.file);
  Certification result;
  Sequence narrow = first_events(precisions.front(), spec, options);
  for (std::size_t k = 1; k < precisions.size(); ++k) {
    Sequence wide = first_events(precisions[k], spec, options);
    result.interrupted = stop_asked(options.interrupt);
    if (result.interrupted) return result;
    const Agreement agreement = compare(narrow, wide);
    result.evidence.push_back({narrow.precision, wide.precision, agreement, narrow.seconds + wide.seconds});
    found(result.evidence.back());
    if (wide.events.size() < options.collisions)
      throw InputError(fmt::format("{}: the case ends after {} collisions, {} are requested", spec.file,
                                   wide.events.size(), options.collisions));
    const auto by_rule = std::find_if(wide.events.begin(), wide.events.end(),
                                      [](const Event& event) { return event.by_rule; });
    if (by_rule != wide.events.end()) {
      result.undecided = fmt::format(
          "event {}, {}, has another contact of its ball at the same time in every scalar: a rule and not "
          "the "
          "equations orders them",
          by_rule - wide.events.begin(), describe(*by_rule));
      return result;
    }
    if (agreement.events() == options.collisions && agreement.least_digits() >= options.digits) {
      result.events = std::move(wide.events);
      if (file) file->write([&](std::ostream& out) { write_reference(out, spec, options, result); });
      return result;
    }
    narrow = std::move(wide);
  }
  result.undecided = fmt::format("the widest two scalars do not agree on {} events in {} digits",
                                 options.collisions, options.digits);
  return result;
}

void require_wider(const std::string& precision, const std::string& wider, const std::string& what) {
  const auto& all = casefile::precisions();
  const auto rank = [&](const std::string& name) {
    return std::find(all.begin(), all.end(), name) - all.begin();
  };
  if (rank(wider) <= rank(precision))
    throw InputError(
        fmt::format("{}: found \"{}\", expected a scalar wider than {}", what, wider, precision));
}

Shadow shadow(const casefile::CaseSpec& spec, const std::string& precision, const std::string& wider,
              const std::atomic<bool>* interrupt) {
  const auto narrow = source_in(precision, spec, true), wide = source_in(wider, spec, true);
  Shadow s{precision, wider, {}, {}, false, false, spec.ball_count()};
  while (!s.diverged && !s.uneven && !stop_asked(interrupt)) {
    const auto one = narrow->next(64), two = wide->next(64);
    if (one.empty() && two.empty()) break;
    const std::size_t count = std::min(one.size(), two.size());
    for (std::size_t k = 0; k < count && !s.diverged; ++k)
      if (!s.agreement.take(one[k], two[k])) s.diverged = {one[k], two[k]};
    s.uneven = !s.diverged && one.size() != two.size();
  }
  s.interrupted = stop_asked(interrupt);
  return s;
}

std::string Shadow::text() const {
  std::string out =
      fmt::format("Shadow run: {} and {}, {} events in common\n", wide, narrow, agreement.events());
  if (diverged)
    out += fmt::format("  they diverge at event {}: {} has {},\n  {} has {}\n", agreement.events(), narrow,
                       describe(diverged->first), wide, describe(diverged->second));
  else
    out += fmt::format(
        "  {}\n", uneven ? "one has one event more before the end" : "they do not diverge before the end");
  for (int k = 0; k < run::quantity_count; ++k)
    out += fmt::format("  {:<16} agrees to {} digits\n", name_of(static_cast<Quantity>(k)),
                       digits_text(agreement.digits(static_cast<Quantity>(k))));
  if (const auto lost = agreement.digits_lost_per_event()) {
    const double each = static_cast<double>(agreement.bodies()) / static_cast<double>(balls);
    out += fmt::format("  digits lost: {:.4f} per event, {:.2f} per collision of a ball\n", *lost,
                       *lost * static_cast<double>(agreement.events()) / each);
  }
  return out;
}

}  // namespace edmill::app
