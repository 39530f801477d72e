#include "app/certify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <future>

#include "base/clean_text.hpp"
#include "base/errors.hpp"
#include "base/version.hpp"
#include "casefile/precisions.hpp"
#include "io/input_file.hpp"
#include "io/output_folder.hpp"
#include "output/collision_log.hpp"
#include "prove/proof.hpp"

namespace edmill::app {

namespace {

/// What work(0) and work(1), done at a time, give. The second one's failure counts only where the first one
/// has none.
auto of_both(const auto& work) {
  auto later = std::async(std::launch::async, work, 1);
  auto first = work(0);
  return std::array{std::move(first), later.get()};
}

using run::Agreement;
using run::Event;
using run::Number;

/// The first events of a case in one scalar, and how long they took.
struct Sequence {
  std::string precision;
  std::vector<Event> events;
  double seconds = 0;
  bool collapsed = false;  ///< the run has ended in inelastic collapse
};

Sequence first_events(const std::string& precision, const casefile::CaseSpec& spec,
                      const CertifyOptions& options) {
  Sequence sequence{precision, {}};
  const auto begin = std::chrono::steady_clock::now();
  const bool to_end = options.collisions == 0;
  const auto source = run::make_source(precision, spec, to_end, options.interrupt);
  while ((to_end || sequence.events.size() < options.collisions) && !stop_asked(options.interrupt)) {
    const auto more =
        source->next(to_end ? 64 : std::min<std::size_t>(64, options.collisions - sequence.events.size()));
    if (more.empty()) break;
    sequence.events.insert(sequence.events.end(), more.begin(), more.end());
    options.progress(precision, sequence.events.size());
  }
  sequence.collapsed = source->has_collapsed();
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
      << fmt::format("# case {}, digest {}\n", one_line(std::filesystem::path(spec.file).filename().string()),
                     spec.digest)
      << fmt::format("# edmill {} ({}), {}\n", version(), commit(), compiler())
      << fmt::format("# {} events, each value correct to {} digits of the quantity's largest size\n",
                     found.events.size(), options.digits);
  for (const auto& pair : found.evidence) out << "# " << pair.text() << '\n';
  out << output::collision_log_header(false) << '\n';
  for (std::size_t k = 0; k < found.events.size(); ++k) {
    const Event& e = found.events[k];
    // Two digits more than are certified, so that the rounding of the text does not count.
    const auto text = [&](std::size_t q) { return e[q].str(options.digits + 3, true); };
    out << k << ',' << text(model::time) << ',' << e.ball << (e.with_wall ? ",wall," : ",ball,") << e.partner;
    for (std::size_t q = model::approach_speed; q < model::logged_count; ++q) out << ',' << text(q);
    out << '\n';
  }
}

std::string describe(const Event& e) {
  return fmt::format("ball {} and {} {} at {} s", e.ball, e.with_wall ? "wall" : "ball", e.partner,
                     e.time.str(17));
}

/// What is found on the way to a certain sequence.
class Certifier {
 public:
  Certifier(const casefile::CaseSpec& spec, const CertifyOptions& options) : spec_(spec), options_(options) {}

  /// @return whether the matter is settled: certain, impossible, or interrupted
  bool by_fixed_scalars() {
    const auto& precisions = casefile::precisions();
    Sequence narrow = first_events(precisions.front(), spec_, options_);
    for (std::size_t k = 1; k < precisions.size(); ++k) {
      Sequence wide = first_events(precisions[k], spec_, options_);
      if (is_interrupted()) return true;
      const Agreement agreement = compare(narrow, wide);
      tell({narrow.precision, wide.precision, agreement, narrow.seconds + wide.seconds});
      // A wider scalar follows a collapse for some events more.
      const bool collapsed = narrow.collapsed || wide.collapsed;
      auto events = wide.events;
      if (collapsed) events.resize(std::min(narrow.events.size(), events.size()));
      const bool all =
          agreement.events() == events.size() && (collapsed || narrow.events.size() == events.size());
      expected_ = events.size();
      if (settles(all, agreement, events)) return true;
      narrow = std::move(wide);
    }
    return false;
  }

  /// With as many digits as the last two scalars lead to expect, and more where these do not suffice.
  void by_chosen_digits() {
    for (int attempt = 0; attempt < 8; ++attempt) {
      const unsigned digits = digits_needed(), more = wider_than(digits);
      if (more > most_digits) {
        result.undecided = fmt::format("more than {} digits are needed", most_digits);
        return;
      }
      if (side_by_side(digits, more)) return;
    }
    result.undecided = "eight attempts with more and more digits do not agree";
  }

  Certification result;

 private:
  bool is_interrupted() { return result.interrupted = stop_asked(options_.interrupt); }
  void tell(Evidence evidence) {
    result.evidence.push_back(std::move(evidence));
    options_.found(result.evidence.back());
  }

  unsigned digits_needed() const {
    const auto& last = result.evidence.back();
    const double events = static_cast<double>(last.agreement.events());
    const double had = casefile::digits_of(last.narrow);
    const bool all = last.agreement.events() == expected_;
    const double left = all ? last.agreement.least_digits() : 0;
    const double lost = std::max(had - left, 0.0) / std::max(events, 1.0);
    const double needed = options_.digits + 1.05 * lost * static_cast<double>(expected_) + 10;
    return static_cast<unsigned>(std::min<double>(std::max(needed, 1.2 * had), most_digits));
  }

  bool side_by_side(unsigned digits, unsigned more) {
    const auto name = [](unsigned n) { return fmt::format("mpfr:{}", n); };
    const auto begin = std::chrono::steady_clock::now();
    SideBySide runs(spec_, name(digits), name(more), options_.collisions == 0, options_.interrupt);
    std::vector<Event> events;
    // The sequence is written with so many; each number of a long one with all its digits would fill the
    // memory.
    const mpfr::Digits kept(static_cast<unsigned>(options_.digits) + 10);
    while (options_.collisions == 0 || events.size() < options_.collisions) {
      if (is_interrupted()) return true;
      const std::size_t left = options_.collisions == 0 ? 256 : options_.collisions - events.size();
      auto taken = runs.next(std::min<std::size_t>(256, left));
      if (taken.empty()) break;
      for (auto& event : taken) {
        for (std::size_t k = 0; k < model::logged_count; ++k) event[k] = event[k].rounded();
        events.push_back(std::move(event));
      }
      options_.progress(name(more), events.size());
    }
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    tell({name(digits), name(more), runs.agreement(), took.count()});
    const bool all = !runs.diverged() && !runs.uneven();
    if (all) expected_ = events.size();
    return settles(all, runs.agreement(), events);
  }

  /// Whether two runs with these events in common, all of them or not, settle the matter; then takes them.
  bool settles(bool all, const Agreement& agreement, std::vector<Event>& events) {
    if (all && events.size() < options_.collisions)
      throw InputError(fmt::format("{}: the case ends after {} collisions, {} are requested", spec_.file,
                                   events.size(), options_.collisions));
    const auto by_rule =
        std::find_if(events.begin(), events.end(), [](const Event& event) { return event.by_rule; });
    if (by_rule != events.end()) {
      result.undecided = fmt::format(
          "event {}, {}, has another contact of its ball at the same time in every scalar: a rule and not "
          "the "
          "equations orders them",
          by_rule - events.begin(), describe(*by_rule));
      return true;
    }
    if (!all || agreement.least_digits() < options_.digits) return false;
    result.events = std::move(events);
    return true;
  }

  const casefile::CaseSpec& spec_;
  const CertifyOptions& options_;
  std::size_t expected_ = 0;  ///< events, as the widest run so far has them
};

}  // namespace

SideBySide::SideBySide(const casefile::CaseSpec& spec, const std::string& narrow, const std::string& wide,
                       bool to_end, const std::atomic<bool>* interrupt)
    : interrupt_(interrupt),
      digits_{chosen_digits_of(narrow), chosen_digits_of(wide)},
      sources_(
          of_both([&](int k) { return run::make_source(k == 0 ? narrow : wide, spec, to_end, interrupt); })) {
}

std::vector<run::Event> SideBySide::next(std::size_t count) {
  if (diverged_ || uneven_) return {};
  auto [one, two] = of_both([&](int k) { return sources_[k]->next(count); });
  if (interrupt_ && *interrupt_) return {};
  const std::size_t shared = std::min(one.size(), two.size());
  std::size_t same = 0;
  while (same < shared && agreement_.take(one[same], two[same])) ++same;
  if (same < shared)
    diverged_ = {one[same], two[same]};
  else  // a wider scalar follows a collapse for some events more
    uneven_ = one.size() != two.size() && !sources_[0]->has_collapsed() && !sources_[1]->has_collapsed();
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
  constexpr std::size_t kinds = 3, per_ball = 3 * kinds;
  std::array<run::Number, kinds> difference{}, size{};
  for (std::size_t k = 0; k < one.size(); ++k) {
    const std::size_t kind = k % per_ball / 3;
    difference[kind] = std::max(difference[kind], run::Number(abs(one[k] - two[k])));
    size[kind] = std::max(size[kind], run::Number(abs(two[k])));
  }
  double least = run::Agreement::most;
  for (std::size_t kind = 0; kind < kinds; ++kind)
    least = std::min(least, run::digits_of(difference[kind], size[kind]));
  return least;
}

unsigned wider_than(unsigned digits) { return digits + std::max(20u, digits / 20); }

Certification certify(const casefile::CaseSpec& spec, const CertifyOptions& options) try {
  if (options.collisions == 0 && !spec.end_time)
    throw InputError(spec.file + ": found no run.end_time, expected one, or a number of collisions");
  io::NamedFile file(options.file);
  Certifier certifier(spec, options);
  if (!certifier.by_fixed_scalars()) certifier.by_chosen_digits();
  auto result = std::move(certifier.result);
  if (!result.events.empty())
    file.write([&](std::ostream& out) { write_reference(out, spec, options, result); });
  return result;
} catch (const InterruptedError&) {
  return {.interrupted = true};
}

void require_wider(const std::string& precision, const std::string& wider, const std::string& what) {
  if (casefile::digits_of(wider) <= casefile::digits_of(precision))
    throw InputError(
        fmt::format("{}: found \"{}\", expected a scalar wider than {}", what, wider, precision));
}

Shadow shadow(const casefile::CaseSpec& spec, const std::string& precision, const std::string& wider,
              const std::atomic<bool>* interrupt) {
  SideBySide runs(spec, precision, wider, true, interrupt);
  while (!stop_asked(interrupt) && !runs.next(64).empty()) {
  }
  return {.narrow = precision,
          .wide = wider,
          .agreement = runs.agreement(),
          .diverged = runs.diverged(),
          .uneven = runs.uneven(),
          .interrupted = stop_asked(interrupt),
          .balls = spec.ball_count()};
}

std::string Evidence::text() const {
  std::string line = fmt::format("{} and {}: {} events in common; digits:", narrow, wide, agreement.events());
  for (std::size_t k = 0; k < model::logged_count; ++k)
    line += fmt::format(" {} {}", model::logged_quantities[k].name, digits_text(agreement.digits(k)));
  return line;
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

std::size_t right_events(const std::string& precision, const casefile::CaseSpec& spec,
                         const prove::Proof& proof) {
  const auto source = run::make_source(precision, spec, false);
  std::size_t right = 0;
  while (right < proof.events.size()) {
    const auto more = source->next(std::min<std::size_t>(256, proof.events.size() - right));
    if (more.empty()) return right;
    for (const auto& event : more) {
      const auto& proven = proof.events[right];
      if (event.ball != proven.ball || event.with_wall != proven.with_wall || event.partner != proven.partner)
        return right;
      ++right;
    }
  }
  return right;
}

Proven prove(const casefile::CaseSpec& spec, const ProveOptions& options) {
  io::NamedFile events(options.file), certificate(options.certificate);
  const auto begin = std::chrono::steady_clock::now();
  Proven result{prove::prove(spec, options)};
  result.proof.exact.name = one_line(result.proof.exact.name);
  const auto& proof = result.proof;
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (proof.interrupted || !proof.impossible.empty()) return result;
  events.write([&](auto& out) { prove::write_events(out, proof, 27); });
  certificate.write([&](auto& out) { prove::write_certificate(out, proof); });
  return result;
}

std::vector<std::string> check_certificate(const casefile::CaseSpec& spec, const std::string& certificate) {
  io::InputFile file(certificate, "a certificate");
  return prove::other_case(file, certificate, prove::exact_case(spec));
}

}  // namespace edmill::app
